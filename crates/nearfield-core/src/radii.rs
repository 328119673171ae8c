//! The interaction range: one cutoff for all, or a search radius per particle.

use crate::{Error, Result, SimBox};
use serde::{Deserialize, Serialize};

/// Search radii, \[length\]. The range of a pair is `max(r_i, r_j)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Radii {
    /// One cutoff for every pair.
    Uniform(f32),
    /// A radius for each particle, `[N]`, as in paper A.
    PerParticle(Vec<f32>),
}

impl Radii {
    /// Radius of particle `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> f32 {
        match self {
            Self::Uniform(r) => *r,
            Self::PerParticle(radii) => radii[i],
        }
    }

    /// Range of the pair (i, j).
    #[inline(always)]
    pub fn range(&self, i: usize, j: usize) -> f32 {
        match self {
            Self::Uniform(r) => *r,
            Self::PerParticle(radii) => radii[i].max(radii[j]),
        }
    }

    /// The mean radius; zero without particles.
    pub fn mean(&self) -> f32 {
        match self {
            Self::Uniform(radius) => *radius,
            Self::PerParticle(radii) => {
                (radii.iter().map(|&r| f64::from(r)).sum::<f64>() / radii.len().max(1) as f64) as f32
            }
        }
    }

    /// The largest radius; zero when there are no particles with one.
    pub fn largest(&self) -> f32 {
        match self {
            Self::Uniform(r) => *r,
            Self::PerParticle(radii) => radii.iter().copied().fold(0.0, f32::max),
        }
    }

    /// Whether one cutoff serves all pairs.
    pub fn is_uniform(&self) -> bool {
        matches!(self, Self::Uniform(_))
    }

    /// Checks every radius: positive, finite, at most half a periodic length, as many as particles.
    ///
    /// # Errors
    /// [`Error::InvalidCutoff`], [`Error::InvalidRadius`], [`Error::LengthMismatch`], [`Error::CutoffTooLarge`].
    pub fn validate(&self, n_particles: usize, sim_box: &SimBox) -> Result<()> {
        match self {
            Self::Uniform(r) => {
                if !(r.is_finite() && *r > 0.0) {
                    return Err(Error::InvalidCutoff(*r));
                }
                sim_box.check_range(*r, None)
            }
            Self::PerParticle(radii) => {
                if radii.len() != n_particles {
                    return Err(Error::LengthMismatch { what: "radii", found: radii.len(), expected: n_particles });
                }
                for (particle, &value) in radii.iter().enumerate() {
                    if !(value.is_finite() && value > 0.0) {
                        return Err(Error::InvalidRadius { particle, value });
                    }
                    sim_box.check_range(value, Some(particle))?;
                }
                Ok(())
            }
        }
    }
}
