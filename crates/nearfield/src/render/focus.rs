//! One particle and its neighbours.

use super::{Error, Result};
use crate::NeighborSearch;
use glam::Vec3;
use nearfield_core::System;
use std::ops::ControlFlow;

/// A particle and those within its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Focus {
    /// The particle, by its index from 0.
    pub particle: usize,
    /// Its neighbours in order of their index, and in which image of the box each is within range:
    /// `dr = (x_j - x_i) + image * box length`.
    pub neighbors: Vec<(u32, [i8; 3])>,
}

impl Focus {
    /// Finds the neighbours of a particle.
    ///
    /// # Errors
    /// [`Error::Focus`], or what [`NeighborSearch::with_radii`] gives.
    pub fn find(system: &System, particle: usize) -> crate::Result<Self> {
        let n = system.particles.len();
        check(particle, n)?;
        let search =
            NeighborSearch::with_radii(system.sim_box, system.particles.position.iter(), system.radii.clone())?;
        let mut neighbors = Vec::new();
        let _ = search.for_each_pair(|pair| {
            if pair.i as usize == particle {
                neighbors.push((pair.j, pair.image));
            } else if pair.j as usize == particle {
                neighbors.push((pair.i, pair.image.map(|c| -c)));
            }
            ControlFlow::<()>::Continue(())
        });
        neighbors.sort_unstable();
        Ok(Self { particle, neighbors })
    }

    /// Where the particle is.
    pub(super) fn position(&self, system: &System) -> Vec3 {
        system.particles.position.get(self.particle).into()
    }

    /// Where the neighbours are that are within range: of neighbours through a periodic face, the image.
    pub(super) fn places<'a>(&'a self, system: &'a System) -> impl Iterator<Item = Vec3> + 'a {
        self.neighbors.iter().map(|&(j, image)| {
            Vec3::from(system.particles.position.get(j as usize)) + Vec3::from(system.sim_box.shift(image))
        })
    }
}

/// Fails where there is no such particle.
pub(super) fn check(focus: usize, n: usize) -> Result<()> {
    if focus < n { Ok(()) } else { Err(Error::Focus { focus, n }) }
}
