//! Tail corrections: what a homogeneous fluid (g = 1 beyond the cutoff) adds to energy and virial.

use super::{Interaction, Truncation};
use crate::{Radii, System, potentials::Potential};

/// Energy and virial beyond the cutoff.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TailCorrection {
    /// To add to the potential energy.
    pub energy: f64,
    /// To add to the virial W = sum r . f.
    pub virial: f64,
}

impl System {
    /// Long-range corrections of a plainly cut Lennard-Jones fluid (Allen and Tildesley, Computer Simulation of
    /// Liquids, 2nd ed., section 2.8), with types at random positions. `None` where they are not defined: another
    /// potential or truncation, per-particle radii, or a box that is not periodic throughout.
    pub fn tail_correction(&self) -> Option<TailCorrection> {
        let Interaction { potential: Potential::LennardJones(_), truncation: Truncation::Cut, .. } = self.interaction
        else {
            return None;
        };
        let Radii::Uniform(cutoff) = self.radii else { return None };
        if !(0..3).all(|axis| self.sim_box.is_periodic(axis)) {
            return None;
        }
        let mut counts = vec![0u64; self.interaction.types.len()];
        for &kind in &self.particles.kind {
            counts[kind as usize] += 1;
        }
        let (volume, n_types) = (self.sim_box.volume(), counts.len());
        let mut tail = TailCorrection::default();
        for (index, c) in self.interaction.pair_table(cutoff).iter().enumerate() {
            let pairs = counts[index / n_types] as f64 * counts[index % n_types] as f64;
            let s3 = (c.sigma / f64::from(cutoff)).powi(3);
            let scale = std::f64::consts::PI * pairs / volume * c.epsilon * c.sigma.powi(3);
            tail.energy += scale * 8.0 / 3.0 * (s3.powi(3) / 3.0 - s3);
            tail.virial += scale * 16.0 * (2.0 / 3.0 * s3.powi(3) - s3);
        }
        Some(tail)
    }
}
