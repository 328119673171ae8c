//! Performance and energy efficiency across GPUs: paper A, figure 13.
//!
//! A machine has one or two of the devices to be compared: put the `generations.jsonl` of several machines into folders
//! below one directory, and the report merges them.

use super::representative;
use crate::bench::{Case, Measure, Options};

pub(in crate::bench) fn cases(options: &Options) -> Vec<Case> {
    let n = match (options.n.first(), options.quick) {
        (Some(&n), _) => [n; 3],
        (None, true) => [2000, 200_000, 2000],
        // In a dense cluster of a million, an evaluation without RT cores may take minutes.
        (None, false) => [1_000_000, 1_000_000, 75_000],
    };
    let default = if options.quick { 0.4 } else { 5.0 };
    representative(n, Measure::Energy { seconds: options.seconds.unwrap_or(default) })
}
