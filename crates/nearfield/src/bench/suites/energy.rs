//! Power, energy and interactions per joule: paper A, figures 11 and 12.
//!
//! The paper does not state n here. These are the largest n at which it found that its stored lists fit a GPU of 24 GB
//! (footnote 5): 220,000 and 75,000, and a million where there are hardly any neighbours.

use super::representative;
use crate::bench::{Case, Measure, Options};

pub(in crate::bench) fn cases(options: &Options) -> Vec<Case> {
    let n = match (options.n.first(), options.quick) {
        (Some(&n), _) => [n; 3],
        (None, true) => [4000, 200_000, 4000],
        (None, false) => [220_000, 1_000_000, 75_000],
    };
    let default = if options.quick { 0.6 } else { 10.0 };
    representative(n, Measure::Energy { seconds: options.seconds.unwrap_or(default) })
}
