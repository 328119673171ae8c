//! The papers' experiments, measured on this machine: what `nearfield bench` does, for programs.
//!
//! A [`Suite`] is a list of cases: a [`Start`], plans for it, and what is measured. Each (case, plan, device) becomes one
//! [`Record`], a line of `SUITE.jsonl`. All methods of a case get the same input and must find the same pairs. A suite
//! that was interrupted goes on where it stopped, because what is in the file is not measured again.
//!
//! ```
//! use nearfield::{Device, bench::{self, Options, Suite}};
//! let folder = tempfile::tempdir()?;
//! let options = Options { quick: true, device: Device::Cpu, n: vec![108], seconds: Some(1e-3), ..Options::default() };
//! let summary = bench::run(Suite::Md, folder.path(), &options, &mut |_| {})?;
//! assert!(summary.measured > 0 && summary.wrong == 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod case;
mod file;
mod machine;
mod measure;
mod options;
mod predict;
mod record;
mod runner;
mod start;
mod suite;
mod suites;

pub use case::{Case, Measure};
pub use file::{read_records, results_file};
pub use machine::Machine;
pub use options::Options;
pub use record::{Energy, Measurement, Outcome, Record, Series, Spread};
pub use runner::{Progress, Summary, run};
pub use start::Start;
pub use suite::Suite;
pub(crate) use suites::paper_a_names;
