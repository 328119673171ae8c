//! `nearfield bench` and `nearfield plot`.

use clap::Args;
use nearfield::{Device, Method, bench::Suite};
use std::{path::PathBuf, str::FromStr};

pub const BENCH_HELP: &str = "\
Suites:
  policies     when to rebuild a BVH (paper A, figure 8)
  methods      every method on every input (paper A, table 2)
  speedup      speedup over cells on the CPU by size (paper A, figures 9 and 10)
  energy       power, energy, interactions per joule (paper A, figures 11 and 12)
  primitives   what rays hit, against a grid (paper B, figures 9 and 10)
  neighbors    every method by mean number of neighbours
  scaling      time and memory of a particle by system size
  md           the Lennard-Jones melt
  generations  performance and energy across GPUs (paper A, figure 13)
  all          all of these
  auto         constants of the cost model by which the method auto chooses, for this machine

Examples:
  nearfield bench all --quick -o out && nearfield plot out
  nearfield bench methods --device cuda -o out --stop-after 300

Results go to DIR/SUITE.jsonl, one JSON object a line. What is in the file already is not measured again, so an \
interrupted suite goes on where it stopped; what failed, or was too slow for a smaller --patience, is tried again. All \
methods must find the same number of pairs in the same input: the exit code is 1 if one does not.

Auto writes the profile of this machine instead: DIR/profile.toml, or without -o the file that NEARFIELD_PROFILE names or \
nearfield/profile.toml in your folder for configurations.";

pub const PLOT_HELP: &str = "\
Examples:
  nearfield plot out
  nearfield plot results -o report

Reads *.jsonl in DIR and in the folders below it, so that results of several machines or devices are drawn together, and \
writes report.html, which needs no network, and each figure as SVG and PNG.";

#[derive(Args)]
pub struct BenchArguments {
    /// What to measure: a suite, all, or auto.
    pub suite: SuiteChoice,
    /// Small sizes: each suite takes about a minute on two processor cores.
    #[arg(long)]
    pub quick: bool,
    /// Device: auto (the first usable GPU, else the CPU), cpu, cuda or cuda:N.
    #[arg(long, default_value = "auto")]
    pub device: Device,
    /// Directory of the results.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Measure again what the files hold already.
    #[arg(long)]
    pub fresh: bool,
    /// Numbers of particles, instead of the suite's own.
    #[arg(short = 'n', long = "particles", value_name = "N", value_delimiter = ',')]
    pub n: Vec<usize>,
    /// Only these methods.
    #[arg(long, value_delimiter = ',')]
    pub method: Vec<Method>,
    /// Only cases whose name contains this, as in "lattice r=1".
    #[arg(long, value_name = "TEXT", default_value = "")]
    pub filter: String,
    /// One run of so many steps from the start for each measurement of whole steps, instead of a few steps repeated.
    #[arg(long)]
    pub steps: Option<u64>,
    /// Seconds to spend on each measurement.
    #[arg(long)]
    pub seconds: Option<f64>,
    /// Leave out what is predicted to take longer than so many seconds for one evaluation.
    #[arg(long, value_name = "SECONDS")]
    pub patience: Option<f64>,
    /// Begin no measurement of a suite after so many seconds; the same command goes on later.
    #[arg(long, value_name = "SECONDS")]
    pub stop_after: Option<f64>,
}

#[derive(Args)]
pub struct PlotArguments {
    /// Directory of results of `nearfield bench`.
    pub input: PathBuf,
    /// Directory of the report; the input directory by default.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// A suite, all of them, or the constants of the cost model.
#[derive(Clone, Copy)]
pub enum SuiteChoice {
    All,
    Auto,
    One(Suite),
}

impl FromStr for SuiteChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "all" => Ok(Self::All),
            "auto" => Ok(Self::Auto),
            _ => text.parse().map(Self::One).map_err(|error| format!("{error}, all, auto")),
        }
    }
}
