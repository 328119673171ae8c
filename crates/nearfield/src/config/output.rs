//! `[output]`: what a run writes.

use super::{Error, Result};
use crate::io::Format;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// `[output]`. An interval of 0 steps turns an output off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OutputConfig {
    /// Folder for everything, relative to where the program runs.
    pub directory: PathBuf,
    /// Steps between rows of thermo.csv.
    pub thermo_every: u64,
    /// Steps between frames of the trajectory.
    pub trajectory_every: u64,
    /// File name of the trajectory; its extension tells the format.
    pub trajectory: PathBuf,
    /// Whether the trajectory holds velocities.
    pub velocities: bool,
    /// Steps between checkpoints.
    pub checkpoint_every: u64,
    /// Steps between samples of the radial distribution function.
    pub rdf_every: u64,
    /// Its bins up to the cutoff.
    pub rdf_bins: usize,
    /// Steps between samples of the mean squared displacement.
    pub msd_every: u64,
}

impl Default for OutputConfig {
    fn default() -> Self {
        Self {
            directory: "out".into(),
            thermo_every: 100,
            trajectory_every: 1000,
            trajectory: "trajectory.xyz".into(),
            velocities: true,
            checkpoint_every: 10_000,
            rdf_every: 0,
            rdf_bins: 200,
            msd_every: 0,
        }
    }
}

impl OutputConfig {
    pub(super) fn validate(&self) -> Result<()> {
        if self.rdf_bins == 0 {
            return Err(Error::invalid("output.rdf_bins", self.rdf_bins, "at least one bin is needed"));
        }
        for (key, path) in [("output.directory", &self.directory), ("output.trajectory", &self.trajectory)] {
            if path.as_os_str().is_empty() {
                return Err(Error::invalid(key, "\"\"", "must not be empty"));
            }
        }
        let is_name = self.trajectory.file_name() == Some(self.trajectory.as_os_str());
        if !is_name || !matches!(Format::of(&self.trajectory), Ok(Format::ExtendedXyz)) {
            let reason = "must be a file name ending in .xyz or .extxyz; output.directory is where it goes";
            return Err(Error::invalid("output.trajectory", format!("{:?}", self.trajectory), reason));
        }
        Ok(())
    }
}
