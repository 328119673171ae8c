//! The scatter consumer: each pair is computed once and added to both particles (ORCS-forces, paper A section 3.2.2).
//!
//! The ray of the particle with the smaller radius acts, ties by index: it is the one sure to be inside the other's
//! box. Sums are exact, so the order in which threads add does not matter.

use super::{
    Finish, Query, Sums,
    accumulate::Kept,
    evaluate,
    group::{Buffers, GROUPS_PER_TASK, Group, each_group},
    select::{Law, with_law},
};
use crate::{
    LANES, Structure,
    lanes::{self, Isa},
    parallel::for_each_chunk,
    physics::Physics,
};
use nearfield_core::interaction::Coefficients;
use rayon::prelude::*;
use std::{
    ops::Range,
    sync::atomic::{AtomicU32, AtomicU64, Ordering::Relaxed},
};

/// Sums of every particle, added to from all threads.
#[derive(Debug, Default)]
pub(crate) struct ScatterSums {
    force: [Vec<AtomicU64>; 3],
    energy: Vec<AtomicU64>,
    virial: Vec<AtomicU64>,
    neighbors: Vec<AtomicU32>,
}

impl ScatterSums {
    /// Zeros for `n` particles.
    pub fn reset(&mut self, n: usize) {
        for sums in self.force.iter_mut().chain([&mut self.energy, &mut self.virial]) {
            sums.clear();
            sums.resize_with(n, AtomicU64::default);
        }
        self.neighbors.clear();
        self.neighbors.resize_with(n, AtomicU32::default);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.neighbors.capacity() * (5 * 8 + 4)
    }

    /// The sums of particle `i`.
    pub fn get(&self, i: usize) -> Sums {
        let read = |sums: &[AtomicU64]| f64::from_bits(sums[i].load(Relaxed));
        Sums {
            force: [read(&self.force[0]) as f32, read(&self.force[1]) as f32, read(&self.force[2]) as f32],
            energy: 0.5 * read(&self.energy),
            virial: 0.5 * read(&self.virial),
            neighbors: self.neighbors[i].load(Relaxed),
        }
    }

    /// Hands out every particle's sums.
    pub fn for_each(&self, finish: Finish) {
        (0..self.neighbors.len() as u32).into_par_iter().for_each(|i| finish(i, &self.get(i as usize)));
    }

    #[inline]
    fn add(&self, i: usize, force: [f64; 3], energy: f64, virial: f64, neighbors: u32) {
        for (sums, value) in self.force.iter().zip(force) {
            add_f64(&sums[i], value);
        }
        add_f64(&self.energy[i], energy);
        add_f64(&self.virial[i], virial);
        self.neighbors[i].fetch_add(neighbors, Relaxed);
    }
}

fn add_f64(sum: &AtomicU64, value: f64) {
    let mut old = sum.load(Relaxed);
    while let Err(now) = sum.compare_exchange_weak(old, (f64::from_bits(old) + value).to_bits(), Relaxed, Relaxed) {
        old = now;
    }
}

/// Computes each pair once and adds it to both particles' sums, which must be reset before.
pub(crate) fn scatter(physics: &Physics, structure: &dyn Structure, sums: &ScatterSums) {
    with_law!(physics, law, coefficients => {
        for_each_chunk(structure.n_groups(), GROUPS_PER_TASK, |groups, buffers: &mut Buffers| {
            Isa::detect().run(Kernel { structure, groups, physics, law, coefficients, buffers, sums });
        });
    });
}

struct Kernel<'a, L, C> {
    structure: &'a dyn Structure,
    groups: Range<usize>,
    physics: &'a Physics,
    law: &'a L,
    coefficients: C,
    buffers: &'a mut Buffers,
    sums: &'a ScatterSums,
}

impl<L: Law, C: Coefficients> lanes::Kernel for Kernel<'_, L, C> {
    type Output = ();

    #[inline(always)]
    fn run<S: lanes::Lanes>(self, lanes: S) {
        let Self { structure, groups, physics, law, coefficients, buffers, sums } = self;
        for g in groups {
            let Some(group) = each_group::<S, C>(lanes, structure, physics, g, buffers) else { continue };
            for slot in group.slots.clone() {
                let Some(query) = group.query(slot) else { continue };
                scatter_query(law, coefficients, physics, &group, &query, sums);
            }
        }
    }
}

#[inline(always)]
fn scatter_query<L: Law, C: Coefficients>(
    law: &L,
    coefficients: C,
    physics: &Physics,
    group: &Group,
    query: &Query,
    sums: &ScatterSums,
) {
    let grain = physics.grain;
    let (mut force, mut energy, mut virial, mut neighbors) = ([0.0; 3], 0.0, 0.0, 0);
    for segment in &group.candidates.segments {
        let shift = group.shift(segment);
        for at in (segment.start..segment.end).step_by(LANES) {
            let block = group.block(at, &shift);
            let mut out = Kept::new();
            evaluate::<L, C, _, true, true>(law, coefficients, physics.cap, query, &block, &mut out);
            for l in 0..LANES {
                let other_radius = if C::VARIABLE_RANGE { block.radius[l] } else { query.radius };
                if out.count[l] == 0 || !acts(query, block.particle[l], other_radius) {
                    continue;
                }
                let f = [grain.force(out.x[l]), grain.force(out.y[l]), grain.force(out.z[l])];
                let (u, w) = (grain.energy(out.energy[l]), grain.energy(out.virial[l]));
                sums.add(block.particle[l] as usize, [-f[0], -f[1], -f[2]], u, w, 1);
                force = [force[0] + f[0], force[1] + f[1], force[2] + f[2]];
                energy += u;
                virial += w;
                neighbors += 1;
            }
        }
    }
    if neighbors > 0 {
        sums.add(query.particle as usize, force, energy, virial, neighbors);
    }
}

/// Whether the query's ray is the one that computes the pair.
#[inline(always)]
fn acts(query: &Query, other: u32, other_radius: f32) -> bool {
    query.radius < other_radius || (query.radius == other_radius && query.particle < other)
}
