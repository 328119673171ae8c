//! Uniformly random positions, paper A's "Disordered" and paper B's uniform start.

use super::{
    inside,
    random::{Stream, generator},
};
use nearfield_core::{SimBox, Vec3s};
use rand::RngExt;

/// `n` independent points, uniform in the box. They may overlap: a run from them with a diverging potential needs
/// `dynamics.max_displacement`.
pub fn disordered(n: usize, sim_box: &SimBox, seed: u64) -> Vec3s {
    let mut rng = generator(seed, Stream::Positions);
    let (lo, lengths) = (sim_box.lo().map(f64::from), sim_box.lengths().map(f64::from));
    (0..n)
        .map(|_| std::array::from_fn(|axis| inside(sim_box, axis, lo[axis] + rng.random::<f64>() * lengths[axis])))
        .collect()
}
