//! Thermodynamic state of a system.

use nearfield_core::{Totals, interaction::TailCorrection};
use serde::{Deserialize, Serialize};

/// What a row of thermo.csv holds, in reduced units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Thermo {
    /// Step number.
    pub step: u64,
    /// Simulated time.
    pub time: f64,
    /// T = 2 KE / (3 N - 3).
    pub temperature: f64,
    /// Kinetic energy.
    pub kinetic_energy: f64,
    /// Potential energy, tail correction included where it is on.
    pub potential_energy: f64,
    /// Their sum.
    pub total_energy: f64,
    /// P = (N T + W / 3) / V, tail correction included where it is on.
    pub pressure: f64,
    /// W = sum over pairs of r_ij . f_ij, tail correction included where it is on.
    pub virial: f64,
    /// Pairs within range.
    pub pairs: u64,
    /// Largest force on a particle.
    pub max_force: f64,
}

impl Thermo {
    /// From an engine's totals.
    pub fn new(totals: &Totals, n: usize, volume: f64, tail: TailCorrection, step: u64, time: f64) -> Self {
        let degrees_of_freedom = if n > 1 { 3.0 * n as f64 - 3.0 } else { 3.0 };
        let temperature = 2.0 * totals.kinetic_energy / degrees_of_freedom;
        let potential_energy = totals.potential_energy + tail.energy;
        let virial = totals.virial + tail.virial;
        Self {
            step,
            time,
            temperature,
            kinetic_energy: totals.kinetic_energy,
            potential_energy,
            total_energy: totals.kinetic_energy + potential_energy,
            pressure: (n as f64 * temperature + virial / 3.0) / volume,
            virial,
            pairs: totals.pairs,
            max_force: totals.max_force,
        }
    }
}
