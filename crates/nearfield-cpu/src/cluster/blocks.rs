//! Particles in blocks of eight, sorted in space, and how far they have moved.

use super::{BLOCK, Moving, padding};
use crate::{Grid, Structure, lanes, parallel::Scattered, physics::Physics};
use nearfield_core::predicate::conservative_range;
use rayon::prelude::*;
use std::ops::Range;

/// Blocks that a task of a pass over particles handles.
pub(super) const PAGE: usize = 64;

/// Evaluations that an inner list is meant to serve.
const HORIZON: f32 = 6.0;

/// Least part of the budget it wants that a particle must be left by the outer list.
const LEAST_BUDGET: f32 = 0.25;

/// Eight vectors, an array for each component.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Octet(pub [[f32; BLOCK]; 3]);

/// Blocks of eight particles. Those of a pencil are sorted along x, the last block of each pencil is padded.
#[derive(Default)]
pub(super) struct Blocks {
    /// Wrapped positions, padding far away.
    pub position: Vec<Octet>,
    /// Types; empty when there is only one.
    pub kind: Vec<[u32; BLOCK]>,
    /// Periods crossed by each particle since the list was built, as small whole numbers.
    pub crossings: Vec<Octet>,
    /// Whether any particle of a block has crossed.
    pub crossed: Vec<bool>,
    /// What each particle may move before the inner list must be pruned.
    pub budget: Vec<[f32; BLOCK]>,
    /// First particle of each block, and a sentinel.
    pub first: Vec<u32>,
    /// Block of each particle.
    pub block_of: Vec<u32>,
    /// Lengths of periodic axes, zero elsewhere.
    pub period: [f32; 3],
    pub cutoff: f32,
    /// Largest magnitude of a coordinate, images included: what rounding errors scale with.
    pub extent: f32,
    at_build: Vec<Octet>,
    at_prune: Vec<Octet>,
    order: Vec<u32>,
    /// Most that a particle may move before the outer list is outrun; negative when nothing may.
    limit: f32,
    /// Budget for what velocities do not foretell.
    surprise: f32,
    evaluations_since_prune: u32,
}

impl Blocks {
    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Particles of block `b`.
    pub fn particles(&self, b: usize) -> Range<usize> {
        self.first[b] as usize..self.first[b + 1] as usize
    }

    /// Number of passes' tasks.
    pub fn n_pages(&self) -> usize {
        self.len().div_ceil(PAGE)
    }

    /// Blocks of page `page`.
    pub fn page(&self, page: usize) -> Range<usize> {
        page * PAGE..((page + 1) * PAGE).min(self.len())
    }

    /// Sorts each pencil of the grid along x. Gives the particle for each place.
    pub fn sort(&mut self, grid: &Grid) -> &[u32] {
        let slots = grid.slots();
        self.order.resize(slots.len(), 0);
        let places = Scattered::new(&mut self.order);
        (0..grid.n_pencils()).into_par_iter().with_min_len(8).for_each(|p| {
            let pencil = grid.pencil_slots(p);
            // SAFETY: the slots of pencils do not overlap.
            let order = unsafe { places.range(pencil.clone()) };
            for (place, slot) in order.iter_mut().zip(pencil) {
                *place = slot as u32;
            }
            sort_along(&slots.x, order);
            for place in order {
                *place = slots.particle[*place as usize];
            }
        });
        &self.order
    }

