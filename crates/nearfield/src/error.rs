//! What can go wrong, and whose fault it is.

use crate::{config, generate, io::IoError, render};
use std::path::PathBuf;

/// Shorthand for results of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Any error of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The system, the plan or the physics.
    #[error(transparent)]
    Core(#[from] nearfield_core::Error),
    /// A file.
    #[error(transparent)]
    Io(#[from] IoError),
    /// The configuration.
    #[error(transparent)]
    Config(#[from] config::Error),
    /// A generator.
    #[error(transparent)]
    Generate(#[from] generate::Error),
    /// A picture.
    #[error(transparent)]
    Render(#[from] render::Error),
    /// A file of constants of the cost model.
    #[error("{}: {reason}; `nearfield bench auto` writes it anew, and without it Nearfield's own serve", path.display())]
    Profile {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The device cannot be used here.
    #[error("device {device} is not available: {reason}")]
    DeviceUnavailable {
        /// The device asked for.
        device: String,
        /// What was looked for.
        reason: String,
    },
    /// A rebuild policy that needs a meter of electrical energy.
    #[error(
        "maintenance gradient:joules needs a meter of electrical energy, and {device} has none: {reason}; \
             gradient optimises time"
    )]
    NoMeter {
        /// The device.
        device: String,
        /// What was looked for.
        reason: String,
    },
    /// An input file without a box where one is needed.
    #[error("{file}: the file gives no box, which {why}; only open boundaries do without")]
    NoBox {
        /// The file, or `standard input`.
        file: String,
        /// What needs it.
        why: &'static str,
    },
    /// The particles of an input file do not fit the box or the interaction.
    #[error("{file}: {source}")]
    Input {
        /// The file, or `standard input`.
        file: String,
        /// What is wrong.
        source: nearfield_core::Error,
    },
    /// The output directory holds what would be overwritten: files that are not an earlier run's, or an earlier run
    /// that cannot be renamed because the user is in its directory.
    #[error("{} holds {what}, which would be overwritten; name another output directory", directory.display())]
    Occupied {
        /// The output directory.
        directory: PathBuf,
        /// What would be lost.
        what: String,
    },
    /// `--resume` without a usable checkpoint.
    #[error("cannot resume from {}: {reason}", path.display())]
    Resume {
        /// The checkpoint.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
    /// A line of a file of results is no record of this version.
    #[error("{}:{line}: no benchmark record of this version: {reason}; remove the line or the file", path.display())]
    Results {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// There is nothing to plot.
    #[error("{}: no results (*.jsonl) of nearfield bench here or in the folders below", directory.display())]
    NoResults {
        /// The directory.
        directory: PathBuf,
    },
    /// A figure could not be drawn.
    #[error("cannot draw {figure}: {reason}")]
    Figure {
        /// The figure.
        figure: String,
        /// What went wrong.
        reason: String,
    },
    /// The run was asked to stop.
    #[error("interrupted at step {step}; continue with --resume")]
    Interrupted {
        /// Last finished step, saved in the checkpoint.
        step: u64,
    },
    /// The run failed; what it had written is kept.
    #[error("{source}; {}", match checkpoint {
        Some(step) => format!("the last good checkpoint is of step {step}"),
        None => "no checkpoint had been written yet (output.checkpoint_every)".into(),
    })]
    Failed {
        /// Why.
        source: Box<Error>,
        /// Step of the last checkpoint on disk.
        checkpoint: Option<u64>,
    },
}

impl Error {
    /// Whether the request was wrong, rather than its execution: exit code 2 instead of 1.
    pub fn is_request(&self) -> bool {
        use nearfield_core::Error::{Device, NonFinite};
        match self {
            Self::Interrupted { .. } | Self::Failed { .. } | Self::Figure { .. } => false,
            // At step 0 nothing has run: the particles given overlap.
            Self::Core(NonFinite { step, .. }) => *step == 0,
            Self::Core(Device(_)) => false,
            Self::Io(IoError::Read { .. }) => false,
            _ => true,
        }
    }
}
