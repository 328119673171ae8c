//! `[system]` and `[boundary]`: what is simulated, and in which box.

use super::{Error, Result};
use crate::generate::{self, Generate};
use nearfield_core::Boundary;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// `[system]`: a file or a generator.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SystemConfig {
    /// Input file, relative to the configuration's folder.
    pub input: Option<PathBuf>,
    /// `[system.generate]`.
    pub generate: Option<Generate>,
}

/// Where particles come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source<'a> {
    /// A file, as written in the configuration.
    Input(&'a Path),
    /// The generator.
    Generate(&'a Generate),
}

impl SystemConfig {
    pub(super) fn validate(&self) -> Result<()> {
        if self.input.is_some() && self.generate.is_some() {
            return Err(Error::TwoSources);
        }
        self.generate.as_ref().map_or(Ok(()), Generate::validate).map_err(|error| match error {
            generate::Error::InvalidParameter { key, value, reason } => {
                Error::invalid(format!("system.generate.{key}"), value, reason)
            }
            other => other.into(),
        })
    }

    pub(super) fn source(&self) -> Result<Source<'_>> {
        match (&self.input, &self.generate) {
            (Some(_), Some(_)) => Err(Error::TwoSources),
            (Some(path), None) => Ok(Source::Input(path)),
            (None, Some(spec)) => Ok(Source::Generate(spec)),
            (None, None) => Err(Error::NoSource),
        }
    }
}

/// `[boundary]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BoundaryConfig {
    /// Faces across x.
    pub x: Boundary,
    /// Faces across y.
    pub y: Boundary,
    /// Faces across z.
    pub z: Boundary,
}

impl BoundaryConfig {
    /// The boundaries by axis.
    pub fn axes(self) -> [Boundary; 3] {
        [self.x, self.y, self.z]
    }
}
