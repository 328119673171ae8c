//! `[dynamics]`: how particles move.

use super::{Error, Result};
use nearfield_core::{Dynamics, Ensemble, Error as CoreError};
use serde::{Deserialize, Serialize};

/// Names of the ensembles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EnsembleName {
    /// Constant energy.
    #[default]
    Nve,
    /// Langevin thermostat.
    Langevin,
    /// Stochastic velocity rescaling.
    Rescale,
}

/// `[dynamics]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DynamicsConfig {
    /// Number of steps.
    pub steps: u64,
    /// Time step, \[time\].
    pub dt: f64,
    /// Ensemble.
    pub ensemble: EnsembleName,
    /// Target temperature of the thermostats, \[energy\].
    pub temperature: f64,
    /// Friction rate of Langevin dynamics, \[1/time\].
    pub friction: f64,
    /// Relaxation time of velocity rescaling, \[time\].
    pub relaxation: f64,
    /// Longest distance a particle may move in a step, \[length\]; 0 is no limit.
    pub max_displacement: f64,
    /// Seed of the thermostats.
    pub seed: u64,
}

impl Default for DynamicsConfig {
    fn default() -> Self {
        Self {
            steps: 1000,
            dt: 0.005,
            ensemble: EnsembleName::Nve,
            temperature: 1.0,
            friction: 1.0,
            relaxation: 0.1,
            max_displacement: 0.0,
            seed: 1,
        }
    }
}

impl DynamicsConfig {
    pub(super) fn validate(&self) -> Result<()> {
        self.build().validate().map_err(|error| match error {
            // The file's own digits rather than their f32 rounding.
            CoreError::InvalidParameter { name: "dt", reason, .. } => Error::invalid("dynamics.dt", self.dt, reason),
            CoreError::InvalidParameter { name: "max_displacement", reason, .. } => {
                Error::invalid("dynamics.max_displacement", self.max_displacement, reason)
            }
            CoreError::InvalidParameter { name, value, reason } => {
                Error::invalid(format!("dynamics.{name}"), value, reason)
            }
            other => Error::invalid("dynamics", "", other.to_string()),
        })
    }

    pub(super) fn build(&self) -> Dynamics {
        let temperature = self.temperature;
        Dynamics {
            dt: self.dt as f32,
            ensemble: match self.ensemble {
                EnsembleName::Nve => Ensemble::Nve,
                EnsembleName::Langevin => Ensemble::Langevin { temperature, friction: self.friction },
                EnsembleName::Rescale => Ensemble::Rescale { temperature, relaxation: self.relaxation },
            },
            max_displacement: self.max_displacement as f32,
            seed: self.seed,
        }
    }
}
