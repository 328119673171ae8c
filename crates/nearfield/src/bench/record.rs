//! A line of a file of results.

use super::{Machine, Start, Suite};
use nearfield_core::Plan;
use serde::{Deserialize, Serialize};

/// What was measured, on what, and what came out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The suite.
    pub suite: Suite,
    /// The case.
    pub case: String,
    /// The family of the case.
    pub family: String,
    /// Number of particles.
    pub n: usize,
    /// Whether it belongs to a quick run.
    pub quick: bool,
    /// Name of the device for `--device`.
    pub device: String,
    /// What the device is.
    pub device_name: String,
    /// How it was computed.
    pub plan: Plan,
    /// What came out.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// The input.
    pub input: Start,
    /// The machine and what ran on it.
    pub machine: Machine,
}

/// What became of a measurement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "outcome", rename_all = "kebab-case")]
pub enum Outcome {
    /// It was made.
    Measured(Box<Measurement>),
    /// The method cannot compute this on this device.
    Unsupported {
        /// Why not.
        reason: String,
    },
    /// Memory did not suffice.
    OutOfMemory {
        /// For what.
        reason: String,
    },
    /// It was not made, because it would take longer than was allowed.
    TooSlow {
        /// Predicted time of one evaluation, by smaller cases of the family, or of the whole run of steps, \[s\].
        predicted_seconds: f64,
        /// The patience it was too slow for, \[s\]; with more, it is tried again.
        patience: f64,
    },
    /// Another method found another number of pairs in the same input: one of them is wrong.
    Mismatch {
        /// Pairs within range that this method found.
        pairs: u64,
        /// Those that the first method of the case found.
        expected: u64,
    },
    /// An error.
    Failed {
        /// Which.
        reason: String,
    },
}

/// Numbers of one measurement.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// Pairs within range at the start, each once.
    pub pairs: u64,
    /// Neighbours of a particle at the start, on average.
    pub neighbors: f64,
    /// Seconds of one force evaluation at the start.
    pub evaluation_seconds: f64,
    /// Seconds of a step, or of an evaluation where `steps` is 0.
    pub time: Spread,
    /// Steps of a repetition; 0 for force evaluations at the start.
    pub steps: u64,
    /// Seconds of an evaluation to build or refit the structure, on average; 0 where the device's clock was not asked. Of
    /// evaluations that build everything anew: the median of all that is no query, sorting of particles and waiting for
    /// the device included.
    pub structure_seconds: f64,
    /// Seconds of an evaluation to find and use the pairs, on average; of evaluations built anew the median.
    pub query_seconds: f64,
    /// Structures built, over all repetitions.
    pub builds: u64,
    /// Structures refitted.
    pub refits: u64,
    /// Lists built.
    pub list_builds: u64,
    /// Evaluations whose list did not fit the memory budget.
    pub batched_evaluations: u64,
    /// Bytes that the engine holds for a particle.
    pub bytes_per_particle: f64,
    /// Bytes of these that the structure takes, with what its method stores beside it.
    pub structure_bytes_per_particle: f64,
    /// What each step cost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub series: Option<Series>,
    /// Electrical energy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<Energy>,
}

/// Repeated measurements of a time, \[s\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The one in the middle.
    pub median: f64,
    /// The shortest.
    pub least: f64,
    /// The longest.
    pub most: f64,
    /// How many there were.
    pub repetitions: usize,
}

impl Spread {
    /// Of at least one time.
    pub(super) fn of(mut times: Vec<f64>) -> Self {
        times.sort_by(f64::total_cmp);
        let at = |k: usize| times.get(k).copied().unwrap_or_default();
        let repetitions = times.len();
        Self { median: at(repetitions / 2), least: at(0), most: at(repetitions.saturating_sub(1)), repetitions }
    }
}

/// What each step cost.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Microseconds to build or refit, by step.
    pub structure: Vec<f64>,
    /// Microseconds to find and use the pairs, by step.
    pub query: Vec<f64>,
    /// Steps at which the structure was built anew.
    pub builds: Vec<usize>,
    /// Step and pairs per particle, now and then.
    pub interactions: Vec<(u64, f64)>,
}

/// Electrical energy of a run of steps.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// What was read.
    pub meter: Option<String>,
    /// Why nothing could be read, where nothing could.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_meter: Option<String>,
    /// Seconds of the run.
    pub seconds: f64,
    /// Steps of the run.
    pub steps: u64,
    /// Pairs that were computed, each once a step.
    pub interactions: f64,
    /// Energy that was used, \[J\], other programs included; 0 without a meter.
    pub joules: f64,
    /// Seconds since the start and mean power since the entry before, \[W\].
    pub power: Vec<(f64, f64)>,
}
