//! Sparse systems: most particles have no neighbour at all, and nothing is stored but the few pairs that there are.
//!
//! The grid has the particles of each pencil sorted along x. So pairs of a pencil are found by comparing each particle
//! with those after it until they are too far along x, sixteen particles at a time, and pairs of two pencils by
//! comparing the few particles near their common face in the same way ([`sweep`]). That costs little more than
//! looking at each particle once, where lists of rows or of clusters cost the same whether there are pairs or not.
//!
//! Sums do not depend on the order of terms ([`sums`]).

mod sums;
mod sweep;
#[cfg(test)]
mod tests;

use crate::{Grid, lanes::Isa};
use nearfield_core::SimBox;
use rayon::prelude::*;
use sums::Sums;
use sweep::{Sweep, Task};

/// Neighbours of a particle, as the density lets expect, up to which a system is sparse.
const SPARSE: f64 = 1.0;

/// Tests for each particle after which looking for pairs is given up: the sparsest systems take half of one.
const MOST_TESTS: usize = 8;

/// Tasks for each thread.
const TASKS_PER_THREAD: usize = 8;

/// Two particles within range: `dr = (x_j - x_i) + image * box length`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pair {
    pub i: u32,
    pub j: u32,
    pub image: [i8; 3],
}

/// The pairs of a sparse system at one moment.
#[derive(Default)]
pub(crate) struct SparsePairs {
    tasks: Vec<Task>,
    pairs: Vec<Pair>,
    sums: Sums,
}

/// Whether so few neighbours are to be expected within `radius` that looking for pairs is worthwhile.
pub(crate) fn is_sparse(grid: &Grid, radius: f32) -> bool {
    grid.expected_neighbors(radius) <= SPARSE
}

impl SparsePairs {
    /// Finds all pairs closer than `radius`. False, with nothing found, when it turns out that there are too many
    /// candidates, clustered as they are where density does not show it.
    pub fn find(&mut self, grid: &Grid, sim_box: &SimBox, radius: f32) -> bool {
        self.find_on(Isa::detect(), grid, sim_box, radius, MOST_TESTS)
    }

    fn find_on(&mut self, isa: Isa, grid: &Grid, sim_box: &SimBox, radius: f32, most_tests: usize) -> bool {
        let n = grid.n_pencils();
        let n_tasks = (TASKS_PER_THREAD * rayon::current_num_threads()).min(n);
        self.tasks.resize_with(n_tasks, Task::default);
        let tasks = self.tasks.par_iter_mut().with_max_len(1).enumerate();
        let few = tasks.map(|(t, task)| {
            let pencils = n * t / n_tasks..n * (t + 1) / n_tasks;
            isa.run(Sweep { grid, sim_box, radius, most_tests, pencils, task })
        });
        let few = few.reduce(|| true, |a, b| a & b);
        self.pairs.clear();
        if few {
            self.tasks.iter().for_each(|task| self.pairs.extend_from_slice(&task.pairs));
        }
        few
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let tasks = self.tasks.iter().map(Task::bytes).sum::<usize>();
        tasks + self.pairs.capacity() * size_of::<Pair>() + self.sums.bytes()
    }
}
