//! Box and interaction as kernels take them.

use super::{state::State, survey::Sample};
use crate::{Buffer, Gpu, grid::Survey, tracing::Scene};
use nearfield_core::{Boundary, Interaction, Radii, Result, SimBox, System, Truncation, potentials::Potential};
use nearfield_kernels::{
    Float4,
    layouts::{Box3, Law},
};
use std::sync::Arc;

/// The cap of f/r where overlaps are allowed: sums of many such forces stay finite in f32.
const OVERLAP_CAP: f32 = 1e30;

/// Bits of a unit in order-independent sums: finer than the rounding of an f32 force of one unit.
const QUANTA_BITS: f64 = 34.0;

/// The parts of a system that do not change from step to step.
pub(crate) struct Physics {
    pub sim_box: SimBox,
    pub space: Box3,
    pub interaction: Interaction,
    pub law: Law,
    /// The one cutoff; `None` where radii are per particle.
    pub cutoff: Option<f32>,
    /// The largest radius.
    pub largest: f32,
    /// The mean radius.
    pub mean: f32,
    /// What roundings of coordinates in the box can take from a range.
    pub slack: f32,
    tables: Tables,
}

/// What [`Law`] points to.
struct Tables {
    pairs: Buffer<Float4>,
    energy: Buffer<Float4>,
    force: Buffer<Float4>,
}

impl Physics {
    /// Copies the tables of the interaction to the device.
    pub fn new(gpu: &Arc<dyn Gpu>, system: &System) -> Result<Self> {
        let interaction = &system.interaction;
        let cutoff = match system.radii {
            Radii::Uniform(cutoff) => Some(cutoff),
            Radii::PerParticle(_) => None,
        };
        let mut tables = Tables {
            pairs: Buffer::new(gpu, "coefficients of pairs"),
            energy: Buffer::new(gpu, "the energy table"),
            force: Buffer::new(gpu, "the force table"),
        };
        tables.pairs.upload(&pairs(interaction, cutoff))?;
        let mut law = law(system, cutoff);
        if let Potential::Table(table) = &interaction.potential {
            let (energy, force): (Vec<_>, Vec<_>) = table.polynomials().unzip();
            let row = |c: &[f64]| {
                let at = |k: usize| c.get(k).map_or(0.0, |&c| c as f32);
                Float4::new(at(0), at(1), at(2), at(3))
            };
            tables.energy.upload(&energy.iter().map(|c| row(c)).collect::<Vec<_>>())?;
            tables.force.upload(&force.iter().map(|c| row(c)).collect::<Vec<_>>())?;
            law.table_start = table.start() as f32;
            law.table_end = table.end() as f32;
            law.table_per_sigma = table.intervals_per_sigma() as f32;
            law.table_intervals = tables.energy.len() as u32;
        }
        law.pairs = tables.pairs.ptr();
        law.table_energy = tables.energy.ptr();
        law.table_force = tables.force.ptr();
        let space = space(&system.sim_box);
        let extent = space.lo.iter().chain(&space.hi).chain(&space.length).fold(0.0f32, |m, x| m.max(x.abs()));
        Ok(Self {
            sim_box: system.sim_box,
            space,
            interaction: interaction.clone(),
            law,
            cutoff,
            largest: system.radii.largest(),
            mean: mean(&system.radii),
            slack: 4.0 * f32::EPSILON * extent,
            tables,
        })
    }

    /// Allows overlaps, whose forces are then capped, or makes them errors.
    pub fn allow_overlaps(&mut self, allow: bool) {
        self.law.cap = if allow { OVERLAP_CAP } else { f32::INFINITY };
    }

    /// What cells depend on.
    pub fn survey<'a>(&'a self, sample: &'a Sample) -> Survey<'a> {
        Survey {
            n: sample.n,
            sample: &sample.positions,
            sim_box: &self.sim_box,
            cutoff: self.cutoff,
            largest: self.largest,
        }
    }