    /// Fills the blocks with particles in the order of [`Blocks::sort`].
    pub fn fill(&mut self, grid: &Grid, physics: &Physics, moving: Moving, skin: f32) {
        let lengths = physics.sim_box.lengths();
        self.period = std::array::from_fn(|a| if physics.sim_box.is_periodic(a) { lengths[a] } else { 0.0 });
        self.cutoff = physics.cutoff();
        self.first.clear();
        self.block_of.clear();
        for p in 0..grid.n_pencils() {
            let pencil = grid.pencil_slots(p);
            for first in pencil.clone().step_by(BLOCK) {
                let n = BLOCK.min(pencil.end - first);
                self.block_of.extend(std::iter::repeat_n(self.first.len() as u32, n));
                self.first.push(first as u32);
            }
        }
        self.first.push(self.block_of.len() as u32);
        let n = self.first.len() - 1;
        for vectors in [&mut self.position, &mut self.crossings, &mut self.at_build, &mut self.at_prune] {
            vectors.resize(n, Octet::default());
        }
        // Padding does not move.
        self.budget.clear();
        self.budget.resize(n, [f32::INFINITY; BLOCK]);
        self.crossed.resize(n, false);
        self.kind.clear();
        if !moving.kind.is_empty() {
            self.kind.extend(self.first.windows(2).map(|pair| {
                let kinds = &moving.kind[pair[0] as usize..pair[1] as usize];
                std::array::from_fn(|lane| kinds.get(lane).copied().unwrap_or(0))
            }));
        }
        let first = &self.first;
        let pages = self.position.par_chunks_mut(PAGE).zip(self.at_build.par_chunks_mut(PAGE));
        let extent = pages.enumerate().map(|(page, (positions, at_build))| {
            let mut extent = 0.0f32;
            for (k, (position, at_build)) in positions.iter_mut().zip(at_build).enumerate() {
                let b = page * PAGE + k;
                let particles = first[b] as usize..first[b + 1] as usize;
                for axis in 0..3 {
                    position.0[axis] = std::array::from_fn(|lane| padding(b, lane));
                    let from = &moving.position[axis][particles.clone()];
                    position.0[axis][..from.len()].copy_from_slice(from);
                    extent = from.iter().fold(extent, |m, x| m.max(x.abs()));
                }
                *at_build = *position;
            }
            extent
        });
        let extent = extent.reduce(|| 0.0, f32::max);
        self.extent = self.period.into_iter().fold(extent, f32::max) + extent + self.cutoff;
        self.crossings.par_iter_mut().with_min_len(4096).for_each(|c| *c = Octet::default());
        self.crossed.fill(false);
        // What is measured of a displacement is rounded like a coordinate.
        let slack = conservative_range(0.0, self.extent);
        self.limit = 0.5 * skin * (1.0 - 1e-5) - slack;
        self.surprise = if self.surprise > 0.0 { self.surprise } else { 0.01 * self.cutoff };
        self.evaluations_since_prune = 0;
    }

    /// Gives each particle a budget of displacement for the next few evaluations, by its velocity and no more than what
    /// the outer list leaves it. False when that is too little for some particle.
    pub fn plan_motion(&mut self, moving: Moving) -> bool {
        // A budget that lasts longer or shorter than meant is too large or too small.
        if self.evaluations_since_prune > 0 {
            let lasted = self.evaluations_since_prune as f32 / HORIZON;
            self.surprise *= lasted.recip().clamp(0.9, 1.2);
        }
        self.evaluations_since_prune = 0;
        let horizon = HORIZON * moving.dt;
        let Self { first, position, at_build, crossings, period, limit, surprise, budget, at_prune, .. } = self;
        let pages = budget.par_chunks_mut(PAGE).zip(at_prune.par_chunks_mut(PAGE));
        let enough = pages.enumerate().map(|(page, (budgets, at_prune))| {
            let mut least = f32::INFINITY;
            for (k, (budget, at_prune)) in budgets.iter_mut().zip(at_prune).enumerate() {
                let b = page * PAGE + k;
                let particles = first[b] as usize..first[b + 1] as usize;
                *at_prune = position[b];
                let [x, y, z] = moving.velocity.map(|v| &v[particles.clone()]);
                for (lane, ((x, y), z)) in x.iter().zip(y).zip(z).enumerate() {
                    let mut moved2 = 0.0;
                    for axis in 0..3 {
                        let d = position[b].0[axis][lane] - at_build[b].0[axis][lane];
                        let d = d + crossings[b].0[axis][lane] * period[axis];
                        moved2 += d * d;
                    }
                    let wanted = horizon * (x * x + y * y + z * z).sqrt() + *surprise;
                    let left = *limit - moved2.sqrt();
                    budget[lane] = wanted.min(left).max(0.0);
                    least = least.min(left - LEAST_BUDGET * wanted);
                }
            }
            least
        });
        enough.reduce(|| f32::INFINITY, f32::min) >= 0.0
    }

