//! The radial distribution function g(r), averaged over observations.

use super::{Observer, Sample};
use crate::{NeighborSearch, Result, io::atomic_write};
use nearfield_core::{ListKind, ListRequest, System};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Histogram of pair distances up to the cutoff, written as `r,g` after each observation: g is the density of
/// neighbours at distance r over that of an ideal gas of the box's mean density.
pub struct RadialDistribution {
    path: PathBuf,
    every: u64,
    histogram: Histogram,
}

#[derive(Default, Serialize, Deserialize)]
struct Histogram {
    pairs: Vec<u64>,
    samples: u64,
}

impl RadialDistribution {
    /// A table at `path`, sampled each `every` steps into `bins` bins.
    pub fn new(path: &Path, every: u64, bins: usize) -> Self {
        Self { path: path.to_owned(), every, histogram: Histogram { pairs: vec![0; bins], samples: 0 } }
    }

    fn add(&mut self, system: &System, range: f32) -> Result<()> {
        let positions = system.particles.position.iter();
        let search = NeighborSearch::new(system.sim_box, positions, range)?;
        let list = search.neighbor_list(ListRequest { distances: true, ..ListRequest::new(ListKind::Half) });
        let bins = self.histogram.pairs.len();
        for distance in list.distances.iter().flatten() {
            let bin = (distance / range * bins as f32) as usize;
            self.histogram.pairs[bin.min(bins - 1)] += 1;
        }
        self.histogram.samples += 1;
        Ok(())
    }

    /// Rows of (middle of the bin, g).
    fn rows(&self, system: &System, range: f32) -> Vec<(f64, f64)> {
        let n = system.particles.len() as f64;
        let width = f64::from(range) / self.histogram.pairs.len() as f64;
        let pair_density = 0.5 * n * (n - 1.0) / system.sim_box.volume() * self.histogram.samples as f64;
        let row = |(bin, &pairs): (usize, &u64)| {
            let (inner, outer) = (bin as f64 * width, (bin + 1) as f64 * width);
            let shell = 4.0 / 3.0 * std::f64::consts::PI * (outer.powi(3) - inner.powi(3));
            (0.5 * (inner + outer), pairs as f64 / (pair_density * shell))
        };
        self.histogram.pairs.iter().enumerate().map(row).collect()
    }
}

impl Observer for RadialDistribution {
    fn name(&self) -> &'static str {
        "rdf"
    }

    fn every(&self) -> u64 {
        self.every
    }

    fn observe(&mut self, sample: &mut Sample) -> Result<()> {
        let system = sample.simulation.system()?;
        let range = system.radii.largest();
        self.add(system, range)?;
        let rows = self.rows(system, range);
        atomic_write(&self.path, |out| {
            writeln!(out, "r,g")?;
            rows.iter().try_for_each(|(r, g)| writeln!(out, "{r},{g}"))
        })?;
        Ok(())
    }

    fn save(&mut self) -> Result<Vec<u8>> {
        Ok(rmp_serde::to_vec(&self.histogram).expect("plain arrays can be encoded"))
    }

    fn restore(&mut self, saved: &[u8]) -> Result<()> {
        if let Ok(histogram) = rmp_serde::from_slice(saved) {
            self.histogram = histogram;
        }
        Ok(())
    }
}