    /// What rays depend on, at the places of `state`.
    pub fn scene<'a>(&'a self, state: &'a State) -> Scene<'a> {
        Scene {
            gpu: state.gpu(),
            sim_box: &self.sim_box,
            space: self.space,
            law: self.law,
            particles: state.particles(),
            largest: self.largest,
            mean: self.mean,
            skin: 0.0,
            slack: self.slack,
        }
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.tables.pairs.bytes() + self.tables.energy.bytes() + self.tables.force.bytes()
    }
}

fn mean(radii: &Radii) -> f32 {
    match radii {
        Radii::Uniform(cutoff) => *cutoff,
        Radii::PerParticle(radii) => {
            (radii.iter().map(|&r| f64::from(r)).sum::<f64>() / radii.len().max(1) as f64) as f32
        }
    }
}

fn space(sim_box: &SimBox) -> Box3 {
    Box3 {
        lo: sim_box.lo(),
        hi: sim_box.hi(),
        length: sim_box.lengths(),
        boundary: sim_box.boundary().map(|boundary| match boundary {
            Boundary::Periodic => 0,
            Boundary::Wall => 1,
            Boundary::Open => 2,
        }),
    }
}

/// Epsilon, sigma and shifts by pair of types.
fn pairs(interaction: &Interaction, cutoff: Option<f32>) -> Vec<Float4> {
    match cutoff {
        Some(cutoff) => {
            let table = interaction.typed_table(cutoff);
            table.iter().map(|c| Float4::new(c.epsilon, c.sigma, c.energy_shift, c.force_shift)).collect()
        }
        None => interaction.epsilon_table().into_iter().map(|e| Float4::new(e, 0.0, 0.0, 0.0)).collect(),
    }
}

/// Everything but the addresses and the table.
fn law(system: &System, cutoff: Option<f32>) -> Law {
    let interaction = &system.interaction;
    let types = &interaction.types;
    let epsilon = types.iter().map(|t| f64::from(t.epsilon)).fold(0.0, f64::max);
    let least_sigma = match &system.radii {
        Radii::Uniform(_) => types.iter().map(|t| t.sigma).fold(f32::INFINITY, f32::min),
        Radii::PerParticle(radii) => radii.iter().copied().fold(f32::INFINITY, f32::min) / interaction.radius_per_sigma,
    };
    let (potential, parameter) = match &interaction.potential {
        Potential::LennardJones(_) => (0, 0.0),
        Potential::Wca(_) => (1, 0.0),
        Potential::Yukawa(yukawa) => (2, yukawa.kappa),
        Potential::Morse(morse) => (3, morse.alpha),
        Potential::Gaussian(_) => (4, 0.0),
        Potential::Table(_) => (5, 0.0),
    };
    let (e, s6) = (f64::from(types[0].epsilon), f64::from(types[0].sigma).powi(6));
    Law {
        potential,
        parameter,
        truncation: match interaction.truncation {
            Truncation::Cut => 0,
            Truncation::Energy => 1,
            Truncation::Force => 2,
        },
        n_types: types.len() as u32,
        variable: u32::from(cutoff.is_none()),
        cutoff: cutoff.unwrap_or(0.0),
        sigma_per_range: 1.0 / interaction.radius_per_sigma,
        cap: f32::INFINITY,
        lj_repulsion: if cutoff.is_some() { (48.0 * e * s6 * s6) as f32 } else { e as f32 },
        lj_attraction: (24.0 * e * s6) as f32,
        force_quanta: quanta(epsilon / f64::from(least_sigma)),
        energy_quanta: quanta(epsilon),
        ..Law::default()
    }
}

/// Quanta in 1 so that a unit, rounded up to a power of two, has 2^34.
fn quanta(unit: f64) -> f32 {
    let exponent = if unit.is_normal() { unit.log2().ceil() } else { 0.0 };
    (QUANTA_BITS - exponent).clamp(-100.0, 100.0).exp2() as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quanta_are_a_power_of_two_and_2_to_the_34_for_a_unit() {
        assert_eq!(quanta(1.0), 2f32.powi(34));
        assert_eq!(quanta(3.0), 2f32.powi(32));
        assert_eq!(quanta(0.0), 2f32.powi(34));
    }
}
