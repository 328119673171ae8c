//! The equations of motion and their thermostats.

use crate::{Error, Result};
use serde::{Deserialize, Serialize};

/// Which ensemble a run samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Ensemble {
    /// Constant energy: velocity Verlet.
    Nve,
    /// Langevin dynamics in the BAOAB splitting (Leimkuhler and Matthews, 2013).
    Langevin {
        /// Target temperature, [energy].
        temperature: f64,
        /// Friction rate, [1/time].
        friction: f64,
    },
    /// Stochastic velocity rescaling (Bussi, Donadio and Parrinello, 2007) after each velocity Verlet step.
    Rescale {
        /// Target temperature, [energy].
        temperature: f64,
        /// Relaxation time, [time].
        relaxation: f64,
    },
}

/// How particles move.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dynamics {
    /// Time step, [time].
    pub dt: f32,
    /// Ensemble.
    pub ensemble: Ensemble,
    /// Longest distance a particle may move in a step, [length]; 0 is no limit. With a limit, forces that overflow
    /// are capped, so that starts with overlapping or coincident particles can run.
    pub max_displacement: f32,
    /// Seed of the thermostats' random numbers.
    pub seed: u64,
}

impl Dynamics {
    /// Velocity Verlet at constant energy.
    pub fn nve(dt: f32) -> Self {
        Self { dt, ensemble: Ensemble::Nve, max_displacement: 0.0, seed: 0 }
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`].
    pub fn validate(&self) -> Result<()> {
        let check = |ok: bool, name, value: f64, reason| {
            if ok { Ok(()) } else { Err(Error::InvalidParameter { name, value: value.to_string(), reason }) }
        };
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let not_negative = |x: f64| x.is_finite() && x >= 0.0;
        check(positive(f64::from(self.dt)), "dt", f64::from(self.dt), "must be positive and finite")?;
        let limit = f64::from(self.max_displacement);
        check(not_negative(limit), "max_displacement", limit, "must be zero (off) or positive")?;
        match self.ensemble {
            Ensemble::Nve => Ok(()),
            Ensemble::Langevin { temperature, friction } => {
                check(not_negative(temperature), "temperature", temperature, "must not be negative")?;
                check(positive(friction), "friction", friction, "must be positive")
            }
            Ensemble::Rescale { temperature, relaxation } => {
                check(positive(temperature), "temperature", temperature, "must be positive")?;
                check(positive(relaxation), "relaxation", relaxation, "must be positive")
            }
        }
    }
}
