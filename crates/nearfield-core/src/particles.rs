//! Particles as a structure of arrays.

use crate::Vec3s;
use serde::{Deserialize, Serialize};

/// The state of N particles, each array `[N]`.
///
/// Arrays are in input order, and an index is a particle's stable id: engines reorder copies of their own and give
/// everything back in this order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Particles {
    /// Positions, [length], inside the box on periodic axes.
    pub position: Vec3s,
    /// Velocities, [length/time].
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
}
