//! The structure of a method, and its query.

use super::{physics::Physics, results::Results, state::State, survey::Survey};
use crate::Gpu;
use nearfield_core::{Plan, Report, Result, maintenance::Action};
use nearfield_kernels::Ptr;
use std::sync::Arc;

/// What a query needs.
pub(crate) struct Query<'a> {
    pub plan: &'a Plan,
    pub physics: &'a Physics,
    pub state: &'a State,
    pub results: &'a mut Results,
    pub energy: bool,
    pub report: &'a mut Report,
}

/// What an update did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Updated {
    /// Built rather than refitted.
    pub built: bool,
    /// Built although a refit was asked for.
    pub forced: bool,
}

/// One structure.
pub(crate) enum Structure {
    Brute,
}

impl Structure {
    pub fn new(_gpu: &Arc<dyn Gpu>, _plan: &Plan, _physics: &Physics) -> Result<Self> {
        Ok(Self::Brute)
    }

    pub fn is_fresh(&mut self, _state: &State, _physics: &Physics) -> Result<bool> {
        Ok(false)
    }

    pub fn needs_survey(&self) -> bool {
        false
    }

    pub fn plan(&mut self, _survey: &Survey, _physics: &Physics) -> Result<()> {
        Ok(())
    }

    pub fn update(&mut self, _action: Action, _state: &State, _physics: &Physics) -> Result<Updated> {
        Ok(Updated { built: true, forced: false })
    }

    pub fn cell_order(
        &mut self,
        _gpu: &Arc<dyn Gpu>,
        _survey: &Survey,
        _state: &State,
        _physics: &Physics,
    ) -> Result<Ptr<u32>> {
        Ok(Ptr::NULL)
    }

    pub fn evaluate(&mut self, _query: Query) -> Result<()> {
        Ok(())
    }

    pub fn bytes(&self) -> u64 {
        0
    }
}
