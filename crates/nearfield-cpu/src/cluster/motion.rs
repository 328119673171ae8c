//! How particles move while lists last: where they are expected, how far from there they may be, and who has gone
//! farther.
//!
//! A list is made for particles at their *midway*, where their velocities would take them by half of the list's life:
//! a particle that flies straight on is half as far from there, at most, as it comes to be from where it was. What
//! counts is that nobody is farther from its midway than its budget, whatever was expected, and that is tested at each
//! step.

use super::{
    BLOCK, Keeping, Moving,
    blocks::{Blocks, Octet, Outlook, PAGE, UNMOVED},
};
use crate::lanes;
use nearfield_core::{predicate::conservative_range, skin::ListIntervals};
use rayon::prelude::*;

/// Evaluations that an inner list is meant to serve.
const HORIZON: f32 = 7.0;

/// Least part of the budget it wants that a particle must be left by the outer list.
const LEAST_BUDGET: f32 = 0.25;

/// Most of its limit that a particle may be expected to go in half the life of an outer list.
const LEAD: f32 = 0.6;

/// How much farther than its lead a particle is never seen in a system whose particles are of like speed, and the least
/// of such bounds over the cutoff: whoever is ends a list that serves for a number of steps.
const FAR: f32 = 4.0;
const LEAST_FAR: f32 = 1e-3;

/// What is known of how particles move.
#[derive(Debug, Default)]
pub(super) struct Motion {
    /// Farthest from its midway that a particle may be before the outer list is outrun; negative when nothing may move.
    limit: f32,
    /// Budget for what velocities and forces do not foretell.
    surprise: f32,
    /// Evaluations that the last outer list served.
    pub life: u32,
    /// How lists are kept that serve for a number of steps, whatever particles do.
    intervals: Option<ListIntervals>,
    since_build: u32,
    since_prune: u32,
    /// Whether the forces of the last evaluation were kept.
    knows_forces: bool,
}

/// What is to be done about lists before an evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Due {
    Nothing,
    Pruning,
    Building,
}

impl Motion {
    /// What is due if particles have `kept` to their budgets or not.
    pub fn due(&self, kept: bool) -> Due {
        match self.intervals {
            None if kept => Due::Nothing,
            None => Due::Pruning,
            Some(_) if !kept => Due::Building,
            Some(lists) if self.since_prune < lists.prune_every => Due::Nothing,
            Some(lists) if self.since_build + lists.prune_every <= lists.rebuild_every => Due::Pruning,
            Some(_) => Due::Building,
        }
    }

    /// Whether the forces of the next evaluation are to be kept: budgets go by them, numbers of steps do not.
    pub fn wants_forces(&self) -> bool {
        self.intervals.is_none()
    }

    /// Whether the forces of the last evaluation were kept.
    pub fn knows_forces(&self) -> bool {
        self.knows_forces
    }

    /// The reach of inner lists, where they do not depend on budgets.
    pub fn inner_reach(&self) -> Option<f32> {
        self.intervals.map(|lists| lists.inner_reach)
    }
}

impl Blocks {
    /// Expects particles somewhere halfway through the life of the outer list that is to be built.
    pub fn begin_motion(&mut self, moving: Moving, keeping: Keeping) {
        let skin = keeping.reach(self.cutoff) - self.cutoff;
        let motion = &mut self.motion;
        if motion.since_build > 0 {
            motion.life = motion.since_build;
        }
        (motion.since_build, motion.since_prune) = (0, 0);
        // What is measured of a displacement is rounded like a coordinate.
        motion.limit = 0.5 * skin * (1.0 - 1e-5) - conservative_range(0.0, self.extent);
        motion.surprise = if motion.surprise > 0.0 { motion.surprise } else { 0.01 * self.cutoff };
        self.lead = LEAD * motion.limit.max(0.0);
        let mut life = motion.life;
        motion.intervals = None;
        if let Keeping::Tolerant(lists) = keeping {
            (motion.intervals, life, self.lead) = (Some(lists), lists.rebuild_every, lists.lead);
        }
        let (lead, time) = (self.lead, 0.5 * life as f32 * moving.dt);
        let (first, position) = (&self.first, &self.position);
        if skin == 0.0 {
            return self.midway.copy_from_slice(position);
        }
        self.midway.par_iter_mut().with_min_len(PAGE).enumerate().for_each(|(b, midway)| {
            *midway = position[b];
            let [x, y, z] = moving.velocity.map(|v| &v[first[b] as usize..first[b + 1] as usize]);
            for (lane, ((x, y), z)) in x.iter().zip(y).zip(z).enumerate() {
                let time = time.min(lead / (x * x + y * y + z * z).sqrt());
                for (axis, v) in [x, y, z].into_iter().enumerate() {
                    midway.0[axis][lane] += time * v;
                }
            }
        });
    }

