//! A suite's part of the report.

use super::{chart::Figure, table::Table};
use crate::bench::Suite;

/// What is shown of a suite.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Section {
    pub suite: Suite,
    pub title: &'static str,
    /// Paragraphs: what is shown and how to read it.
    pub text: Vec<String>,
    pub figures: Vec<Figure>,
    pub tables: Vec<Table>,
}
