//! Cluster pairs: lists of groups of particles near each other, each pair computed once in whole vectors.
//!
//! Particles are sorted into pencils along x and cut into *blocks* of eight ([`Blocks`]); half a block is a *cluster*
//! of four. The list holds pairs of a cluster and a block with some pair of particles in reach, each pair of particles
//! once ([`PairList`]): block j is listed with cluster i when it comes later, or is i's own. A vector of sixteen lanes
//! holds two particles of a cluster against a block (Páll and Hess, Comput. Phys. Commun. 2013,
//! doi:10.1016/j.cpc.2013.06.003, with the layout that was fastest on Zen 4).
//!
//! The *outer* list holds everything within the cutoff plus a skin and serves until some particle has moved half of
//! the skin. The *inner* list is the part of it that is near enough for the next few evaluations: each particle has a
//! budget of displacement ([`Blocks::plan_motion`]), two particles are kept while their distance exceeds the cutoff by
//! less than both budgets, and the list is pruned anew when some particle has used its budget up. Displacements are
//! measured before each use, so no pair is missed.
//!
//! Which pairs interact, the predicate decides for each evaluation, from wrapped positions: particles that crossed a
//! periodic face since the list was built have it counted in the image ([`Quad`]).

#![expect(clippy::needless_range_loop, reason = "several arrays at one lane or axis, and no closures in kernels")]

mod blocks;
mod exact;
mod lennard_jones;
mod list;
mod quad;
mod sums;
#[cfg(test)]
mod tests;

use crate::{Grid, Slots, lanes::Isa, physics::Physics};
use blocks::Blocks;
use list::PairList;
use nearfield_core::{Truncation, potentials::Potential};
pub(crate) use sums::Output;

/// Particles in a block.
const BLOCK: usize = 8;

/// Where particles are and how they move, in the engine's order; `dt` is zero where they do not.
#[derive(Clone, Copy)]
pub(crate) struct Moving<'a> {
    pub position: [&'a [f32]; 3],
    pub velocity: [&'a [f32]; 3],
    pub kind: &'a [u32],
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
}

impl Clusters {
    /// Takes the present positions. Whether the list still holds every pair; otherwise it must be built.
    pub fn refresh(&mut self, moving: Moving) -> bool {
        if !self.valid {
            return false;
        }
        if !self.blocks.refresh(moving.position) {
            self.valid = self.blocks.plan_motion(moving);
            if self.valid {
                self.list.prune(&self.blocks);
            }
        }
        self.valid
    }

    /// The order of particles in which blocks are contiguous: place k is for particle `order[k]` of the grid's input.
    pub fn order(&mut self, grid: &Grid) -> &[u32] {
        self.blocks.sort(grid)
    }

    /// Builds blocks and list, for particles in [`Clusters::order`]. `skin` is the sum of what two particles may move
    /// before the list is outrun. False when the list would take more than `budget` bytes: there is none then.
    pub fn build(&mut self, grid: &Grid, physics: &Physics, moving: Moving, skin: f32, budget: u64) -> bool {
        self.blocks.fill(grid, physics, moving, skin);
        self.valid = self.list.build(grid, &self.blocks, physics.cutoff() + skin, budget);
        if self.valid {
            self.sums.lay_out(&self.list, self.blocks.len());
            // What is left is nothing where there is no skin: the list is then for one evaluation.
            self.blocks.plan_motion(moving);
            self.list.prune(&self.blocks);
        }
        self.valid
    }

    /// Forces, and energies where `out` has room for them. Sums of `exact` do not depend on the order of terms. False
    /// when some force is not finite.
    pub fn evaluate(&mut self, physics: &Physics, exact: bool, out: Output) -> bool {
        let Self { blocks, list, sums, .. } = self;
        let interaction = &physics.interaction;
        let lennard_jones = matches!(interaction.potential, Potential::LennardJones(_));
        if exact || !lennard_jones || interaction.types.len() > BLOCK {
            exact::evaluate(physics, blocks, list, sums, out)
        } else if let (Truncation::Cut | Truncation::Energy, Some(law)) =
            (interaction.truncation, lennard_jones::Plain::new(physics))
        {
            sums.evaluate(blocks, list, law, out)
        } else if interaction.truncation == Truncation::Force {
            sums.evaluate(blocks, list, lennard_jones::Typed::<true>::new(physics), out)
        } else {
            sums.evaluate(blocks, list, lennard_jones::Typed::<false>::new(physics), out)
        }
    }

    /// Forgets the list: particles were put in another order.
    pub fn invalidate(&mut self) {
        self.valid = false;
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
