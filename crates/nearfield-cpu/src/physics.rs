//! What kernels know of a system: box, ranges, interaction and the limits of arithmetic.

use crate::kernel::Grain;
use nearfield_core::{Interaction, Radii, SimBox, System};

/// The parts of a system that do not change from step to step.
#[derive(Clone, Debug)]
pub(crate) struct Physics {
    pub sim_box: SimBox,
    /// The cutoff, or only the fact that radii are per particle: the radii themselves lie with the state.
    pub radii: Radii,
    pub interaction: Interaction,
    /// Quanta of order-independent sums.
    pub grain: Grain,
    /// Upper limit of f/r and of a pair's energy; infinite unless overlaps are allowed.
    pub cap: f32,
}

/// The cap where overlaps are allowed: sums of many such forces stay finite in f32.
pub(crate) const OVERLAP_CAP: f32 = 1e30;

impl Physics {
    pub fn new(system: &System) -> Self {
        let types = &system.interaction.types;
        let epsilon = types.iter().map(|t| f64::from(t.epsilon)).fold(0.0, f64::max);
        let (radii, sigma) = match &system.radii {
            Radii::Uniform(r) => {
                (Radii::Uniform(*r), types.iter().map(|t| f64::from(t.sigma)).fold(f64::INFINITY, f64::min))
            }
            Radii::PerParticle(radii) => {
                let smallest = radii.iter().copied().fold(f32::INFINITY, f32::min);
                (Radii::PerParticle(Vec::new()), f64::from(smallest / system.interaction.radius_per_sigma))
            }
        };
        Self {
            sim_box: system.sim_box,
            radii,
            interaction: system.interaction.clone(),
            grain: Grain::new(epsilon / sigma, epsilon),
            cap: f32::INFINITY,
        }
    }

    /// The uniform cutoff; zero with per-particle radii.
    pub fn cutoff(&self) -> f32 {
        match self.radii {
            Radii::Uniform(r) => r,
            Radii::PerParticle(_) => 0.0,
        }
    }
}
