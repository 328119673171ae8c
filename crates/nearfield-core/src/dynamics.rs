//! The equations of motion and their thermostats.

use crate::{
    Error, Result,
    philox::{PhiloxRng, Stream},
};
use rand_distr::{ChiSquared, Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

/// Which ensemble a run samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Ensemble {
    /// Constant energy: velocity Verlet.
    Nve,
    /// Langevin dynamics in the BAOAB splitting (Leimkuhler and Matthews, 2013).
    Langevin {
        /// Target temperature, \[energy\].
        temperature: f64,
        /// Friction rate, \[1/time\].
        friction: f64,
    },
    /// Stochastic velocity rescaling (Bussi, Donadio and Parrinello, 2007) after each velocity Verlet step.
    Rescale {
        /// Target temperature, \[energy\].
        temperature: f64,
        /// Relaxation time, \[time\].
        relaxation: f64,
    },
}

/// How particles move.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dynamics {
    /// Time step, \[time\].
    pub dt: f32,
    /// Ensemble.
    pub ensemble: Ensemble,
    /// Longest distance a particle may move in a step, \[length\]; 0 is no limit. With a limit, forces that overflow
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

/// The random numbers of [`rescale_factor`]: a standard normal one, and the sum of squares of as many as there are
/// other degrees of freedom.
pub fn rescale_draws(n: usize, seed: u64, step: u64) -> (f64, f64) {
    let n_dof = if n > 1 { 3.0 * n as f64 - 3.0 } else { 3.0 };
    let mut random = PhiloxRng::new(seed, Stream::Rescale, step);
    let normal = StandardNormal.sample(&mut random);
    let rest = ChiSquared::new(n_dof - 1.0).expect("at least two other degrees of freedom").sample(&mut random);
    (normal, rest)
}

/// The factor of velocity rescaling after a step (Bussi, Donadio and Parrinello, J. Chem. Phys. 126, 014101 (2007),
/// eq. A7): it takes the kinetic energy towards `temperature` over relaxation times, with the fluctuations of the
/// canonical ensemble. `ratio` = dt over the relaxation time. Momentum is conserved, so n particles have 3n - 3
/// degrees of freedom. A system at rest stays so.
pub fn rescale_factor(kinetic: f64, n: usize, temperature: f64, ratio: f64, seed: u64, step: u64) -> f64 {
    if kinetic <= 0.0 {
        return 1.0;
    }
    let (r1, rest) = rescale_draws(n, seed, step);
    let target = 0.5 * temperature / kinetic;
    let c = (-ratio).exp();
    let square = c + (1.0 - c) * target * (r1 * r1 + rest) + 2.0 * r1 * (c * (1.0 - c) * target).sqrt();
    square.max(0.0).sqrt()
}
