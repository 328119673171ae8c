//! Which variant suits a system.

use crate::grid::SPARSE;

/// Expected neighbours within range and skin from which pairs are found anew each time: a list of them would be read
/// from memory as slowly, and is large.
const DENSE: f64 = 300.0;

/// Most particles whose numbers entries of lists can hold, beside two bits.
const MOST_LISTED: usize = 1 << 30;

/// How pairs are found and used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// In cells at each evaluation, each once; from the particle of smaller radius where radii differ. Directed, where
    /// sums must not depend on order.
    Pairs,
    /// From lists of what is near each cluster, kept while the skin lasts.
    List,
    /// The same where most lists are empty, so that moving the particles is the work.
    SparseList,
}

impl Variant {
    /// For `n` particles that are expected to have so many `neighbors` within range and skin, where one cutoff serves all
    /// pairs.
    pub(super) fn choose(n: usize, neighbors: Option<f64>, skin: f32) -> Self {
        let Some(neighbors) = neighbors else { return Self::Pairs };
        if neighbors > DENSE || n > MOST_LISTED {
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

    #[test]
    fn density_skin_and_radii_decide() {
        let choose = |neighbors, skin| Variant::choose(1000, Some(neighbors), skin);
        assert_eq!([choose(80.0, 0.3), choose(80.0, 0.0)], [Variant::List; 2]);
        assert_eq!([choose(0.1, 0.3), choose(0.1, 0.0)], [Variant::SparseList, Variant::Pairs]);
        assert_eq!(choose(1e4, 0.3), Variant::Pairs);
        assert_eq!(Variant::choose(1000, None, 0.3), Variant::Pairs);
        assert_eq!(Variant::choose(u32::MAX as usize, Some(80.0), 0.3), Variant::Pairs);
    }
}
