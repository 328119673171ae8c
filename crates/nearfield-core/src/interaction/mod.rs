//! Potential, truncation, types and mixing: everything that turns a pair's distance into force and energy.

mod coefficients;
mod law;
mod mixing;
mod tail;

pub use coefficients::{Coefficients, PairCoefficients, RadiusScaled, ScaledCut, Single, Typed};
pub use law::{PairLaw, Truncated};
pub use mixing::Mixing;
pub use tail::TailCorrection;

use crate::{Error, Result, potentials::Potential};
use serde::{Deserialize, Serialize};

/// What is done to the potential at the cutoff.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Truncation {
    /// Cut: energy and force jump at the cutoff.
    #[default]
    Cut,
    /// Energy shifted to be zero at the cutoff; the force still jumps.
    Energy,
    /// Force and energy shifted to be zero at the cutoff.
    Force,
}

/// One particle type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ParticleType {
    /// Matches type ids of LAMMPS data files and the species column of extended XYZ.
    pub name: String,
    /// Energy scale, \[energy\].
    pub epsilon: f32,
    /// Length scale, \[length\].
    pub sigma: f32,
    /// Mass, \[mass\].
    pub mass: f32,
}

impl Default for ParticleType {
    fn default() -> Self {
        Self { name: "1".into(), epsilon: 1.0, sigma: 1.0, mass: 1.0 }
    }
}

/// Sigma of a pair is its range divided by this, where particles have radii (paper A).
pub const RADIUS_PER_SIGMA: f32 = 2.5;

/// The pair interaction of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Interaction {
    /// The potential.
    pub potential: Potential,
    /// Its truncation.
    pub truncation: Truncation,
    /// How unlike types mix.
    pub mixing: Mixing,
    /// Types, indexed by `Particles::kind`.
    pub types: Vec<ParticleType>,
    /// Sigma of a pair is its range over this where radii are per particle; types' sigma is then unused.
    pub radius_per_sigma: f32,
}

impl Interaction {
    /// Plain Lennard-Jones in reduced units, one type.
    pub fn lennard_jones() -> Self {
        Self {
            potential: Potential::LennardJones(crate::potentials::LennardJones),
            truncation: Truncation::Cut,
            mixing: Mixing::LorentzBerthelot,
            types: vec![ParticleType::default()],
            radius_per_sigma: RADIUS_PER_SIGMA,
        }
    }

    /// Checks types and parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`].
    pub fn validate(&self) -> Result<()> {
        let check = |ok: bool, name, value: f32, reason| {
            if ok { Ok(()) } else { Err(Error::InvalidParameter { name, value: value.to_string(), reason }) }
        };
        if self.types.is_empty() {
            return Err(Error::InvalidParameter {
                name: "interaction.type",
                value: "[]".into(),
                reason: "at least one type is needed",
            });
        }
        let positive = |x: f32| x.is_finite() && x > 0.0;
        check(positive(self.radius_per_sigma), "radius_per_sigma", self.radius_per_sigma, "must be positive")?;
        for kind in &self.types {
            check(kind.epsilon.is_finite() && kind.epsilon >= 0.0, "epsilon", kind.epsilon, "must not be negative")?;
            check(positive(kind.sigma), "sigma", kind.sigma, "must be positive")?;
            check(positive(kind.mass), "mass", kind.mass, "must be positive")?;
        }
        Ok(())
    }
}