    /// Takes new positions of the same particles. Whether none has used up its budget.
    pub fn refresh(&mut self, position: [&[f32]; 3]) -> bool {
        self.evaluations_since_prune += 1;
        let (first, at_build, at_prune, budget) = (&self.first, &self.at_build, &self.at_prune, &self.budget);
        let period = self.period;
        let pages = self.position.par_chunks_mut(PAGE);
        let pages = pages.zip(self.crossings.par_chunks_mut(PAGE)).zip(self.crossed.par_chunks_mut(PAGE));
        let kept = pages.enumerate().map(|(page, ((to, crossings), crossed))| {
            let blocks = page * PAGE..page * PAGE + to.len();
            super::isa().run(Refresh {
                first: &first[blocks.start..=blocks.end],
                at_build: &at_build[blocks.clone()],
                at_prune: &at_prune[blocks.clone()],
                budget: &budget[blocks],
                position,
                period,
                to,
                crossings,
                crossed,
            })
        });
        kept.reduce(|| true, |a, b| a & b)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let octets = self.position.capacity() + self.crossings.capacity();
        (octets + self.at_build.capacity() + self.at_prune.capacity()) * size_of::<Octet>()
            + (self.kind.capacity() + self.budget.capacity()) * 4 * BLOCK
            + 4 * (self.first.capacity() + self.block_of.capacity() + self.order.capacity())
            + self.crossed.capacity()
    }
}

/// Takes the positions of a page.
struct Refresh<'a> {
    first: &'a [u32],
    at_build: &'a [Octet],
    at_prune: &'a [Octet],
    budget: &'a [[f32; BLOCK]],
    position: [&'a [f32]; 3],
    period: [f32; 3],
    to: &'a mut [Octet],
    crossings: &'a mut [Octet],
    crossed: &'a mut [bool],
}

impl lanes::Kernel for Refresh<'_> {
    /// Whether no particle has exceeded its budget.
    type Output = bool;

    #[inline(always)]
    fn run<L: lanes::Lanes>(self, _: L) -> bool {
        let Self { first, at_build, at_prune, budget, position, period, to, crossings, crossed } = self;
        let mut all_kept = true;
        for k in 0..to.len() {
            let particles = first[k] as usize..first[k + 1] as usize;
            let mut moved2 = [0.0f32; BLOCK];
            for axis in 0..3 {
                let from = &position[axis][particles.clone()];
                let x = &mut to[k].0[axis];
                if let Ok(whole) = <&[f32; BLOCK]>::try_from(from) {
                    *x = *whole;
                } else {
                    x[..from.len()].copy_from_slice(from);
                }
                for lane in 0..BLOCK {
                    let d = x[lane] - at_prune[k].0[axis][lane];
                    moved2[lane] += d * d;
                }
            }
            let mut over = 0.0f32;
            for lane in 0..BLOCK {
                over += if moved2[lane] >= budget[k][lane] * budget[k][lane] { 1.0 } else { 0.0 };
            }
            // Who crosses a periodic face seems to move far.
            if over > 0.0 || crossed[k] {
                let n = particles.len();
                all_kept &= cross(&to[k], [&at_build[k], &at_prune[k]], n, &budget[k], period, &mut crossings[k]);
                crossed[k] = crossings[k] != Octet::default();
            }
        }
        all_kept
    }
}

/// Counts the periods that particles of a block have crossed since the build. Whether, with them, the first `n` keep
/// to their budgets.
#[cold]
fn cross(
    now: &Octet,
    [at_build, at_prune]: [&Octet; 2],
    n: usize,
    budget: &[f32; BLOCK],
    period: [f32; 3],
    crossings: &mut Octet,
) -> bool {
    let mut kept = true;
    for lane in 0..n {
        let mut moved2 = 0.0;
        for axis in 0..3 {
            // The nearest image: whoever moves by half the box has outrun the list either way.
            let nearest = |d: f32| if period[axis] > 0.0 { -(d / period[axis]).round() } else { 0.0 };
            let x = now.0[axis][lane];
            crossings.0[axis][lane] = nearest(x - at_build.0[axis][lane]);
            let d = x - at_prune.0[axis][lane];
            let d = d + nearest(d) * period[axis];
            moved2 += d * d;
        }
        kept &= moved2 < budget[lane] * budget[lane];
    }
    kept
}

/// Sorts `order` by `x`, nearly sorted as it is: the grid has put particles into cells of two.
fn sort_along(x: &[f32], order: &mut [u32]) {
    let mut moves = 8 * order.len();
    for k in 1..order.len() {
        let (slot, key) = (order[k], x[order[k] as usize]);
        let mut at = k;
        while at > 0 && x[order[at - 1] as usize] > key {
            order[at] = order[at - 1];
            at -= 1;
        }
        order[at] = slot;
        moves = moves.saturating_sub(k - at);
        if moves == 0 {
            order.sort_by(|&a, &b| x[a as usize].total_cmp(&x[b as usize]).then(a.cmp(&b)));
            return;
        }
    }
}
