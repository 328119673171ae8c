//! Simple cubic grid, paper A's "Lattice" start.

use super::inside;
use nearfield_core::{SimBox, Vec3s};

/// `n` points on an evenly spaced grid that fills the box: the first `n`, x fastest, of ceil(cbrt(n)) per axis in a
/// cube, of counts proportional to the lengths in other boxes. Points sit in the middle of their cells, so opposite
/// walls are treated alike.
pub fn lattice(n: usize, sim_box: &SimBox) -> Vec3s {
    let lengths = sim_box.lengths().map(f64::from);
    let counts = counts(n, lengths);
    let at = |axis: usize, index: usize| {
        let offset = (index as f64 + 0.5) * lengths[axis] / counts[axis] as f64;
        inside(sim_box, axis, f64::from(sim_box.lo()[axis]) + offset)
    };
    (0..n)
        .map(|i| {
            let (x, rest) = (i % counts[0], i / counts[0]);
            [at(0, x), at(1, rest % counts[1]), at(2, rest / counts[1])]
        })
        .collect()
}

/// Points per axis: refines the axes of widest spacing, those that tie together, until `n` fit.
fn counts(n: usize, lengths: [f64; 3]) -> [usize; 3] {
    let spacing = (lengths.iter().product::<f64>() / n as f64).cbrt();
    let mut counts = lengths.map(|length| ((length / spacing) as usize).max(1));
    while counts.iter().product::<usize>() < n {
        let widest = (0..3).map(|axis| lengths[axis] / counts[axis] as f64).fold(0.0, f64::max);
        for axis in 0..3 {
            if lengths[axis] / counts[axis] as f64 >= widest * (1.0 - 1e-9) {
                counts[axis] += 1;
            }
        }
    }
    counts
}
