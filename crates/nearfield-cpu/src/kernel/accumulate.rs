//! Two ways of summing pair contributions: fast in f32 lanes, or exactly and so independent of order.

use super::Sums;
use crate::LANES;

/// Lanes of contributions of one block of candidates; lanes that are not neighbours hold zeros.
pub(super) struct Contribution {
    pub force: [[f32; LANES]; 3],
    pub energy: [f32; LANES],
    pub virial: [f32; LANES],
}

/// A query's running sums.
pub(super) trait Accumulator: Copy {
    /// Zero, with the quantum of exact sums.
    fn new(grain: Grain) -> Self;
    /// Adds a block of lanes.
    fn add<const ENERGY: bool>(&mut self, block: &Contribution);
    /// The sums over lanes.
    fn finish(&self, neighbors: u32) -> Sums;
}

/// f32 sums, one a lane: fastest, the result depends on the order of candidates in its last bits.
#[derive(Clone, Copy)]
pub(super) struct Lanes {
    force: [[f32; LANES]; 3],
    energy: [f32; LANES],
    virial: [f32; LANES],
}

impl Accumulator for Lanes {
    #[inline(always)]
    fn new(_: Grain) -> Self {
        Self { force: [[0.0; LANES]; 3], energy: [0.0; LANES], virial: [0.0; LANES] }
    }

    #[inline(always)]
    fn add<const ENERGY: bool>(&mut self, block: &Contribution) {
        for axis in 0..3 {
            for l in 0..LANES {
                self.force[axis][l] += block.force[axis][l];
            }
        }
        if ENERGY {
            for l in 0..LANES {
                self.energy[l] += block.energy[l];
                self.virial[l] += block.virial[l];
            }
        }
    }

    #[inline(always)]
    fn finish(&self, neighbors: u32) -> Sums {
        let total = |lanes: &[f32; LANES]| lanes.iter().map(|&v| f64::from(v)).sum::<f64>();
        Sums {
            force: [total(&self.force[0]) as f32, total(&self.force[1]) as f32, total(&self.force[2]) as f32],
            energy: 0.5 * total(&self.energy),
            virial: 0.5 * total(&self.virial),
            neighbors,
        }
    }
}

/// Quanta of order-independent sums: each contribution is rounded to a multiple of its quantum, after which f64 sums
/// are exact, and so the same in any order, up to 2^53 quanta; beyond that they merely round.
///
/// The quantum is 2^-34 of the system's unit (ε/σ for forces, ε for energies): finer than the rounding of an f32 force
/// of that size, while sums stay exact up to 2^19 units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grain {
    force: f64,
    energy: f64,
}

impl Grain {
    /// From the force and energy units of the interaction.
    pub fn new(force_unit: f64, energy_unit: f64) -> Self {
        // Adding and subtracting 1.5 * 2^52 quanta rounds to the nearest quantum.
        let magic = |unit: f64| {
            let exponent = if unit.is_normal() { unit.log2().ceil() } else { 0.0 };
            1.5 * (exponent - 34.0 + 52.0).exp2()
        };
        Self { force: magic(force_unit), energy: magic(energy_unit) }
    }

    #[inline(always)]
    pub fn force(self, value: f32) -> f64 {
        (f64::from(value) + self.force) - self.force
    }

    #[inline(always)]
    pub fn energy(self, value: f32) -> f64 {
        (f64::from(value) + self.energy) - self.energy
    }
}

/// Order-independent sums.
#[derive(Clone, Copy)]
pub(super) struct Exact {
    grain: Grain,
    force: [[f64; LANES]; 3],
    energy: [f64; LANES],
    virial: [f64; LANES],
}

impl Accumulator for Exact {
    #[inline(always)]
    fn new(grain: Grain) -> Self {
        Self { grain, force: [[0.0; LANES]; 3], energy: [0.0; LANES], virial: [0.0; LANES] }
    }

    #[inline(always)]
    fn add<const ENERGY: bool>(&mut self, block: &Contribution) {
        for axis in 0..3 {
            for l in 0..LANES {
                self.force[axis][l] += self.grain.force(block.force[axis][l]);
            }
        }
        if ENERGY {
            for l in 0..LANES {
                self.energy[l] += self.grain.energy(block.energy[l]);
                self.virial[l] += self.grain.energy(block.virial[l]);
            }
        }
    }

    #[inline(always)]
    fn finish(&self, neighbors: u32) -> Sums {
        let total = |lanes: &[f64; LANES]| lanes.iter().sum::<f64>();
        Sums {
            force: [total(&self.force[0]) as f32, total(&self.force[1]) as f32, total(&self.force[2]) as f32],
            energy: 0.5 * total(&self.energy),
            virial: 0.5 * total(&self.virial),
            neighbors,
        }
    }
}
