//! Cluster pairs: lists of groups of particles near each other, each pair computed once in whole vectors.
//!
//! Particles are sorted into pencils along x and cut into *blocks* of eight ([`Blocks`]); half a block is a *cluster*
//! of four. The list holds pairs of a cluster and a block with some pair of particles in reach, each pair of particles
//! once ([`PairList`]): block j is listed with cluster i when it comes later, or is i's own. A vector of sixteen lanes
//! holds two particles of a cluster against a block (Páll and Hess, Comput. Phys. Commun. 2013,
//! doi:10.1016/j.cpc.2013.06.003, with the layout that was fastest on Zen 4).
//!
//! The *outer* list holds everything within the cutoff plus a skin and serves until some particle has moved half of
//! the skin from where it was expected ([`motion`]). The *inner* list is the part of it that is near enough for the
//! next few evaluations: each particle has a budget of displacement ([`Blocks::plan_motion`]), two particles are kept
//! while their distance exceeds the cutoff by less than both budgets, and the list is pruned anew when some particle
//! has used its budget up. Displacements are measured before each use, so no pair is missed. Blocks so near that nearly all
//! would be kept are kept without a test ([`list::Segment`]).
//!
//! Or both lists serve for a number of steps ([`Keeping::Tolerant`]), chosen so that what pairs they miss does no more than
//! a tolerance allows ([`nearfield_core::skin::Missed`]).
//!
//! Where particles have very many neighbours no list is stored: the pairs of a few clusters at a time are listed and
//! computed while they are in the cache ([`Clusters::build_without_list`]).
//!
//! Which pairs interact, the predicate decides for each evaluation, from wrapped positions: particles that crossed a
//! periodic face since the list was built have it counted in the image ([`quad::Quad`]).

#![expect(clippy::needless_range_loop, reason = "several arrays at one lane or axis, and no closures in kernels")]

mod balance;
mod blocks;
mod exact;
mod lennard_jones;
mod list;
mod motion;
mod prune;
mod quad;
mod sums;
#[cfg(test)]
mod tests;

use crate::{Grid, Slots, lanes::Isa, physics::Physics};
use blocks::Blocks;
use list::{PairList, Reach, TASKS_PER_THREAD};
use motion::Due;
use nearfield_core::{ParticleType, Truncation, Vec3s, potentials::Potential, skin::ListIntervals};
use std::ops::Range;
pub(crate) use sums::Output;

/// Particles in a block.
pub(crate) const BLOCK: usize = 8;

/// Fewest pairs of clusters and blocks to a block in a list that is not sparse; a melt has forty.
const SPARSE: u64 = 4;

/// Where particles are and how they move, in the engine's order; `dt` is zero where they do not.
#[derive(Clone, Copy)]
pub(crate) struct Moving<'a> {
    pub position: [&'a [f32]; 3],
    pub velocity: [&'a [f32]; 3],
    /// The last ones that were computed; empty where there are none.
    pub force: [&'a [f32]; 3],
    pub kind: &'a [u32],
    /// Their masses count where there are forces.
    pub types: &'a [ParticleType],
    pub dt: f32,
}

/// Blocks, their pair list and the sums of the last evaluation.
#[derive(Default)]
pub(crate) struct Clusters {
    blocks: Blocks,
    list: PairList,
    sums: sums::PageSums,
    /// Whether the list serves: it was built for particles in this order and has not been outrun.
    valid: bool,
    /// How often the list was pruned.
    prunings: u64,
    /// Whether all particles keep to their budgets, where that was found out when they moved.
    kept: Option<bool>,
    /// Whether particles have moved since their positions were fetched.
    moved: bool,
}

/// How a list is kept.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Keeping {
    /// While it misses no pair. `skin` is the sum of what two particles may move before it is outrun; without any it is
    /// good for one evaluation.
    Strict { skin: f32 },
    /// For a number of steps.
    Tolerant(ListIntervals),
}

impl Keeping {
    /// For one evaluation.
    const ONCE: Self = Self::Strict { skin: 0.0 };

    /// How far the list reaches.
    pub fn reach(self, cutoff: f32) -> f32 {
        match self {
            Self::Strict { skin } => cutoff + skin,
            Self::Tolerant(lists) => lists.outer_reach,
        }
    }
}

/// The work a list has made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counts {
    /// Pairs of clusters and blocks.
    pub entries: u64,
    /// Those that were left by the last pruning.
    pub entries_of_inner: u64,
    pub prunings: u64,
}

/// Moves particles.
pub(crate) trait Mover: Sync {
    /// Moves `particles`, all those of a block, from `position` by `force`, and leaves there where they are then.
    /// Implementations are `#[inline(always)]`.
    fn advance(&self, particles: Range<usize>, force: &[[f32; BLOCK]; 3], position: &mut [[f32; BLOCK]; 3]);
}

/// Whether pairs can be computed in whole vectors.
pub(crate) fn has_vector_law(physics: &Physics) -> bool {
    let interaction = &physics.interaction;
    matches!(interaction.potential, Potential::LennardJones(_)) && interaction.types.len() <= BLOCK
}

impl Clusters {
    /// Takes the present positions. Whether the list still serves; otherwise it must be built. One that serves for a number
    /// of steps is not pruned once more unless particles are `calm`, as slow as was thought.
    pub fn refresh(&mut self, moving: Moving, calm: impl FnOnce() -> bool) -> bool {
        let kept = self.kept.take();
        if !self.valid {
            return false;
        }
        let kept = kept.unwrap_or_else(|| self.blocks.refresh(moving.position));
        match self.blocks.motion.due(kept) {
            Due::Nothing => return true,
            Due::Pruning => self.valid = calm() && self.blocks.plan_motion(moving),
            Due::Building => self.valid = false,
        }
        if self.valid {
            self.prune();
        }
        self.valid
    }

