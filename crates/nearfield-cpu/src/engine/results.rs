//! Forces, energies and totals of the last evaluation.

use super::{evaluate::Loaded, state::permute};
use crate::{exact_sum::exact_sum, kernel::Sums, parallel::Scattered};
use nearfield_core::{Error, PerParticle, Quantities, Report, Result, Totals, Vec3s};
use rayon::prelude::*;

/// Per-particle results in memory order; all but forces only when energies were asked for.
#[derive(Debug, Default)]
pub(super) struct Results {
    pub force: Vec3s,
    pub energy: Vec<f64>,
    pub virial: Vec<f64>,
    pub neighbors: Vec<u32>,
}

impl Results {
    /// Makes room for `n` particles.
    pub fn prepare(&mut self, n: usize, energy: bool) {
        self.force.resize(n);
        let n = if energy { n } else { 0 };
        self.energy.resize(n, 0.0);
        self.virial.resize(n, 0.0);
        self.neighbors.resize(n, 0);
    }

    /// Where kernels put their sums.
    pub fn sink(&mut self) -> Sink<'_> {
        let [x, y, z] = self.force.axes_mut();
        Sink {
            energies: !self.energy.is_empty(),
            force: [Scattered::new(x), Scattered::new(y), Scattered::new(z)],
            energy: Scattered::new(&mut self.energy),
            virial: Scattered::new(&mut self.virial),
            neighbors: Scattered::new(&mut self.neighbors),
        }
    }

    /// Forces follow their particles; the rest is computed anew anyway.
    pub fn reorder(&mut self, order: &[u32]) {
        let mut spare = Vec::new();
        for axis in self.force.axes_mut() {
            permute(axis, &mut spare, order);
        }
    }

    pub fn bytes(&self) -> usize {
        self.force.x.capacity() * 12 + self.energy.capacity() * 20
    }
}

/// Results being written by kernels.
pub(super) struct Sink<'a> {
    energies: bool,
    force: [Scattered<'a, f32>; 3],
    energy: Scattered<'a, f64>,
    virial: Scattered<'a, f64>,
    neighbors: Scattered<'a, u32>,
}

impl Sink<'_> {
    /// Stores the sums of particle `i`.
    ///
    /// # Safety
    /// No two calls with the same `i` during an evaluation.
    #[inline(always)]
    pub unsafe fn store(&self, i: usize, sums: &Sums) {
        // SAFETY: the caller never passes an index twice, so no two threads meet at one element.
        unsafe {
            for axis in 0..3 {
                self.force[axis].write(i, sums.force[axis]);
            }
            if self.energies {
                self.energy.write(i, sums.energy);
                self.virial.write(i, sums.virial);
                self.neighbors.write(i, sums.neighbors);
            }
        }
    }
}

impl Loaded {
    /// Sums over particles, independent of memory order.
    ///
    /// # Errors
    /// [`Error::NonFinite`] when an energy or velocity is not finite at `step`.
    pub fn totals(&self, quantities: Quantities, step: u64) -> Result<Totals> {
        let (state, results, n) = (&self.state, &self.results, self.state.len());
        let velocity = state.velocity.axes();
        let types = &self.physics.interaction.types;
        let kinetic = |i: usize| state.kinetic_energy_of(i, types);
        let squared_force = |i: usize| results.force.get(i).iter().map(|&f| f64::from(f).powi(2)).sum::<f64>();
        let mut totals = Totals {
            kinetic_energy: exact_sum(n, kinetic),
            momentum: velocity.map(|v| exact_sum(n, |i| state.mass(i, types) * f64::from(v[i]))),
            max_force: (0..n).into_par_iter().map(squared_force).reduce(|| 0.0, f64::max).sqrt(),
            ..Totals::default()
        };
        self.check_finite(step, "kinetic energy", totals.kinetic_energy, kinetic)?;
        if quantities.energy {
            totals.potential_energy = exact_sum(n, |i| results.energy[i]);
            totals.virial = exact_sum(n, |i| results.virial[i]);
            totals.pairs = results.neighbors.par_iter().map(|&k| u64::from(k)).sum::<u64>() / 2;
            self.check_finite(step, "energy", totals.potential_energy, |i| results.energy[i])?;
        }
        Ok(totals)
    }

    fn check_finite(&self, step: u64, what: &'static str, total: f64, term: impl Fn(usize) -> f64) -> Result<()> {
        if total.is_finite() {
            return Ok(());
        }
        let (particle, value) = (0..self.state.len())
            .map(|i| (self.state.id[i] as usize, term(i)))
            .filter(|(_, value)| !value.is_finite())
            .min_by_key(|&(particle, _)| particle)
            .unwrap_or((0, total));
        Err(Error::NonFinite { step, what, particle, value })
    }

    /// Copies forces, energies and neighbour counts out in input order.
    pub fn copy_results(&self, out: &mut PerParticle) {
        let results = &self.results;
        out.force.resize(results.force.len());
        out.energy.resize(results.energy.len(), 0.0);
        out.neighbors.resize(results.neighbors.len(), 0);
        for (i, &id) in self.state.id.iter().enumerate().take(results.force.len()) {
            out.force.set(id as usize, results.force.get(i));
            if !results.energy.is_empty() {
                out.energy[id as usize] = results.energy[i];
                out.neighbors[id as usize] = results.neighbors[i];
            }
        }
    }

    pub fn report(&self) -> Report {
        let lists = self.list.bytes() + self.clusters.clusters.bytes() + self.sparse.pairs.bytes();
        let structure = self.upkeep.index.bytes() + lists;
        let bytes =
            structure + self.state.bytes() + self.results.bytes() + self.scatter.bytes() + self.reference.bytes();
        Report { bytes: bytes as u64, structure_bytes: structure as u64, ..self.report.clone() }
    }
}