    /// Gives each particle a budget of displacement for the next few evaluations, by its velocity and the last force on it,
    /// and no more than what the outer list leaves it. False when that is too little for some particle.
    pub fn plan_motion(&mut self, moving: Moving) -> bool {
        // Whoever has crossed a face, for now, may come back and cross it again: it is not far from its new midway then.
        for (crossed, crossings) in self.crossed.iter_mut().zip(&self.crossings) {
            *crossed = *crossed && *crossings != Octet::default();
        }
        if let Some(lists) = self.motion.intervals {
            self.foresee_motion(moving, lists);
            return true;
        }
        let motion = &mut self.motion;
        // A budget that lasts longer or shorter than meant is too large or too small.
        if motion.since_prune > 0 {
            let lasted = motion.since_prune as f32 / HORIZON;
            motion.surprise *= lasted.recip().clamp(0.9, 1.2);
        }
        motion.since_prune = 0;
        let Self { first, position, midway, crossings, period, outlook, motion, .. } = self;
        let (first, position, midway, crossings) = (&*first, &*position, &*midway, &*crossings);
        let (limit, surprise, period) = (motion.limit, motion.surprise, *period);
        let enough = outlook.par_chunks_mut(PAGE).enumerate().map(|(page, outlook)| {
            let blocks = page * PAGE..page * PAGE + outlook.len();
            let (position, midway) = (&position[blocks.clone()], &midway[blocks.clone()]);
            let (first, crossings) = (&first[blocks.start..=blocks.end], &crossings[blocks]);
            super::isa().run(Plan { first, moving, position, midway, crossings, period, limit, surprise, outlook })
        });
        enough.reduce(|| true, |a, b| a & b)
    }

    /// Expects particles halfway through the life of the inner list that is to be made, and all nearly there.
    fn foresee_motion(&mut self, moving: Moving, lists: ListIntervals) {
        self.motion.since_prune = 0;
        let time = 0.5 * lists.prune_every as f32 * moving.dt;
        // Who crosses a face must be seen to be far.
        let quarters = self.period.into_iter().filter(|&period| period > 0.0).map(|period| 0.25 * period);
        let far = quarters.fold((FAR * lists.lead).max(LEAST_FAR * self.cutoff), f32::min);
        let Self { first, position, outlook, .. } = self;
        let (first, position) = (&*first, &*position);
        outlook.par_iter_mut().with_min_len(PAGE).enumerate().for_each(|(b, Outlook { midway, budget })| {
            let particles = first[b] as usize..first[b + 1] as usize;
            budget[..particles.len()].fill(far);
            budget[particles.len()..].fill(UNMOVED);
            *midway = position[b];
            for (axis, v) in moving.velocity.iter().enumerate() {
                for (x, v) in midway.0[axis].iter_mut().zip(&v[particles.clone()]) {
                    *x += time * v;
                }
            }
        });
    }

    /// Pages of blocks, to be given new positions.
    pub fn pages(&mut self) -> impl IndexedParallelIterator<Item = Page<'_>> {
        self.motion.knows_forces = self.motion.wants_forces();
        self.motion.since_build += 1;
        self.motion.since_prune += 1;
        let Self { first, midway, outlook, period, position, crossings, crossed, .. } = self;
        let (first, midway, outlook) = (&*first, &*midway, &*outlook);
        let period = *period;
        let pages = position.par_chunks_mut(PAGE).zip(crossings.par_chunks_mut(PAGE)).zip(crossed.par_chunks_mut(PAGE));
        pages.enumerate().map(move |(page, ((position, crossings), crossed))| {
            let blocks = page * PAGE..page * PAGE + position.len();
            Page {
                start: blocks.start,
                first: &first[blocks.start..=blocks.end],
                midway: &midway[blocks.clone()],
                outlook: &outlook[blocks],
                period,
                position,
                crossings,
                crossed,
            }
        })
    }

    /// Takes new positions of the same particles. Whether none has used up its budget.
    pub fn refresh(&mut self, position: [&[f32]; 3]) -> bool {
        let kept = self.pages().map(|page| super::isa().run(Refresh { page, position }));
        kept.reduce(|| true, |a, b| a & b)
    }
}

