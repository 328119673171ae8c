//! Forces and energies of the pairs that were found.

use super::SparsePairs;
use crate::{Input, cluster::Output, kernel::with_law, parallel::Scattered, physics::Physics};
use nearfield_core::{
    interaction::{Coefficients, PairLaw},
    predicate,
};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Fewest pairs worth a task.
const TASK: usize = 256;

/// What pairs add to their particles, and who is in a pair.
#[derive(Default)]
pub(super) struct Sums {
    /// Force on the first particle, energy and virial of each pair.
    terms: Vec<[f64; 5]>,
    /// Particle, pair, and whether it is the second of the pair, from the highest bits to the lowest.
    ends: Vec<u64>,
}

impl Sums {
    pub fn bytes(&self) -> usize {
        40 * self.terms.capacity() + 8 * self.ends.capacity()
    }
}

impl SparsePairs {
    /// Forces, and energies where `out` has room for them, of the particles of `input`, as the pairs were found. False
    /// when some force is not finite.
    pub fn evaluate(&mut self, physics: &Physics, input: &Input, out: Output) -> bool {
        let Self { pairs, sums: Sums { terms, ends }, .. } = self;
        let (cutoff, cap, grain) = (physics.cutoff(), physics.cap, physics.grain);
        let kind = |i: u32| input.kind.get(i as usize).copied().unwrap_or(0);
        with_law!(physics, law, coefficients => {
            pairs.par_iter().with_min_len(TASK).map(|pair| {
                let shift = physics.sim_box.shift(pair.image);
                let dr = predicate::displacement(input.at(pair.i as usize), input.at(pair.j as usize), shift);
                let r2 = predicate::squared_length(dr);
                let c = coefficients.get(kind(pair.i), kind(pair.j), cutoff);
                let (f, u) = (law.f_over_r(r2, &c), law.energy(r2, &c));
                let f = if f < cap { f } else { cap };
                let u = if u < cap { u } else { cap };
                let [x, y, z] = dr.map(|d| grain.force(-(f * d)));
                [x, y, z, grain.energy(u), grain.energy(f * r2)]
            }).collect_into_vec(terms)
        });
        ends.clear();
        let end = |particle: u32, pair: usize, second: u64| u64::from(particle) << 32 | (pair as u64) << 1 | second;
        ends.extend(pairs.iter().enumerate().flat_map(|(k, pair)| [end(pair.i, k, 0), end(pair.j, k, 1)]));
        ends.par_sort_unstable();
        hand_out(terms, ends, out)
    }
}

/// Writes the sums of all particles to where they go.
fn hand_out(terms: &[[f64; 5]], ends: &[u64], out: Output) -> bool {
    let Output { force, energy, virial, neighbors } = out;
    let energies = !energy.is_empty();
    clear(energy);
    clear(virial);
    clear(neighbors);
    let force = force.map(|axis| {
        clear(axis);
        Scattered::new(axis)
    });
    let (energy, virial, neighbors) = (Scattered::new(energy), Scattered::new(virial), Scattered::new(neighbors));
    let finite = AtomicBool::new(true);
    ends.par_chunk_by(|a, b| a >> 32 == b >> 32).for_each(|ends| {
        let i = (ends[0] >> 32) as usize;
        let mut sums = [0.0; 5];
        for end in ends {
            let term = &terms[(end & 0xffff_ffff) as usize >> 1];
            let sign = if end & 1 == 0 { 1.0 } else { -1.0 };
            for axis in 0..3 {
                sums[axis] += sign * term[axis];
            }
            sums[3] += term[3];
            sums[4] += term[4];
        }
        let [x, y, z, u, w] = sums;
        for (axis, sum) in force.iter().zip([x, y, z]) {
            if !(sum as f32).is_finite() {
                finite.store(false, Relaxed);
            }
            // SAFETY: each particle has its ends in one chunk.
            unsafe { axis.write(i, sum as f32) };
        }
        if energies {
            // SAFETY: as above.
            unsafe {
                energy.write(i, 0.5 * u);
                virial.write(i, 0.5 * w);
                neighbors.write(i, ends.len() as u32);
            }
        }
    });
    finite.into_inner()
}

fn clear<T: Copy + Default + Send>(values: &mut [T]) {
    values.par_chunks_mut(1 << 14).for_each(|chunk| chunk.fill(T::default()));
}