    fn prune(&mut self) {
        self.list.prune(&self.blocks, self.blocks.motion.inner_reach());
        self.prunings += 1;
        if self.is_sparse() {
            self.sums.lay_out(&mut self.list, &self.blocks, Reach::Inner);
        }
    }

    /// Whether so little is near that most pages of sums are spared when only what is pruned is reached.
    fn is_sparse(&self) -> bool {
        self.list.entries() < SPARSE * self.blocks.len() as u64
    }

    /// What the list holds and how often it was pruned.
    pub fn counts(&self) -> Counts {
        let Self { list, prunings, .. } = self;
        Counts { entries: list.entries(), entries_of_inner: list.entries_of_inner(), prunings: *prunings }
    }

    /// Builds blocks and list, for particles in the order of the grid's slots. False when the list would take more than
    /// `budget` bytes: there is none then.
    pub fn build(&mut self, grid: &Grid, physics: &Physics, moving: Moving, keeping: Keeping, budget: u64) -> bool {
        self.blocks.fill(grid, physics, moving, keeping);
        let listed = self.list.build(grid, &self.blocks, keeping.reach(physics.cutoff()), budget);
        self.valid = listed && !matches!(keeping, Keeping::Strict { skin: 0.0 });
        if listed && !(self.valid && self.is_sparse()) {
            self.sums.lay_out(&mut self.list, &self.blocks, Reach::Outer);
        }
        if self.valid {
            self.blocks.plan_motion(moving);
            self.prunings = 0;
            self.prune();
        } else if listed {
            self.list.use_once();
        }
        listed
    }

    /// Builds blocks without a list, for particles in the order of the grid's slots that are to be evaluated once, with the grid.
    pub fn build_without_list(&mut self, grid: &Grid, physics: &Physics, moving: Moving) {
        self.valid = false;
        self.blocks.fill(grid, physics, moving, Keeping::ONCE);
        self.list.divide(&self.blocks, 2 * TASKS_PER_THREAD, &[]);
        self.sums.lay_out(&mut self.list, &self.blocks, Reach::Grid(grid));
    }

    /// Forces, and energies where `out` has room for them. Sums of `exact` do not depend on the order of terms. With a
    /// `grid` pairs are found in it, batch by batch, after [`Clusters::build_without_list`]. False when some force is
    /// not finite.
    pub fn evaluate(&mut self, physics: &Physics, grid: Option<&Grid>, exact: bool, out: Output) -> bool {
        if exact || !has_vector_law(physics) {
            exact::evaluate(physics, &self.blocks, &mut self.list, grid, &mut self.sums, out)
        } else {
            let scale = self.compute(physics, grid, !out.energy.is_empty());
            self.sums.give(&self.blocks, scale, out)
        }
    }

    /// Computes forces and has particles moved by them, all where there is a list and a law for vectors
    /// ([`has_vector_law`]). Their new positions stay here, and the next [`Clusters::refresh`] need not look at others,
    /// until they are asked for ([`Clusters::fetch_positions`]).
    pub fn advance<M: Mover>(&mut self, physics: &Physics, mover: &M) {
        let scale = self.compute(physics, None, false);
        self.kept = Some(self.sums.advance(&mut self.blocks, scale, mover));
        self.moved = true;
    }

    /// Whether to keep the forces of the next evaluation: they help to foresee motion.
    pub fn wants_forces(&self) -> bool {
        self.blocks.motion.wants_forces()
    }

    /// Whether the forces of the last evaluation were to be kept.
    pub fn knows_forces(&self) -> bool {
        self.blocks.motion.knows_forces()
    }

    /// Copies where particles are to `position`, after [`Clusters::advance`], which leaves it to the blocks to know.
    pub fn fetch_positions(&mut self, position: &mut Vec3s) {
        if std::mem::take(&mut self.moved) {
            self.blocks.copy_positions(position.axes_mut().map(|axis| &mut axis[..]));
        }
    }

    fn compute(&mut self, physics: &Physics, grid: Option<&Grid>, energies: bool) -> f32 {
        let Self { blocks, list, sums, .. } = self;
        let truncation = physics.interaction.truncation;
        if let (Truncation::Cut | Truncation::Energy, Some(law)) = (truncation, lennard_jones::Plain::new(physics)) {
            sums.compute(blocks, list, grid, law, energies)
        } else if truncation == Truncation::Force {
            sums.compute(blocks, list, grid, lennard_jones::Typed::<true>::new(physics), energies)
        } else {
            sums.compute(blocks, list, grid, lennard_jones::Typed::<false>::new(physics), energies)
        }
    }

    /// Forgets the list: particles were put in another order.
    pub fn invalidate(&mut self) {
        (self.valid, self.kept) = (false, None);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.blocks.bytes() + self.list.bytes() + self.sums.bytes()
    }
}

/// Coordinates of padding lane `lane` of block `block`: far, and no two alike, so that none is in range of another.
fn padding(block: usize, lane: usize) -> f32 {
    let number = (block * BLOCK + lane) & 0xf_ffff;
    Slots::FAR * (0.5 + number as f32 / (1 << 21) as f32)
}

fn isa() -> Isa {
    Isa::detect()
}
