//! What steps cost, by the clock of the device.

use crate::{Gpu, gpu::Mark};
use nearfield_core::{Report, Result, StepCost};
use std::collections::VecDeque;

/// Steps whose marks are kept before the oldest are read: reading waits, so the device should be well past them.
const PENDING: usize = 256;

/// Marks of steps, read when they are long past or when somebody needs to know.
#[derive(Default)]
pub(crate) struct Timeline {
    open: Option<Open>,
    pending: VecDeque<Step>,
    /// End of the last query, where integration begins.
    last_query: Option<Box<dyn Mark>>,
}

struct Open {
    begin: Box<dyn Mark>,
    recorded: bool,
    updated: Option<(bool, Box<dyn Mark>)>,
}

struct Step {
    /// End of the query before, in the same run.
    before: Option<Box<dyn Mark>>,
    begin: Box<dyn Mark>,
    updated: Option<(bool, Box<dyn Mark>)>,
    end: Box<dyn Mark>,
    recorded: bool,
}

/// What a step cost, beside integration.
pub(crate) struct Cost {
    pub step: StepCost,
    /// Whether the structure was built or refitted at all.
    pub updated: bool,
    /// Whether it is to be kept in the history.
    pub recorded: bool,
}

impl Timeline {
    /// A step's upkeep begins. `recorded`: the history is to keep what it costs.
    pub fn begin(&mut self, gpu: &dyn Gpu, recorded: bool) -> Result<()> {
        self.open = Some(Open { begin: gpu.mark()?, recorded, updated: None });
        Ok(())
    }

    /// The structure has been built or refitted.
    pub fn updated(&mut self, gpu: &dyn Gpu, built: bool) -> Result<()> {
        if let Some(open) = &mut self.open {
            open.updated = Some((built, gpu.mark()?));
        }
        Ok(())
    }

    /// The query is over. Gives the costs that have become known.
    pub fn end(&mut self, gpu: &dyn Gpu, report: &mut Report, wait: bool) -> Result<Vec<Cost>> {
        let Some(Open { begin, recorded, updated }) = self.open.take() else { return Ok(Vec::new()) };
        let before = self.last_query.take();
        self.pending.push_back(Step { before, begin, updated, end: gpu.mark()?, recorded });
        self.last_query = Some(gpu.mark()?);
        if wait || self.pending.len() > PENDING { self.read(report) } else { Ok(Vec::new()) }
    }

    /// Reads all marks, waiting for them, and books what they say.
    pub fn read(&mut self, report: &mut Report) -> Result<Vec<Cost>> {
        self.pending.drain(..).map(|step| step.read(report)).collect()
    }

    /// What follows is not integration.
    pub fn pause(&mut self) {
        self.last_query = None;
    }
}

impl Step {
    fn read(self, report: &mut Report) -> Result<Cost> {
        let (built, structure, from) = match &self.updated {
            Some((built, mark)) => (*built, mark.seconds_since(&*self.begin)?, mark),
            None => (false, 0.0, &self.begin),
        };
        let query = self.end.seconds_since(&**from)?;
        if built {
            report.build_seconds += structure;
        } else {
            report.refit_seconds += structure;
        }
        report.query_seconds += query;
        if let Some(before) = &self.before {
            report.integrate_seconds += self.begin.seconds_since(&**before)?;
        }
        Ok(Cost {
            step: StepCost { built, structure, query },
            updated: self.updated.is_some(),
            recorded: self.recorded,
        })
    }
}
