//! What queries need of the engine.

use crate::Gpu;
use nearfield_core::SimBox;
use nearfield_kernels::layouts::{Box3, Law, Particles};
use std::sync::Arc;

/// A system on the device. The addresses in it are of arrays of `particles.n` elements.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The device.
    pub gpu: &'a Arc<dyn Gpu>,
    /// The box.
    pub sim_box: &'a SimBox,
    /// The box for kernels.
    pub space: Box3,
    /// The interaction.
    pub law: Law,
    /// The particles in memory order.
    pub particles: Particles,
    /// The largest radius, the cutoff where there is one for all.
    pub largest: f32,
    /// The mean radius, the cutoff where there is one for all.
    pub mean: f32,
    /// Added to all radii; ranges and the skin are at most half a periodic length.
    pub skin: f32,
    /// What roundings of coordinates in the box can take from a range.
    pub slack: f32,
}

impl Scene<'_> {
    /// The largest distance at which particles are seen.
    pub(super) fn reach(&self) -> f32 {
        self.largest + self.skin
    }
}

/// How forces are summed, and whether energies are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sums {
    /// Independently of order.
    pub exact: bool,
    /// Energies, virials and neighbour counts too.
    pub energy: bool,
}

/// What an update did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Updated {
    /// Built rather than refitted.
    pub built: bool,
    /// Built although a refit was asked for.
    pub forced: bool,
}
