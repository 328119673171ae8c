//! Sparse systems: pairs are found at once, and nothing is kept of them.

use super::{evaluate::Loaded, reorder};
use crate::{
    InputRadii,
    cluster::Output,
    sparse::{self, SparsePairs},
};
use nearfield_core::maintenance::Action;

/// The pairs of a sparse system.
#[derive(Default)]
pub(super) struct StoredPairs {
    pub pairs: SparsePairs,
    /// Whether they are those of the present positions.
    pub found: bool,
}

impl Loaded {
    /// Finds the pairs of a sparse system in the grid that has just been built. Where it is `due`, particles are put into
    /// the grid's order before. False where the system is not sparse.
    pub fn find_sparse_pairs(&mut self, due: bool) -> bool {
        let Self { physics, state, upkeep, sparse: stored, report, .. } = self;
        let cutoff = physics.cutoff();
        let is_sparse = |grid| sparse::is_sparse(grid, cutoff);
        if !physics.radii.is_uniform() || !upkeep.index.grid().is_some_and(is_sparse) {
            return false;
        }
        if due {
            let grid = upkeep.index.grid().expect("there is one");
            // Forces are computed anew before they are looked at.
            state.reorder(grid.order());
            upkeep.update(Action::Build, &state.input(physics, InputRadii::Uniform(cutoff)), report);
        }
        let grid = upkeep.index.grid().expect("there is one");
        stored.found = stored.pairs.find(grid, &physics.sim_box, cutoff);
        stored.found
    }

    /// Whether particles are due to be put in order at `step`.
    pub fn reordering_is_due(&self, step: u64) -> bool {
        self.sorted_at.is_none_or(|then| step >= then + reorder::INTERVAL)
    }

    /// Forces, and energies where results have room, of the pairs that were found. False when some force is not finite.
    pub fn evaluate_sparse_pairs(&mut self) -> bool {
        let Self { physics, state, results, sparse: stored, .. } = self;
        let out = Output {
            force: results.force.axes_mut().map(|axis| &mut axis[..]),
            energy: &mut results.energy,
            virial: &mut results.virial,
            neighbors: &mut results.neighbors,
        };
        let input = state.input(physics, InputRadii::Uniform(physics.cutoff()));
        stored.pairs.evaluate(physics, &input, out)
    }
}
