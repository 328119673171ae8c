//! What can be typed.

pub mod bench;
pub mod render;

use clap::{Args, Parser, Subcommand, ValueEnum};
use nearfield::{
    Boundary, Images, Method, Order, Truncation,
    config::{Choice, Device},
    generate::{Positions, RadiiSpec},
};
use std::path::PathBuf;

/// Find every pair of particles within a cutoff, and run short-range particle simulations.
#[derive(Parser)]
#[command(version, propagate_version = true, max_term_width = 100)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// Run a simulation from a configuration file.
    #[command(after_help = RUN_HELP)]
    Run(Run),
    /// Evaluate forces, energy and virial of one configuration.
    #[command(after_help = FORCES_HELP)]
    Forces(Forces),
    /// List every pair within a cutoff.
    #[command(after_help = NEIGHBORS_HELP)]
    Neighbors(NeighborsArguments),
    /// Write initial conditions to a file.
    #[command(after_help = GENERATE_HELP)]
    Generate(GenerateArguments),
    /// Draw a picture of a configuration, of its neighbourhoods or of a trajectory.
    #[command(after_help = render::HELP)]
    Render(render::RenderArguments),
    /// Measure the papers' experiments on this machine.
    #[command(after_help = bench::BENCH_HELP)]
    Bench(bench::BenchArguments),
    /// Draw results of `bench` beside the papers' and write an HTML report.
    #[command(after_help = bench::PLOT_HELP)]
    Plot(bench::PlotArguments),
    /// Say what is usable on this machine, and why the rest is not.
    Devices(Listing),
    /// List every method, what it does and what it supports.
    Methods(Listing),
}

const RUN_HELP: &str = "\
Examples:
  nearfield run examples/melt.toml
  nearfield run examples/melt.toml --set system.generate.n=256000 --steps 500
  nearfield run examples/melt.toml --method rt-forces --output out/rt
  nearfield run examples/melt.toml --steps 5000 --resume
  nearfield run --print-config > run.toml

The output directory gets thermo.csv (energies, temperature, pressure), the trajectory (extended XYZ), run.json (what \
ran, how fast, and how it ended) and checkpoint.nearfield. One that holds an earlier run is renamed, not overwritten. \
Ctrl-C finishes the step, writes a checkpoint and stops. The number of threads is that of the machine, or \
RAYON_NUM_THREADS.";

const FORCES_HELP: &str = "\
Examples:
  nearfield forces melt.data --json
  nearfield forces start.xyz --cutoff 3 --truncation force --boundary ppw --output forces.csv

Lennard-Jones unless a configuration file says otherwise. Boundaries are a letter an axis: p periodic, w wall, o open; \
without them the input file's own (or all periodic where it has a box, all open where not).";

const NEIGHBORS_HELP: &str = "\
Examples:
  nearfield neighbors points.xyz --cutoff 1.2 --json
  nearfield neighbors points.xyz --cutoff 1.2 --half --output pairs.npz";

const GENERATE_HELP: &str = "\
Examples:
  nearfield generate fcc -n 32000 --density 0.8442 --temperature 1.44 -o melt.data
  nearfield generate cluster -n 50000 --box 1000,1000,1000 --radii lognormal:1,2,1,330 --seed 7 -o cluster.xyz
  nearfield generate sphere-surface -n 262144 --box 2,2,2 -o sphere.xyz";

#[derive(Args)]
pub struct Run {
    /// Configuration file (TOML).
    #[arg(required_unless_present = "print_config")]
    pub config: Option<PathBuf>,
    /// Change a key of the configuration, as in dynamics.dt=0.002; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Device: auto (the first usable GPU, else the CPU), cpu, cuda or cuda:N.
    #[arg(long)]
    pub device: Option<Device>,
    /// Method: auto, or one that `nearfield methods` lists.
    #[arg(long)]
    pub method: Option<Choice<Method>>,
    /// Number of steps.
    #[arg(long)]
    pub steps: Option<u64>,
    /// Output directory.
    #[arg(long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Continue from the checkpoint in the output directory, bit for bit like an uninterrupted run.
    #[arg(long)]
    pub resume: bool,
    /// Print the configuration with every key and its default, and stop.
    #[arg(long)]
    pub print_config: bool,
    /// Say at the start and at the end which methods could be used, what steps by them are predicted to take and took.
    #[arg(long)]
    pub explain: bool,
}

