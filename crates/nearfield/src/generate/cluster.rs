//! Normally distributed positions, paper A's "Cluster": N(mu, sigma) with a random centre and sigma = 25.

use super::{
    Error, Result,
    random::{MAX_DRAWS, Stream, generator},
};
use nearfield_core::{Boundary, SimBox, Vec3s};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

/// `n` points around `center` with standard deviation `spread` on each axis. Without a centre, one is drawn
/// uniformly from the box. A coordinate outside the box is wrapped on a periodic axis, drawn again on an axis with
/// walls, and kept on an open one.
///
/// # Errors
/// [`Error::NothingInRange`] when the distribution practically misses the space between two walls.
pub fn cluster(n: usize, sim_box: &SimBox, center: Option<[f64; 3]>, spread: f64, seed: u64) -> Result<Vec3s> {
    let mut rng = generator(seed, Stream::Positions);
    let (lo, hi) = (sim_box.lo().map(f64::from), sim_box.hi().map(f64::from));
    // Drawn even when it is given, so that the points around it stay the same.
    let random: [f64; 3] = std::array::from_fn(|axis| lo[axis] + rng.random::<f64>() * (hi[axis] - lo[axis]));
    let center = center.unwrap_or(random);
    let mut positions = Vec3s::default();
    for _ in 0..n {
        let mut point = [0.0; 3];
        for axis in 0..3 {
            let draws = if sim_box.boundary()[axis] == Boundary::Wall { MAX_DRAWS } else { 1 };
            point[axis] = (0..draws)
                .map(|_| {
                    let normal: f64 = StandardNormal.sample(&mut rng);
                    (center[axis] + spread * normal) as f32
                })
                .find(|value| draws == 1 || (sim_box.lo()[axis]..=sim_box.hi()[axis]).contains(value))
                .ok_or(Error::NothingInRange { what: "cluster between walls", low: lo[axis], high: hi[axis] })?;
        }
        positions.push(sim_box.wrap(point).0);
    }
    Ok(positions)
}
