//! Which variant suits a system.

use crate::grid::Survey;

/// Expected neighbours within range and skin from which pairs are found anew each time: a list of them would be read
/// from memory as slowly, and is large.
const DENSE: f64 = 300.0;

/// Expected neighbours below which most clusters have none, so that moving the particles is the work.
const SPARSE: f64 = 1.0;

/// Most particles whose numbers entries of lists can hold, beside a bit.
const MOST_LISTED: usize = (1 << 31) - 1;

/// How pairs are found and used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// In cells at each evaluation, each once; from the particle of smaller radius where radii differ. Directed, where
    /// sums must not depend on order.
    Pairs,
    /// From lists of what is near each cluster, kept while the skin lasts.
    List,
    /// The same where most lists are empty.
    SparseList,
}

impl Variant {
    /// By a survey whose ranges are longer by the skin.
    pub(super) fn choose(survey: &Survey, skin: f32) -> Self {
        let Some(range) = survey.cutoff else { return Self::Pairs };
        let neighbors = survey.neighbors(range);
        if neighbors > DENSE || survey.n > MOST_LISTED {
            Self::Pairs
        } else if neighbors >= SPARSE {
            Self::List
        } else if skin > 0.0 {
            Self::SparseList
        } else {
            Self::Pairs
        }
    }

    /// Whether lists are kept.
    pub fn uses_list(self) -> bool {
        self != Self::Pairs
    }
}

impl std::fmt::Display for Variant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Pairs => "pairs",
            Self::List => "list",
            Self::SparseList => "sparse list",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearfield_core::{Boundary, SimBox};
    use nearfield_kernels::Float4;
    use rand::{RngExt, SeedableRng};

    fn choose(n: usize, cutoff: Option<f32>, skin: f32) -> Variant {
        let sim_box = SimBox::new([0.0; 3], [100.0; 3], [Boundary::Periodic; 3]).expect("a box");
        let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        let mut place = || rng.random_range(0.0..100.0f32);
        let sample: Vec<Float4> = (0..4096).map(|_| Float4::new(place(), place(), place(), 1.0)).collect();
        let largest = cutoff.unwrap_or(1.0);
        Variant::choose(&Survey { n, sample: &sample, sim_box: &sim_box, cutoff, largest }, skin)
    }

    #[test]
    fn density_skin_and_radii_decide() {
        assert_eq!(choose(1_000_000, Some(2.8), 0.3), Variant::List);
        assert_eq!(choose(1_000_000, Some(2.5), 0.0), Variant::List);
        assert_eq!(choose(1_000_000, Some(10.0), 0.3), Variant::Pairs);
        assert_eq!(choose(10_000, Some(1.3), 0.3), Variant::SparseList);
        assert_eq!(choose(10_000, Some(1.0), 0.0), Variant::Pairs);
        assert_eq!(choose(1_000_000, None, 0.3), Variant::Pairs);
    }
}
