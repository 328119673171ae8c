//! What the cost of a system depends on, from a sample of it.

use nearfield_core::{
    Radii, System,
    predicate::{displacement, is_neighbor, squared_length},
};
use rand::{SeedableRng, seq::index};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;
use serde::Serialize;

/// Most particles whose neighbours are counted.
const QUERIES: usize = 512;
/// Most particles that are tried as neighbours: 2^24 pairs take tens of milliseconds.
const TARGETS: usize = 1 << 15;
/// Of the sample; any would do, and the same one each time makes choices repeatable.
const SEED: u64 = 1;

/// What the cost of a system depends on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Survey {
    /// Number of particles.
    pub n: usize,
    /// Estimated mean number of neighbours of a particle.
    pub neighbors: f64,
    /// Whether search radii differ.
    pub variable_radii: bool,
}

impl Survey {
    /// Counts the neighbours of a few particles among a few more.
    ///
    /// ```
    /// use nearfield::{Boundary, Radii, System, Interaction, auto::Survey, generate};
    /// let positions = generate::Positions::Disordered;
    /// let spec = generate::Generate { positions, n: 4000, density: Some(1.0), ..Default::default() };
    /// let start = spec.build([Boundary::Periodic; 3], 1.0)?;
    /// let system = System {
    ///     sim_box: start.sim_box,
    ///     particles: start.particles,
    ///     radii: Radii::Uniform(2.0),
    ///     interaction: Interaction::lennard_jones(),
    /// };
    /// let expected = 4.0 / 3.0 * std::f64::consts::PI * 8.0; // volume of the ball, density 1
    /// assert!((Survey::of(&system).neighbors / expected - 1.0).abs() < 0.2);
    /// # Ok::<(), nearfield::Error>(())
    /// ```
    pub fn of(system: &System) -> Self {
        let n = system.particles.len();
        let mut random = Pcg64Mcg::seed_from_u64(SEED);
        let queries = index::sample(&mut random, n, n.min(QUERIES)).into_vec();
        let targets = index::sample(&mut random, n, n.min(TARGETS)).into_vec();
        let found: usize = queries.par_iter().map(|&i| count(system, i, &targets)).sum();
        let pairs_tried = (queries.len() * targets.len()).max(1) as f64;
        let neighbors = found as f64 / pairs_tried * n as f64;
        Self { n, neighbors, variable_radii: matches!(system.radii, Radii::PerParticle(_)) }
    }

    /// Ordered pairs within range.
    pub fn pairs(&self) -> f64 {
        self.n as f64 * self.neighbors
    }
}

/// How many of `targets` are neighbours of particle `i`.
fn count(system: &System, i: usize, targets: &[usize]) -> usize {
    let position = &system.particles.position;
    let xi = position.get(i);
    let near = |&&j: &&usize| {
        let xj = position.get(j);
        let shift = nearest_image(system, xi, xj);
        j != i && is_neighbor(squared_length(displacement(xi, xj, shift)), system.radii.range(i, j))
    };
    targets.iter().filter(near).count()
}

/// The shift of the image of j nearest to i.
fn nearest_image(system: &System, xi: [f32; 3], xj: [f32; 3]) -> [f32; 3] {
    let lengths = system.sim_box.lengths();
    std::array::from_fn(|axis| {
        let distance = xj[axis] - xi[axis];
        let half = 0.5 * lengths[axis];
        match system.sim_box.is_periodic(axis) {
            true if distance > half => -lengths[axis],
            true if distance < -half => lengths[axis],
            _ => 0.0,
        }
    })
}
