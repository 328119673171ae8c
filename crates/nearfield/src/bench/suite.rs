//! The suites by name.

use super::{Case, Options, suites};
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// A set of experiments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Suite {
    /// When to rebuild a BVH: paper A, figure 8.
    Policies,
    /// Every method on every input: paper A, table 2.
    Methods,
    /// Speedup over cells on the CPU by size: paper A, figures 9 and 10.
    Speedup,
    /// Power and energy: paper A, figures 11 and 12.
    Energy,
    /// Primitives for rays to hit: paper B, figures 9 and 10.
    Primitives,
    /// Every method by mean number of neighbours.
    Neighbors,
    /// Time and memory of a particle by system size.
    Scaling,
    /// The Lennard-Jones melt.
    Md,
    /// Performance and energy across GPUs: paper A, figure 13.
    Generations,
}

impl Suite {
    /// Every suite, in the order of the papers.
    pub const ALL: [Self; 9] = [
        Self::Policies,
        Self::Methods,
        Self::Speedup,
        Self::Energy,
        Self::Primitives,
        Self::Neighbors,
        Self::Scaling,
        Self::Md,
        Self::Generations,
    ];

    /// The name on the command line and of the file of results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Policies => "policies",
            Self::Methods => "methods",
            Self::Speedup => "speedup",
            Self::Energy => "energy",
            Self::Primitives => "primitives",
            Self::Neighbors => "neighbors",
            Self::Scaling => "scaling",
            Self::Md => "md",
            Self::Generations => "generations",
        }
    }

    /// What it reproduces.
    pub fn source(self) -> &'static str {
        match self {
            Self::Policies => "paper A, figure 8",
            Self::Methods => "paper A, table 2",
            Self::Speedup => "paper A, figures 9 and 10",
            Self::Energy => "paper A, figures 11 and 12",
            Self::Primitives => "paper B, figures 9 and 10",
            Self::Neighbors | Self::Scaling | Self::Md => "not in the papers",
            Self::Generations => "paper A, figure 13",
        }
    }

    /// Its experiments, small ones of a family first.
    pub fn cases(self, options: &Options) -> Vec<Case> {
        match self {
            Self::Policies => suites::policies::cases(options),
            Self::Methods => suites::methods::cases(options),
            Self::Speedup => suites::speedup::cases(options),
            Self::Energy => suites::energy::cases(options),
            Self::Primitives => suites::primitives::cases(options),
            Self::Neighbors => suites::neighbors::cases(options),
            Self::Scaling => suites::scaling::cases(options),
            Self::Md => suites::md::cases(options),
            Self::Generations => suites::generations::cases(options),
        }
    }
}

impl fmt::Display for Suite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Suite {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|suite| suite.name() == text).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            format!("unknown suite \"{text}\"; there are {names}")
        })
    }
}
