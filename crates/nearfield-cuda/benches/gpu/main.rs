//! What the GPU engine costs, as JSON lines and a table.
//!
//! `cargo bench -p nearfield-cuda --bench gpu -- --suite methods --output results.jsonl`. Suites: `methods` (paper A's
//! table 2: positions x radii x boundaries x methods), `search` (counts and lists on the device), `melt` (whole steps of
//! the Lennard-Jones melt), `scaling` (10^4 to 10^8 particles at fixed density). Times are medians of repeated calls,
//! by the host's clock around calls that end with a wait for the device; they include everything a step does.

mod cases;
mod measure;

use clap::{Parser, ValueEnum};
use measure::{Bench, Outcome};
use nearfield_core::{Boundary, Engine, Images, Maintenance, Method, Plan, Skin};
use nearfield_cuda::CudaEngine;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Suite {
    Methods,
    Search,
    Melt,
    Scaling,
}

#[derive(Parser, Debug)]
struct Arguments {
    /// What to run.
    #[arg(long, value_enum, required_unless_present = "quick")]
    suite: Vec<Suite>,
    /// The smallest melt and list, a few seconds, as JSON lines.
    #[arg(long)]
    quick: bool,
    /// Numbers of particles; the suite's own by default.
    #[arg(long, value_delimiter = ',')]
    n: Vec<usize>,
    /// Only these methods.
    #[arg(long, value_delimiter = ',')]
    method: Vec<Method>,
    /// Only cases whose name contains this.
    #[arg(long, default_value = "")]
    filter: String,
    /// Skin of the methods that keep lists; the plan's default where it is not given.
    #[arg(long)]
    skin: Option<f32>,
    /// Seconds to spend on each measurement.
    #[arg(long, default_value_t = 0.4)]
    seconds: f64,
    /// Where one evaluation of the forces takes longer than this, in seconds, it is the measurement.
    #[arg(long, default_value_t = 30.0)]
    patience: f64,
    /// Seconds after which no further measurement begins.
    #[arg(long, default_value_t = f64::INFINITY)]
    stop_after: f64,
    /// File of results, one JSON object a line.
    #[arg(long)]
    output: Option<std::path::PathBuf>,
    /// Which GPU.
    #[arg(long, default_value_t = 0)]
    device: usize,
    /// Passed by cargo.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() {
    let mut arguments = Arguments::parse();
    if arguments.quick {
        arguments.suite = vec![Suite::Search, Suite::Melt];
        arguments.n = vec![32_000];
        arguments.seconds = 0.1;
    }
    let engine = match CudaEngine::new(arguments.device) {
        Ok(engine) => engine,
        Err(reason) => {
            eprintln!("no measurements: {reason}");
            return;
        }
    };
    if !arguments.quick {
        println!("{}", engine.device());
    }
    let mut bench = Bench::new(engine, &arguments);
    for suite in &arguments.suite {
        match suite {
            Suite::Methods => methods(&mut bench, &arguments),
            Suite::Search => search(&mut bench, &arguments),
            Suite::Melt => melt(&mut bench, &arguments),
            Suite::Scaling => scaling(&mut bench, &arguments),
        }
    }
}

fn sizes(arguments: &Arguments, default: &[usize]) -> Vec<usize> {
    if arguments.n.is_empty() { default.to_vec() } else { arguments.n.clone() }
}

/// The methods asked for, in the order of [`Method::ALL`].
fn asked(arguments: &Arguments, default: &[Method]) -> Vec<Method> {
    let wanted = if arguments.method.is_empty() { default } else { &arguments.method };
    Method::ALL.iter().copied().filter(|method| wanted.contains(method)).collect()
}

fn plan(method: Method, arguments: &Arguments) -> Plan {
    let plan = Plan::new(method);
    Plan { skin: arguments.skin.map_or(plan.skin, Skin::Fixed), ..plan }
}

/// Paper A's table 2.
fn methods(bench: &mut Bench, arguments: &Arguments) {
    for n in sizes(arguments, &[50_000, 1_000_000]) {
        for boundary in [Boundary::Wall, Boundary::Periodic] {
            for radii in cases::RADII {
                for positions in cases::POSITIONS {
                    let case = cases::orcs(n, positions, radii, boundary);
                    for method in asked(arguments, &Method::ALL[1..]) {
                        let plan = Plan { maintenance: Maintenance::Gradient, ..plan(method, arguments) };
                        bench.steps("methods", &case, &plan);
                    }
                }
            }
        }
    }
}

/// Counts and lists, built and left on the device.
fn search(bench: &mut Bench, arguments: &Arguments) {
    for n in sizes(arguments, &[100_000, 1_000_000]) {
        let uniform = [1.0, 8.0, 32.0, 100.0].map(|k| cases::uniform(n, k));
        for case in uniform.into_iter().chain([cases::sphere(n, 9.0), cases::sphere(n, 72.0), cases::cluster(n)]) {
            for method in asked(arguments, &[Method::Cell]) {
                bench.search("search", &case, &Plan::new(method));
            }
        }
    }
}

/// Whole steps of the Lennard-Jones melt.
fn melt(bench: &mut Bench, arguments: &Arguments) {
    for n in sizes(arguments, &[32_000, 256_000, 2_048_000]) {
        let case = cases::melt(n);
        for method in asked(arguments, &Method::ALL[1..]) {
            for deterministic in [false, true] {
                bench.steps("melt", &case, &Plan { deterministic, ..plan(method, arguments) });
            }
        }
    }
}

/// Steps and memory at fixed density.
fn scaling(bench: &mut Bench, arguments: &Arguments) {
    for n in sizes(arguments, &[10_000, 100_000, 1_000_000, 10_000_000, 100_000_000]) {
        let case = cases::gas(n);
        for method in asked(arguments, &[Method::Cell, Method::Cluster, Method::RtBoxes]) {
            let images: &[Images] = if method.uses_bvh() && n <= 1_000_000 { Images::ALL } else { &[Images::Gamma] };
            for &images in images {
                if bench.steps("scaling", &case, &Plan { images, ..plan(method, arguments) }) == Outcome::TooLong {
                    break;
                }
            }
        }
    }
}
