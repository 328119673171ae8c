//! Neighbour lists on the CPU: grid build plus list, counts, and what the grid proposes.
//!
//! `cargo bench -p nearfield-cpu --bench lists [-- FILTER]`. Each line is the median of repeated calls with reused
//! buffers, in milliseconds, on 1 and 2 threads. "candidates" is proposed slots over true directed pairs, "chunks" the
//! share of useful lanes when runs are read sixteen at a time, "bytes" those of the grid for each particle.

use nearfield_core::{Boundary, ListKind, ListRequest, NeighborList, SimBox};
use nearfield_cpu::{Grid, GroupBox, Input, InputRadii, LANES, ListBuilder, Structure, Vicinity, count_neighbors};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, LogNormal, Normal};
use rand_pcg::Pcg64Mcg;
use std::hint::black_box;
use std::time::{Duration, Instant};

struct System {
    name: String,
    sim_box: SimBox,
    position: [Vec<f32>; 3],
    radii: Radii,
}

enum Radii {
    Uniform(f32),
    PerParticle(Vec<f32>),
}

impl System {
    fn new(name: String, length: f32, points: impl Iterator<Item = [f32; 3]>, radii: Radii) -> Self {
        let sim_box = SimBox::cubic(length, Boundary::Periodic).expect("lengths are positive");
        let mut position = [const { Vec::new() }; 3];
        for point in points {
            let (point, _) = sim_box.wrap(point);
            (0..3).for_each(|axis| position[axis].push(point[axis]));
        }
        Self { name, sim_box, position, radii }
    }

    /// Uniform, in random order, with `k` neighbours each on average at unit density.
    fn uniform(n: usize, k: f64) -> Self {
        let length = (n as f64).cbrt() as f32;
        let r = (k / (4.0 / 3.0 * std::f64::consts::PI)).cbrt() as f32;
        Self::new(format!("uniform n {n} k {k}"), length, random(n, length), Radii::Uniform(r))
    }

    fn input(&self) -> Input<'_> {
        Input {
            sim_box: &self.sim_box,
            position: [&self.position[0], &self.position[1], &self.position[2]],
            radii: match &self.radii {
                Radii::Uniform(r) => InputRadii::Uniform(*r),
                Radii::PerParticle(radii) => InputRadii::PerParticle(radii),
            },
            kind: &[],
        }
    }
}

fn random(n: usize, length: f32) -> impl Iterator<Item = [f32; 3]> {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    (0..n).map(move |_| std::array::from_fn(|_| rng.random_range(0.0..length)))
}

/// A cubic lattice, jittered by a tenth of its spacing.
fn lattice(per_edge: usize, spacing: f32) -> impl Iterator<Item = [f32; 3]> {
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    (0..per_edge.pow(3)).map(move |k| {
        [k % per_edge, k / per_edge % per_edge, k / per_edge / per_edge]
            .map(|c| spacing * (c as f32 + 0.5 + rng.random_range(-0.1..0.1)))
    })
}

