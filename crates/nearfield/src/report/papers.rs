//! The papers' values, from `data/papers.toml`.

use nearfield_core::Method;
use serde::Deserialize;
use std::{collections::BTreeMap, sync::LazyLock};

const TEXT: &str = include_str!("../../data/papers.toml");

/// Values of the papers.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Papers {
    /// Paper A, table 2.
    pub table2: Table2,
    /// Sentences with numbers.
    pub claim: Vec<Claim>,
}

/// Milliseconds a step.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Table2 {
    pub source: String,
    /// By column: radii, boundary, n.
    pub columns: Vec<(String, String, usize)>,
    /// By positions and the paper's name of the method; not a number where the paper's method could not run.
    pub rows: BTreeMap<String, BTreeMap<String, Vec<f64>>>,
}

/// Something that a paper says about its measurements.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Claim {
    /// Suite that repeats it.
    pub suite: String,
    /// Paper, figure or section.
    pub source: String,
    pub text: String,
}

/// The values.
pub(super) fn papers() -> &'static Papers {
    static PAPERS: LazyLock<Papers> =
        LazyLock::new(|| toml::from_str(TEXT).expect("papers.toml is valid, as a test checks"));
    &PAPERS
}

/// The name in paper A of its CPU method.
pub(super) const CPU_CELL: &str = "CPU-CELL@64c";

/// The name in paper A of a method on a GPU.
pub(super) fn name_in_paper_a(method: Method) -> Option<&'static str> {
    match method {
        Method::Cell => Some("GPU-CELL"),
        Method::RtList => Some("RT-REF"),
        Method::RtForces => Some("ORCS-forces"),
        Method::RtPerse => Some("ORCS-persé"),
        _ => None,
    }
}

impl Table2 {
    /// Milliseconds a step of a case such as `lattice r=1 wall`.
    pub fn ms(&self, case: &str, n: usize, method: &str) -> Option<f64> {
        let mut words = case.split(' ');
        let (positions, radii, boundary) = (words.next()?, words.next()?, words.next()?);
        let column = self.columns.iter().position(|(r, b, size)| r == radii && b == boundary && *size == n)?;
        self.rows.get(positions)?.get(method)?.get(column).copied().filter(|ms| ms.is_finite())
    }

    /// The fastest method of a case and its milliseconds.
    pub fn best(&self, case: &str, n: usize) -> Option<(&str, f64)> {
        let methods = self.rows.values().next()?.keys();
        let all = methods.filter_map(|method| Some((method.as_str(), self.ms(case, n, method)?)));
        all.min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_2_is_complete_and_has_the_gaps_of_the_paper() {
        let table = &papers().table2;
        assert_eq!(table.columns.len(), 16);
        assert_eq!(table.rows.len(), 3);
        for methods in table.rows.values() {
            assert_eq!(methods.len(), 5);
            assert!(methods.values().all(|row| row.len() == 16));
        }
        assert_eq!(table.ms("lattice r=1 wall", 50_000, CPU_CELL), Some(1.80));
        assert_eq!(table.ms("cluster r=LN[1,330] periodic", 1_000_000, "ORCS-forces"), Some(5617.0));
        assert_eq!(table.ms("cluster r=160 wall", 1_000_000, "RT-REF"), None, "out of memory in the paper");
        assert_eq!(table.ms("lattice r=1 wall", 123, "RT-REF"), None);
        assert_eq!(table.best("lattice r=160 wall", 50_000), Some(("RT-REF", 17.6)));
    }

    #[test]
    fn claims_belong_to_suites() {
        for claim in &papers().claim {
            assert!(claim.suite.parse::<crate::bench::Suite>().is_ok(), "{}", claim.suite);
            assert!(claim.source.starts_with("paper "), "{}", claim.source);
        }
    }
}
