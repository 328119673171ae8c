//! Particles as a structure of arrays.

use crate::{Boundary, Error, Result, SimBox, Vec3s};
use serde::{Deserialize, Serialize};

/// The state of N particles, each array `[N]`.
///
/// Arrays are in input order, and an index is a particle's stable id: engines reorder copies of their own and give
/// everything back in this order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Particles {
    /// Positions, \[length\], inside the box on periodic axes.
    pub position: Vec3s,
    /// Velocities, \[length/time\].
    pub velocity: Vec3s,
    /// Index of each particle's type in `Interaction::types`.
    pub kind: Vec<u32>,
    /// Periodic box crossings: the unwrapped position is `position + image * box length`.
    pub image: Vec<[i32; 3]>,
}

impl Particles {
    /// Particles of type 0 at rest.
    pub fn at(positions: impl IntoIterator<Item = [f32; 3]>) -> Self {
        let position: Vec3s = positions.into_iter().collect();
        let n = position.len();
        Self { position, velocity: Vec3s::zeros(n), kind: vec![0; n], image: vec![[0; 3]; n] }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Checks positions: not too many, all finite, within the walls of the box.
    ///
    /// # Errors
    /// The first problem found, naming the particle.
    pub fn validate_positions(position: &Vec3s, sim_box: &SimBox) -> Result<()> {
        let expected = position.len();
        if expected > i32::MAX as usize {
            return Err(Error::TooManyParticles(expected));
        }
        for (what, found) in [("y coordinates", position.y.len()), ("z coordinates", position.z.len())] {
            if found != expected {
                return Err(Error::LengthMismatch { what, found, expected });
            }
        }
        let (lo, hi) = (sim_box.lo(), sim_box.hi());
        for (particle, at) in position.iter().enumerate() {
            for (axis, value) in at.into_iter().enumerate() {
                if !value.is_finite() {
                    return Err(Error::NonFiniteCoordinate { particle, axis, value });
                }
                if sim_box.boundary()[axis] == Boundary::Wall && !(lo[axis]..=hi[axis]).contains(&value) {
                    return Err(Error::OutsideWalls { particle, axis, value, lo: lo[axis], hi: hi[axis] });
                }
            }
        }
        Ok(())
    }
}
