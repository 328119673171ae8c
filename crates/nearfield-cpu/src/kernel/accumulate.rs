//! What becomes of pair contributions: summed fast in f32 lanes, summed exactly and so independent of order, or kept.

use super::{Sums, block::Lanes};
use crate::LANES;

/// Takes the contributions of a block, lane by lane; lanes that are not neighbours give zeros.
pub(super) trait Accumulator: Copy {
    /// Adds a force on the query.
    fn add_force(&mut self, lane: usize, x: f32, y: f32, z: f32);
    /// Adds a pair's energy, virial and count.
    fn add_energy(&mut self, lane: usize, energy: f32, virial: f32, count: u32);
}

/// An accumulator whose lanes add up to a query's sums.
pub(super) trait Summing: Accumulator {
    /// Zero, with the quantum of exact sums.
    fn new(grain: Grain) -> Self;
    /// The sums over lanes.
    fn finish(&self) -> Sums;
}

/// f32 sums, one a lane: fastest, the result depends on the order of candidates in its last bits.
#[derive(Clone, Copy)]
pub(super) struct Fast {
    x: Lanes<f32>,
    y: Lanes<f32>,
    z: Lanes<f32>,
    energy: Lanes<f32>,
    virial: Lanes<f32>,
    count: Lanes<u32>,
}

impl Accumulator for Fast {
    #[inline(always)]
    fn add_force(&mut self, lane: usize, x: f32, y: f32, z: f32) {
        self.x[lane] += x;
        self.y[lane] += y;
        self.z[lane] += z;
    }

    #[inline(always)]
    fn add_energy(&mut self, lane: usize, energy: f32, virial: f32, count: u32) {
        self.energy[lane] += energy;
        self.virial[lane] += virial;
        self.count[lane] += count;
    }
}

impl Summing for Fast {
    #[inline(always)]
    fn new(_: Grain) -> Self {
        let zero = [0.0; LANES];
        Self { x: zero, y: zero, z: zero, energy: zero, virial: zero, count: [0; LANES] }
    }

    #[inline(always)]
    fn finish(&self) -> Sums {
        Sums {
            force: [total(&self.x) as f32, total(&self.y) as f32, total(&self.z) as f32],
            energy: 0.5 * total(&self.energy),
            virial: 0.5 * total(&self.virial),
            neighbors: self.count.iter().sum(),
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
    x: Lanes<f64>,
    y: Lanes<f64>,
    z: Lanes<f64>,
    energy: Lanes<f64>,
    virial: Lanes<f64>,
    count: Lanes<u32>,
}

impl Accumulator for Exact {
    #[inline(always)]
    fn add_force(&mut self, lane: usize, x: f32, y: f32, z: f32) {
        self.x[lane] += self.grain.force(x);
        self.y[lane] += self.grain.force(y);
        self.z[lane] += self.grain.force(z);
    }

    #[inline(always)]
    fn add_energy(&mut self, lane: usize, energy: f32, virial: f32, count: u32) {
        self.energy[lane] += self.grain.energy(energy);
        self.virial[lane] += self.grain.energy(virial);
        self.count[lane] += count;
    }
}

impl Summing for Exact {
    #[inline(always)]
    fn new(grain: Grain) -> Self {
        let zero = [0.0; LANES];
        Self { grain, x: zero, y: zero, z: zero, energy: zero, virial: zero, count: [0; LANES] }
    }

    #[inline(always)]
    fn finish(&self) -> Sums {
        Sums {
            force: [total(&self.x) as f32, total(&self.y) as f32, total(&self.z) as f32],
            energy: 0.5 * total(&self.energy),
            virial: 0.5 * total(&self.virial),
            neighbors: self.count.iter().sum(),
        }
    }
}

/// The contributions of one block, for consumers that look at each pair.
#[derive(Clone, Copy)]
pub(super) struct Kept {
    pub x: Lanes<f32>,
    pub y: Lanes<f32>,
    pub z: Lanes<f32>,
    pub energy: Lanes<f32>,
    pub virial: Lanes<f32>,
    /// One for neighbours, zero for the rest.
    pub count: Lanes<u32>,
}

impl Kept {
    #[inline(always)]
    pub fn new() -> Self {
        let zero = [0.0; LANES];
        Self { x: zero, y: zero, z: zero, energy: zero, virial: zero, count: [0; LANES] }
    }
}

impl Accumulator for Kept {
    #[inline(always)]
    fn add_force(&mut self, lane: usize, x: f32, y: f32, z: f32) {
        self.x[lane] = x;
        self.y[lane] = y;
        self.z[lane] = z;
    }

    #[inline(always)]
    fn add_energy(&mut self, lane: usize, energy: f32, virial: f32, count: u32) {
        self.energy[lane] = energy;
        self.virial[lane] = virial;
        self.count[lane] = count;
    }
}

/// The sum of lanes, in f64.
#[inline(always)]
fn total<T: Copy + Into<f64>>(lanes: &Lanes<T>) -> f64 {
    let mut sum = 0.0;
    for &lane in lanes {
        sum += lane.into();
    }
    sum
}
