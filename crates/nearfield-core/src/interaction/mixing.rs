//! Combination rules for unlike types.

use super::ParticleType;
use serde::{Deserialize, Serialize};

/// How epsilon and sigma of unlike types combine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mixing {
    /// Arithmetic mean of sigma, geometric mean of epsilon.
    #[default]
    LorentzBerthelot,
    /// Geometric means of both.
    Geometric,
}

impl Mixing {
    /// (epsilon, sigma) of the pair.
    pub fn mix(self, a: &ParticleType, b: &ParticleType) -> (f64, f64) {
        let geometric = |x: f32, y: f32| if x == y { f64::from(x) } else { (f64::from(x) * f64::from(y)).sqrt() };
        let sigma = match self {
            Self::LorentzBerthelot => 0.5 * (f64::from(a.sigma) + f64::from(b.sigma)),
            Self::Geometric => geometric(a.sigma, b.sigma),
        };
        (geometric(a.epsilon, b.epsilon), sigma)
    }
}