/// See [`Blocks::plan_motion`].
struct Plan<'a> {
    first: &'a [u32],
    moving: Moving<'a>,
    position: &'a [Octet],
    midway: &'a [Octet],
    crossings: &'a [Octet],
    period: [f32; 3],
    limit: f32,
    surprise: f32,
    outlook: &'a mut [Outlook],
}

impl lanes::Kernel for Plan<'_> {
    /// Whether every particle has budget enough.
    type Output = bool;

    #[inline(always)]
    fn run<L: lanes::Lanes>(self, _: L) -> bool {
        let Moving { velocity, force, kind, types, dt, .. } = self.moving;
        // To the middle of the horizon. Velocities are those of half a step ago.
        let time = 0.5 * HORIZON * dt;
        let time2 = time * (time + dt);
        let forces = !force[0].is_empty();
        let mut enough = true;
        for k in 0..self.position.len() {
            let particles = self.first[k] as usize..self.first[k + 1] as usize;
            let n = particles.len();
            let mut inverse_mass = [if forces { types[0].mass.recip() } else { 0.0 }; BLOCK];
            if forces && !kind.is_empty() {
                for (inverse_mass, &kind) in inverse_mass.iter_mut().zip(&kind[particles.clone()]) {
                    *inverse_mass = types[kind as usize].mass.recip();
                }
            }
            let mut going = [[0.0f32; BLOCK]; 3];
            let (mut speed, mut acceleration) = ([0.0f32; BLOCK], [0.0f32; BLOCK]);
            let (mut there, mut gone, mut ahead) = ([0.0f32; BLOCK], [0.0f32; BLOCK], [0.0f32; BLOCK]);
            for axis in 0..3 {
                let (mut v, mut a) = ([0.0; BLOCK], [0.0; BLOCK]);
                copy(&velocity[axis][particles.clone()], &mut v);
                if forces {
                    copy(&force[axis][particles.clone()], &mut a);
                }
                for lane in 0..BLOCK {
                    a[lane] *= inverse_mass[lane];
                    going[axis][lane] = time * v[lane] + 0.5 * time2 * a[lane];
                    let x = self.position[k].0[axis][lane] + self.crossings[k].0[axis][lane] * self.period[axis];
                    let d = x - self.midway[k].0[axis][lane];
                    let later = d + going[axis][lane];
                    speed[lane] += v[lane] * v[lane];
                    acceleration[lane] += a[lane] * a[lane];
                    there[lane] += going[axis][lane] * going[axis][lane];
                    gone[lane] += d * d;
                    ahead[lane] += later * later;
                }
            }
            let mut foreseen = [false; BLOCK];
            let mut short = 0;
            for lane in 0..BLOCK {
                // Who is accelerated is farther from its midway in the end than now, by no more than `bend`.
                let bend = time2 * acceleration[lane].sqrt();
                let wanted = there[lane].sqrt() + bend + self.surprise;
                let wanted_here = 2.0 * (time * speed[lane].sqrt() + bend) + self.surprise;
                let (left, left_here) = (self.limit - ahead[lane].sqrt(), self.limit - gone[lane].sqrt());
                // Who is near its limit is not expected ahead: whoever is may have nothing left where it is.
                foreseen[lane] = left >= wanted;
                let here = if wanted_here < left_here { wanted_here } else { left_here };
                let here = if here > 0.0 { here } else { 0.0 };
                let budget = if foreseen[lane] { wanted } else { here };
                self.outlook[k].budget[lane] = if lane < n { budget } else { UNMOVED };
                let lacks = !foreseen[lane] & (left_here < LEAST_BUDGET * wanted_here) & (lane < n);
                short |= u32::from(lacks);
            }
            for axis in 0..3 {
                for lane in 0..BLOCK {
                    let x = self.position[k].0[axis][lane];
                    self.outlook[k].midway.0[axis][lane] = if foreseen[lane] { x + going[axis][lane] } else { x };
                }
            }
            enough &= short == 0;
        }
        enough
    }
}