/// How to compute, where there is no configuration file or it is to be overruled.
#[derive(Args)]
pub struct How {
    /// Boundaries by axis: p periodic, w wall, o open; as in ppw.
    #[arg(long, value_parser = boundaries)]
    pub boundary: Option<[Boundary; 3]>,
    /// Periodic images of BVH methods: auto, gamma, instances or ghosts.
    #[arg(long, default_value = "auto")]
    pub images: Choice<Images>,
    /// Order of particles in memory: none, morton or cell.
    #[arg(long, default_value = "none")]
    pub order: Order,
    /// Device: auto (the first usable GPU, else the CPU), cpu, cuda or cuda:N.
    #[arg(long, default_value = "auto")]
    pub device: Device,
    /// Method: auto, or one that `nearfield methods` lists.
    #[arg(long, default_value = "auto")]
    pub method: Choice<Method>,
    /// Print one JSON object.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct Forces {
    /// Particles: .xyz, .extxyz, .data, .lmp, .gro, or - for extended XYZ on standard input.
    pub input: PathBuf,
    /// Configuration file, for its [interaction] and [boundary].
    #[arg(long)]
    pub config: Option<PathBuf>,
    /// Cutoff; ignored where the input has radii.
    #[arg(long, allow_negative_numbers = true)]
    pub cutoff: Option<f64>,
    /// Energy scale of all types.
    #[arg(long, allow_negative_numbers = true)]
    pub epsilon: Option<f64>,
    /// Length scale of all types.
    #[arg(long, allow_negative_numbers = true)]
    pub sigma: Option<f64>,
    /// What is done at the cutoff: nothing, or a shift of energy or force to zero.
    #[arg(long, value_enum)]
    pub truncation: Option<TruncationName>,
    #[command(flatten)]
    pub how: How,
    /// Where to write id,fx,fy,fz,energy,neighbors: as in forces.csv.
    #[arg(long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

#[derive(Args)]
pub struct NeighborsArguments {
    /// Particles: .xyz, .extxyz, .data, .lmp, .gro, or - for extended XYZ on standard input.
    pub input: PathBuf,
    /// Cutoff; ignored where the input has radii.
    #[arg(long, allow_negative_numbers = true)]
    pub cutoff: f32,
    /// List each pair once (i < j) instead of both ways.
    #[arg(long)]
    pub half: bool,
    #[command(flatten)]
    pub how: How,
    /// Where to write the pairs: as in pairs.csv or pairs.npz.
    #[arg(long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

#[derive(Args)]
pub struct GenerateArguments {
    /// fcc, lattice, disordered, cluster, uniform or sphere-surface.
    pub kind: Positions,
    /// Number of particles.
    #[arg(short = 'n', long = "particles", value_name = "N")]
    pub n: usize,
    /// Box lengths.
    #[arg(long = "box", value_name = "X,Y,Z", value_parser = lengths, required_unless_present = "density")]
    pub lengths: Option<[f64; 3]>,
    /// Number density of a cubic box.
    #[arg(long, conflicts_with = "lengths")]
    pub density: Option<f64>,
    /// Search radii: constant:R, uniform:LO,HI or lognormal:MU,SIGMA,LO,HI[,clamp].
    #[arg(long, value_name = "DIST")]
    pub radii: Option<RadiiSpec>,
    /// Temperature of the velocities.
    #[arg(long, default_value_t = 0.0)]
    pub temperature: f64,
    /// Centre of a cluster; random without it.
    #[arg(long, value_name = "X,Y,Z", value_parser = lengths)]
    pub center: Option<[f64; 3]>,
    /// Standard deviation of a cluster.
    #[arg(long)]
    pub spread: Option<f64>,
    /// Boundaries by axis: p periodic, w wall, o open.
    #[arg(long, default_value = "ppp", value_parser = boundaries)]
    pub boundary: [Boundary; 3],
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// File to write: .xyz, .extxyz, .data or .lmp.
    #[arg(short, long)]
    pub output: PathBuf,
}

#[derive(Args)]
pub struct Listing {
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Names of [`Truncation`].
#[derive(Clone, Copy, ValueEnum)]
pub enum TruncationName {
    /// Nothing.
    Cut,
    /// The energy is shifted.
    Energy,
    /// Force and energy are shifted.
    Force,
}

impl From<TruncationName> for Truncation {
    fn from(name: TruncationName) -> Self {
        match name {
            TruncationName::Cut => Self::Cut,
            TruncationName::Energy => Self::Energy,
            TruncationName::Force => Self::Force,
        }
    }
}

fn boundaries(text: &str) -> Result<[Boundary; 3], String> {
    let letters: Vec<Boundary> = text
        .chars()
        .map(|letter| match letter {
            'p' => Ok(Boundary::Periodic),
            'w' => Ok(Boundary::Wall),
            'o' => Ok(Boundary::Open),
            other => Err(format!("'{other}' is none of p (periodic), w (wall), o (open)")),
        })
        .collect::<Result<_, _>>()?;
    letters.try_into().map_err(|_| "three letters are needed, one an axis, as in ppw".into())
}

fn lengths(text: &str) -> Result<[f64; 3], String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|number| number.trim().parse().map_err(|_| format!("\"{number}\" is not a number")))
        .collect::<Result<_, _>>()?;
    numbers.try_into().map_err(|_| "three numbers are needed, as in 10,10,20".into())
}
