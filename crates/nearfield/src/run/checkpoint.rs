//! Checkpoints: everything a run needs to continue, in MessagePack.

use crate::{
    Error, Result,
    config::{Choice, Config},
    io::atomic_write,
};
use nearfield_core::{Method, Particles, Radii, Report, SimBox, System, engine::MemoryOrder};
use serde::{Deserialize, Serialize};
use std::{collections::BTreeMap, fs, path::Path};

/// Version of the layout below.
const FORMAT: u32 = 2;

/// The state of a run between two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    format: u32,
    /// The configuration, as TOML.
    pub config: String,
    /// The method that was running.
    pub method: Method,
    /// Steps done.
    pub step: u64,
    /// The box.
    pub sim_box: SimBox,
    /// The particles, in input order.
    pub particles: Particles,
    /// Ranges.
    pub radii: Radii,
    /// How the particles lay in memory.
    pub order: MemoryOrder,
    /// What was done so far.
    pub report: Report,
    /// What observers saved, by name.
    pub observers: BTreeMap<String, Vec<u8>>,
}

impl Checkpoint {
    /// The state of a system after `step`.
    pub fn new(system: &System, method: Method, step: u64, order: MemoryOrder) -> Self {
        Self {
            format: FORMAT,
            config: String::new(),
            method,
            step,
            sim_box: system.sim_box,
            particles: system.particles.clone(),
            radii: system.radii.clone(),
            order,
            report: Report::default(),
            observers: BTreeMap::new(),
        }
    }

    /// Puts the saved state into a system, whose interaction stays.
    ///
    /// # Errors
    /// As [`System::validate`]; the system is then unchanged.
    pub fn apply(&self, system: &mut System) -> Result<()> {
        let saved = System {
            sim_box: self.sim_box,
            particles: self.particles.clone(),
            radii: self.radii.clone(),
            interaction: system.interaction.clone(),
        };
        saved.validate()?;
        self.check_order()?;
        *system = saved;
        Ok(())
    }

    /// The memory order must name each particle once.
    fn check_order(&self) -> Result<()> {
        let (n, ids) = (self.particles.len(), &self.order.ids);
        if ids.is_empty() {
            return Ok(());
        }
        let mut seen = vec![false; n];
        let is_new = |&id: &u32| seen.get_mut(id as usize).is_some_and(|seen| !std::mem::replace(seen, true));
        if ids.len() == n && ids.iter().all(is_new) {
            return Ok(());
        }
        let reason = "must hold each particle once";
        Err(nearfield_core::Error::InvalidParameter {
            name: "memory order",
            value: format!("{} ids", ids.len()),
            reason,
        }
        .into())
    }

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// [`crate::io::IoError::Write`].
    pub fn write(&self, path: &Path) -> Result<()> {
        let bytes = rmp_serde::to_vec_named(self).expect("plain data can be encoded");
        Ok(atomic_write(path, |out| out.write_all(&bytes))?)
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::Resume`] when it is missing, damaged or of another version.
    pub fn read(path: &Path) -> Result<Self> {
        let refused = |reason: String| Error::Resume { path: path.to_owned(), reason };
        let bytes = fs::read(path).map_err(|source| refused(source.to_string()))?;
        let checkpoint: Self =
            rmp_serde::from_slice(&bytes).map_err(|source| refused(format!("not a checkpoint: {source}")))?;
        if checkpoint.format != FORMAT {
            return Err(refused(format!("format {} is not {FORMAT}, the one of this version", checkpoint.format)));
        }
        Ok(checkpoint)
    }

    /// Says what in a configuration contradicts the checkpoint.
    pub(super) fn check(&self, config: &Config) -> Result<(), String> {
        let then = Config::parse(&self.config, &[], config.folder.clone())
            .map_err(|error| format!("its configuration is not understood: {error}"))?;
        let mut now = config.clone();
        now.dynamics.steps = then.dynamics.steps;
        now.method.name = match config.method.name {
            // The choice was made when the run began.
            Choice::Auto => then.method.name,
            Choice::Of(method) if method == self.method => then.method.name,
            Choice::Of(method) => return Err(format!("it was written by method {}, not {method}", self.method)),
        };
        now.method.device = then.method.device;
        now.method.memory_budget = then.method.memory_budget;
        let differs = [
            ("system", then.system != now.system),
            ("boundary", then.boundary != now.boundary),
            ("interaction", then.interaction != now.interaction),
            ("dynamics", then.dynamics != now.dynamics),
            ("method", then.method != now.method),
        ];
        match differs.iter().find(|(_, differs)| *differs) {
            Some((section, _)) => Err(format!("[{section}] of the configuration is not that of the checkpoint")),
            None if config.dynamics.steps < self.step => {
                Err(format!("it is of step {}, beyond the {} steps asked for", self.step, config.dynamics.steps))
            }
            None => Ok(()),
        }
    }
}
