//! The scatter consumer: each pair is computed once and added to both particles (ORCS-forces, paper A section 3.2.2).
//!
//! The ray of the particle with the smaller radius acts, ties by index: it is the one sure to be inside the other's
//! box. Sums are exact, so the order in which threads add does not matter.

use super::{
    Query, Sums,
    accumulate::Kept,
    block::evaluate,
    gather::{GROUPS_PER_TASK, group_box, slot_block, slot_query},
    select::with_law,
};
use crate::{LANES, Run, Slots, Structure, physics::Physics};
use nearfield_core::interaction::{Coefficients, PairLaw};
use pulp::{Arch, NullaryFnOnce};
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
    pub fn for_each(&self, finish: super::Finish) {
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
        crate::parallel::for_each_chunk(structure.n_groups(), GROUPS_PER_TASK, |groups, runs| {
            Arch::new().dispatch(Kernel { structure, groups, physics, law, coefficients, runs, sums });
        });
    });
}

struct Kernel<'a, L, C> {
    structure: &'a dyn Structure,
    groups: Range<usize>,
    physics: &'a Physics,
    law: &'a L,
    coefficients: &'a C,
    runs: &'a mut Vec<Run>,
    sums: &'a ScatterSums,
}

impl<L: PairLaw, C: Coefficients> NullaryFnOnce for Kernel<'_, L, C> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let slots = self.structure.slots();
        for g in self.groups.clone() {
            let group = self.structure.group(g);
            let Some(bounds) = group_box(slots, group.clone(), self.physics.cutoff()) else { continue };
            let mut runs = std::mem::take(self.runs);
            runs.clear();
            self.structure.runs(&bounds, &mut runs);
            for slot in group.filter(|&slot| slots.particle[slot] != u32::MAX) {
                self.scatter_query(slots, slot, &runs);
            }
            *self.runs = runs;
        }
    }
}

impl<L: PairLaw, C: Coefficients> Kernel<'_, L, C> {
    #[inline(always)]
    fn scatter_query(&self, slots: &Slots, slot: usize, runs: &[Run]) {
        let query = slot_query(slots, slot, self.physics.cutoff());
        let particle = slots.particle[slot];
        let (mut force, mut energy, mut virial, mut neighbors) = ([0.0; 3], 0.0, 0.0, 0);
        for run in runs {
            let shift = self.physics.sim_box.shift(run.image);
            let shift = [[shift[0]; LANES], [shift[1]; LANES], [shift[2]; LANES]];
            let mut s = run.start as usize;
            while s < run.end as usize {
                let block = slot_block::<C>(slots, s, run.end as usize, slot, &shift);
                let mut out = Kept::new();
                evaluate::<L, C, _, true>(self.law, self.coefficients, self.physics.cap, &query, &block, &mut out);
                for l in (0..LANES).filter(|&l| out.count[l] != 0) {
                    let other = slots.particle[s + l];
                    if !acts(&query, particle, slots, s + l, other) {
                        continue;
                    }
                    let grain = self.physics.grain;
                    let f = [grain.force(out.x[l]), grain.force(out.y[l]), grain.force(out.z[l])];
                    let (u, w) = (grain.energy(out.energy[l]), grain.energy(out.virial[l]));
                    self.sums.add(other as usize, f.map(|f| -f), u, w, 1);
                    for axis in 0..3 {
                        force[axis] += f[axis];
                    }
                    energy += u;
                    virial += w;
                    neighbors += 1;
                }
                s += LANES;
            }
        }
        if neighbors > 0 {
            self.sums.add(particle as usize, force, energy, virial, neighbors);
        }
    }
}

/// Whether the query's ray is the one that computes the pair.
#[inline(always)]
fn acts(query: &Query, particle: u32, slots: &Slots, slot: usize, other: u32) -> bool {
    let other_radius = if slots.radius.is_empty() { query.radius } else { slots.radius[slot] };
    query.radius < other_radius || (query.radius == other_radius && particle < other)
}
