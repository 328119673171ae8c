//! Steps by lists, and the lists they need on the way, without waiting in between.

use super::{
    Clusters,
    list::StepQuery,
    pace::{Served, Stretch},
};
use crate::Sequence;
use nearfield_core::{Report, Result};
use std::ops::Range;

/// Lists to a sequence: particles are then in the memory that they were in before, and so the next one is the same.
const LISTS: usize = 2;

impl Clusters {
    /// Makes steps from forces at the first of `steps` on, whose positions the list serves, and none beyond the last; waits
    /// for the device to know how many there were. Lists are made anew on the way until about step `replan`. Where there
    /// was no room for a list it is then made with more, or pairs are found in cells where it would exceed the budget.
    pub(crate) fn steps(
        &mut self,
        mut query: StepQuery,
        steps: Range<u64>,
        replan: u64,
        report: &mut Report,
    ) -> Result<u64> {
        if query.state.len() == 0 {
            return Ok(steps.end - steps.start);
        }
        let stretch = self.pace.stretch(steps.end.min(replan).saturating_sub(steps.start));
        self.list.begin_steps(&mut query, steps.start, steps.end)?;
        for first in (0..stretch.lists).step_by(LISTS) {
            let sequence = Sequence::default();
            for _ in first..stretch.lists.min(first + LISTS as u64) {
                self.list.enqueue_steps(&sequence, &query, &self.grid, stretch.steps)?;
                self.enqueue_list(&sequence, query.physics, query.state)?;
            }
            // SAFETY: all arrays have their size and keep it until the steps have been waited for.
            unsafe { self.gpu.run(&sequence)? };
        }
        if stretch.rest > 0 {
            let sequence = Sequence::default();
            self.list.enqueue_steps(&sequence, &query, &self.grid, stretch.rest)?;
            // SAFETY: as above.
            unsafe { self.gpu.run(&sequence)? };
        }
        self.finish_steps(query, steps.start, stretch, report)
    }

    fn finish_steps(&mut self, query: StepQuery, first: u64, stretch: Stretch, report: &mut Report) -> Result<u64> {
        let outcome = self.list.finish_steps(first)?;
        report.builds += outcome.lists;
        report.list_builds += outcome.lists;
        report.dangerous_builds += outcome.dangerous;
        if !self.list.is_settled() {
            self.pace.hold_back();
            self.settle(query.physics, query.state, report)?;
        } else if outcome.lists > 0 || !outcome.fresh || outcome.longest >= stretch.steps {
            let steps = outcome.made - outcome.by_last;
            self.pace.learn(Served { lists: outcome.lists, steps, longest: outcome.longest });
        }
        Ok(outcome.made)
    }
}