/// A face-centred cubic lattice, displaced as in a melt.
fn melt(cells: usize, spacing: f32) -> impl Iterator<Item = [f32; 3]> {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let basis = [[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];
    (0..4 * cells.pow(3)).map(move |k| {
        let (cell, b) = (k / 4, basis[k % 4]);
        let cell = [cell % cells, cell / cells % cells, cell / cells / cells];
        std::array::from_fn(|a| spacing * (cell[a] as f32 + b[a] + rng.random_range(-0.15..0.15)))
    })
}

fn lognormal(n: usize) -> Vec<f32> {
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    let distribution = LogNormal::new(1.0f32, 2.0).expect("sigma is positive");
    std::iter::repeat_with(|| distribution.sample(&mut rng)).filter(|r| (1.0..330.0).contains(r)).take(n).collect()
}

/// The unit sphere around the middle of a box of length 4.
fn sphere(n: usize) -> impl Iterator<Item = [f32; 3]> {
    let mut rng = Pcg64Mcg::seed_from_u64(6);
    let normal = Normal::new(0.0f32, 1.0).expect("sigma is positive");
    (0..n).map(move |_| {
        let p: [f32; 3] = std::array::from_fn(|_| normal.sample(&mut rng));
        let length = p.iter().map(|x| x * x).sum::<f32>().sqrt();
        p.map(|x| x / length + 2.0)
    })
}

/// `k` neighbours each on average.
fn on_sphere(n: usize, k: f64) -> System {
    let r = 2.0 * (k / n as f64).sqrt();
    System::new(format!("sphere n {n} k {k}"), 4.0, sphere(n), Radii::Uniform(r as f32))
}

fn cluster(n: usize) -> impl Iterator<Item = [f32; 3]> {
    let mut rng = Pcg64Mcg::seed_from_u64(5);
    let distribution = Normal::new(500.0, 25.0).expect("sigma is positive");
    (0..n).map(move |_| std::array::from_fn(|_| distribution.sample(&mut rng)))
}

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|arg| !arg.starts_with("--")).collect();
    let n_lattice = 47;
    let systems: Vec<Box<dyn Fn() -> System>> = vec![
        Box::new(|| System::uniform(10_000, 32.0)),
        Box::new(|| System::uniform(100_000, 8.0)),
        Box::new(|| System::uniform(100_000, 32.0)),
        Box::new(|| System::uniform(100_000, 100.0)),
        Box::new(|| System::uniform(1_000_000, 8.0)),
        Box::new(|| System::uniform(1_000_000, 32.0)),
        Box::new(|| System::uniform(1_000_000, 100.0)),
        Box::new(|| System::new("sparse n 1000000".into(), 1e3, random(1_000_000, 1e3), Radii::Uniform(1.0))),
        Box::new(|| System::new("cluster n 50000 r 1".into(), 1e3, cluster(50_000), Radii::Uniform(1.0))),
        Box::new(|| System::new("cluster n 100000 r 1".into(), 1e3, cluster(100_000), Radii::Uniform(1.0))),
        Box::new(|| System::new("cluster n 1000000 r 1".into(), 1e3, cluster(1_000_000), Radii::Uniform(1.0))),
        Box::new(|| on_sphere(100_000, 9.0)),
        Box::new(|| on_sphere(100_000, 72.0)),
        Box::new(|| on_sphere(1_000_000, 9.0)),
        Box::new(|| on_sphere(1_000_000, 72.0)),
        Box::new(|| System::new("melt n 32000".into(), 33.5919, melt(20, 33.5919 / 20.0), Radii::Uniform(2.5))),
        Box::new(|| {
            let radii = Radii::PerParticle(lognormal(100_000));
            System::new("log-normal n 100000".into(), 1e3, random(100_000, 1e3), radii)
        }),
        Box::new(move || {
            let points = lattice(n_lattice, 1e3 / n_lattice as f32);
            System::new("dense lattice n 103823 r 160, count only".into(), 1e3, points, Radii::Uniform(160.0))
        }),
    ];
    println!("{:<44} {:>19} {:>19} {:>19} {:>19}", "ms on 1 / 2 threads", "build", "count", "half", "full");
    for system in systems {
        let system = system();
        if wanted.is_empty() || wanted.iter().any(|name| system.name.contains(name.as_str())) {
            measure(&system);
        }
    }
}

fn measure(system: &System) {
    let input = system.input();
    let mut columns: [Vec<f64>; 4] = Default::default();
    let store = !system.name.contains("count only");
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        pool.install(|| {
            let mut grid = Grid::new();
            columns[0].push(median(|| grid.build(&input)));
            columns[1].push(median(|| {
                grid.build(&input);
                black_box(count_neighbors(&grid, &input));
            }));
            for (column, kind) in [(2, ListKind::Half), (3, ListKind::Full)] {
                if store {
                    let mut builder = ListBuilder::default();
                    let mut list =
                        NeighborList { kind, offsets: vec![0], indices: Vec::new(), shifts: None, distances: None };
                    columns[column].push(median(|| {
                        grid.build(&input);
                        builder.build(&grid, &input, ListRequest::new(kind), &mut list);
                        black_box(&list);
                    }));
                }
            }
        });
    }
    print!("{:<44}", system.name);
    for column in columns {
        print!(" {:>19}", column.iter().map(|ms| format!("{ms:.2}")).collect::<Vec<_>>().join(" / "));
    }
    let mut grid = Grid::new();
    grid.build(&input);
    println!("\n    {}", proposals(&grid, &input));
}

/// What the grid proposes for all particles, in words.
fn proposals(grid: &Grid, input: &Input) -> String {
    let pairs = 2 * count_neighbors(grid, input).pairs;
    let uniform = match input.radii {
        InputRadii::Uniform(r) => r,
        InputRadii::PerParticle(_) => 0.0,
    };
    let (mut candidates, mut lanes, mut n_runs) = (0, 0, 0);
    let (mut vicinity, mut runs) = (Vicinity::default(), Vec::new());
    for g in 0..grid.n_groups() {
        let group = grid.group(g);
        let bounds = GroupBox::around(grid.slots(), group.clone(), uniform).expect("groups are not empty");
        runs.clear();
        grid.runs(&bounds, &mut vicinity, &mut runs);
        n_runs += runs.len();
        for run in &runs {
            let n = (run.end - run.start) as usize;
            candidates += group.len() * n;
            lanes += group.len() * n.next_multiple_of(LANES);
        }
    }
    let n = input.len() as f64;
    format!(
        "candidates {:.2}, chunks {:.2}, {:.1} runs and {:.1} particles a group, {:.1} bytes",
        candidates as f64 / pairs as f64,
        candidates as f64 / lanes as f64,
        n_runs as f64 / grid.n_groups() as f64,
        n / grid.n_groups() as f64,
        grid.bytes() as f64 / n,
    )
}

/// Median milliseconds of repeated calls, the first of which warms up.
fn median(mut call: impl FnMut()) -> f64 {
    call();
    let begin = Instant::now();
    let mut times = Vec::new();
    while times.len() < 3 || (times.len() < 21 && begin.elapsed() < Duration::from_millis(400)) {
        let start = Instant::now();
        call();
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}
