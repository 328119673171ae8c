//! When to rebuild a BVH instead of refitting it: one file per policy, behind one trait.
//!
//! A refit is cheap but lets boxes grow and overlap as particles move, so queries slow down; a rebuild restores them.
//! Engines ask the policy before each evaluation and tell it afterwards what the step cost.

mod average;
mod build_power;
mod displacement;
mod every;
mod fixed;
mod gradient;
mod gradient_joules;
mod robust;

pub use average::Average;
pub use build_power::EnergyCounter;
pub use displacement::Displacement;
pub use every::Every;
pub use fixed::Fixed;
pub use gradient::{Gradient, optimal_updates, optimal_updates_exact};
pub use gradient_joules::GradientJoules;

use crate::engine::StepCost;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::{fmt, str::FromStr};

/// What to do with the structure at the next evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Build it anew.
    Build,
    /// Keep its topology and update its boxes.
    Refit,
}

/// How far particles have moved since the last build.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Motion {
    /// Mean displacement over the search radius; zero unless [`Policy::needs_motion`].
    pub mean: f32,
}

/// A rebuild policy.
pub trait Policy: Send {
    /// Whether [`Motion`] must be measured before each decision.
    fn needs_motion(&self) -> bool {
        false
    }

    /// Whether decisions depend on what steps cost. Where they do not, an engine need not wait for its clock and may
    /// report costs of zero.
    fn needs_cost(&self) -> bool {
        true
    }

    /// Decides for the next evaluation. The first one always builds without asking.
    fn decide(&mut self, motion: Motion) -> Action;

    /// Reports what the evaluation cost, the forced and first builds included.
    fn record(&mut self, cost: StepCost);

    /// Gives a policy that looks at energy something to read it from; the others have no use for it.
    fn attach(&mut self, counter: Box<dyn EnergyCounter>) {
        drop(counter);
    }
}

/// The choice of a policy, as configured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Maintenance {
    /// Rebuild at each step.
    Every,
    /// Rebuild each `K` steps (paper A's fixed-200 is `Fixed(200)`).
    Fixed(u32),
    /// Rebuild when the mean cost of a step since the last rebuild exceeds that of a rebuilt step (paper A's avg).
    Average,
    /// Paper A's optimiser.
    Gradient,
    /// Paper A's optimiser, of energy instead of time.
    GradientJoules,
    /// Rebuild when particles have moved far (tutorial C).
    Displacement,
}

impl Maintenance {
    /// A fresh policy.
    pub fn policy(self) -> Box<dyn Policy> {
        match self {
            Self::Every => Box::new(Every),
            Self::Fixed(steps) => Box::new(Fixed::new(steps)),
            Self::Average => Box::new(Average::default()),
            Self::Gradient => Box::new(Gradient::default()),
            Self::GradientJoules => Box::new(GradientJoules::default()),
            Self::Displacement => Box::new(Displacement::default()),
        }
    }
}

impl fmt::Display for Maintenance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Every => f.pad("every"),
            Self::Fixed(steps) => f.pad(&format!("fixed:{steps}")),
            Self::Average => f.pad("average"),
            Self::Gradient => f.pad("gradient"),
            Self::GradientJoules => f.pad("gradient:joules"),
            Self::Displacement => f.pad("displacement"),
        }
    }
}

impl FromStr for Maintenance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "every" => Ok(Self::Every),
            "average" => Ok(Self::Average),
            "gradient" => Ok(Self::Gradient),
            "gradient:joules" => Ok(Self::GradientJoules),
            "displacement" => Ok(Self::Displacement),
            _ => match text.strip_prefix("fixed:").map(str::parse) {
                Some(Ok(steps)) if steps > 0 => Ok(Self::Fixed(steps)),
                Some(_) => Err(format!("\"{text}\": fixed:K takes a whole number K of steps, at least 1")),
                None => Err(format!(
                    "unknown maintenance \"{text}\"; there are every, fixed:K, average, gradient, gradient:joules, \
                     displacement"
                )),
            },
        }
    }
}

impl Serialize for Maintenance {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Maintenance {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}