/// Blocks of a page, to be given new positions.
pub(super) struct Page<'a> {
    /// First block.
    pub start: usize,
    first: &'a [u32],
    midway: &'a [Octet],
    outlook: &'a [Outlook],
    period: [f32; 3],
    pub position: &'a mut [Octet],
    crossings: &'a mut [Octet],
    crossed: &'a mut [bool],
}

impl Page<'_> {
    /// Particles of the page's block `k`.
    #[inline(always)]
    pub fn particles(&self, k: usize) -> std::ops::Range<usize> {
        self.first[k] as usize..self.first[k + 1] as usize
    }

    /// Whether no particle of block `k` has exceeded its budget, with who has crossed a face found out.
    #[inline(always)]
    pub fn keeps_to_budget(&mut self, k: usize) -> bool {
        let mut moved2 = [0.0f32; BLOCK];
        for axis in 0..3 {
            for lane in 0..BLOCK {
                let d = self.position[k].0[axis][lane] - self.outlook[k].midway.0[axis][lane];
                moved2[lane] += d * d;
            }
        }
        // Who crosses a periodic face seems to move far.
        if is_over(&moved2, &self.outlook[k].budget) || self.crossed[k] {
            return self.count_crossings(k);
        }
        true
    }

    /// Counts the periods that particles of block `k` have crossed since the build. Whether, with them, all keep to
    /// their budgets.
    #[cold]
    fn count_crossings(&mut self, k: usize) -> bool {
        let mut moved2 = [0.0f32; BLOCK];
        for axis in 0..3 {
            let period = self.period[axis];
            // The nearest image: whoever moves by half the box has outrun the list either way.
            let half = if period > 0.0 { 0.5 * period } else { f32::INFINITY };
            for lane in 0..BLOCK {
                let x = self.position[k].0[axis][lane];
                self.crossings[k].0[axis][lane] = nearest(x - self.midway[k].0[axis][lane], half);
                let d = x - self.outlook[k].midway.0[axis][lane];
                let d = d + nearest(d, half) * period;
                moved2[lane] += d * d;
            }
        }
        // Until the next pruning, though all may have come back.
        self.crossed[k] |= self.crossings[k] != Octet::default();
        !is_over(&moved2, &self.outlook[k].budget)
    }
}

/// Copies the positions of a page. Gives whether all particles keep to their budgets.
struct Refresh<'a> {
    page: Page<'a>,
    position: [&'a [f32]; 3],
}

impl lanes::Kernel for Refresh<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: lanes::Lanes>(self, _: L) -> bool {
        let Self { mut page, position } = self;
        let mut kept = true;
        for k in 0..page.position.len() {
            let particles = page.particles(k);
            for axis in 0..3 {
                copy(&position[axis][particles.clone()], &mut page.position[k].0[axis]);
            }
            kept &= page.keeps_to_budget(k);
        }
        kept
    }
}

/// Whether some particle has used its budget up, by the squares of displacements, or is not anywhere.
#[inline(always)]
fn is_over(moved2: &[f32; BLOCK], budget: &[f32; BLOCK]) -> bool {
    let mut over = [0; BLOCK];
    for lane in 0..BLOCK {
        let keeps = moved2[lane] < budget[lane] * budget[lane];
        over[lane] = u32::from(!keeps);
    }
    over != [0; BLOCK]
}

/// Periods to be added to a displacement from one side of the box to the other, if it is more than `half` a period.
#[inline(always)]
fn nearest(d: f32, half: f32) -> f32 {
    if d >= half {
        -1.0
    } else if d <= -half {
        1.0
    } else {
        0.0
    }
}

/// Copies up to eight values.
#[inline(always)]
fn copy(from: &[f32], to: &mut [f32; BLOCK]) {
    if let Ok(whole) = <&[f32; BLOCK]>::try_from(from) {
        *to = *whole;
    } else {
        to[..from.len()].copy_from_slice(from);
    }
}
