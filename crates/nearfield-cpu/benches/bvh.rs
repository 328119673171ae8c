//! Build, refit and count queries of the software BVH, in milliseconds: median / best.
//!
//! `uniform`: 10^6 equal boxes in a periodic cube, radius for 8 and for 32 neighbours on average; particles in random
//! order, or in the order of the tree. `clustered`: 10^6 of radius 1 in a normal cloud of standard deviation 25, in the
//! order of the tree. `log-normal`: 10^5 boxes of radii LN(1, 2) within [1, 330] in a
//! cube of 1000 (paper A). A count query tests every proposed slot against each query point of the group.

use nearfield_core::{Boundary, Images, SimBox};
use nearfield_cpu::{Bvh, GroupBox, Input, InputRadii, LANES, Run, Structure, Vicinity};
use pulp::{Arch, Simd, WithSimd};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, LogNormal, Normal};
use rand_pcg::Pcg64Mcg as Rng;
use rayon::prelude::*;
use std::{ops::Range, time::Instant};

struct Scene {
    sim_box: SimBox,
    position: [Vec<f32>; 3],
    radii: Option<Vec<f32>>,
    cutoff: f32,
}

impl Scene {
    fn uniform(n: usize, neighbors: f32) -> Self {
        let length = (n as f32).cbrt();
        let rng = &mut Rng::seed_from_u64(1);
        Self {
            sim_box: SimBox::cubic(length, Boundary::Periodic).expect("a valid box"),
            position: [0; 3].map(|_| (0..n).map(|_| rng.random_range(0.0..length)).collect()),
            radii: None,
            cutoff: (neighbors * 3.0 / (4.0 * std::f32::consts::PI)).cbrt(),
        }
    }

    fn clustered(n: usize) -> Self {
        let rng = &mut Rng::seed_from_u64(4);
        let normal = Normal::new(500.0f32, 25.0).expect("a valid distribution");
        Self {
            sim_box: SimBox::cubic(1000.0, Boundary::Periodic).expect("a valid box"),
            position: [0; 3].map(|_| normal.sample_iter(&mut *rng).take(n).collect()),
            radii: None,
            cutoff: 1.0,
        }
    }

    fn log_normal(n: usize) -> Self {
        let rng = &mut Rng::seed_from_u64(2);
        let radius = LogNormal::new(1.0f32, 2.0).expect("a valid distribution");
        let mut draws = radius.sample_iter(rng).filter(|r| (1.0..=330.0).contains(r));
        let radii = (&mut draws).take(n).collect();
        let rng = &mut Rng::seed_from_u64(3);
        Self {
            sim_box: SimBox::cubic(1000.0, Boundary::Periodic).expect("a valid box"),
            position: [0; 3].map(|_| (0..n).map(|_| rng.random_range(0.0..1000.0)).collect()),
            radii: Some(radii),
            cutoff: 0.0,
        }
    }

    fn input(&self) -> Input<'_> {
        let radii = self.radii.as_deref().map_or(InputRadii::Uniform(self.cutoff), InputRadii::PerParticle);
        Input { sim_box: &self.sim_box, position: self.position.each_ref().map(Vec::as_slice), radii, kind: &[] }
    }

    /// The same particles in the order of their tree.
    fn sorted(mut self) -> Self {
        let mut bvh = Bvh::new(Images::Gamma);
        bvh.build(&self.input());
        let order: Vec<usize> = bvh.slots().particle.iter().filter(|&&p| p != u32::MAX).map(|&p| p as usize).collect();
        let position = self.position.each_ref().map(|axis| order[..axis.len()].iter().map(|&p| axis[p]).collect());
        self.position = position;
        self
    }
}

/// Pairs (i, j) with d < r_j, a particle with itself included, and candidates tested.
fn count(scene: &Scene, bvh: &Bvh) -> (u64, u64) {
    let arch = Arch::new();
    (0..bvh.n_groups())
        .into_par_iter()
        .with_min_len(64)
        .map_init(Vec::new, |runs, g| arch.dispatch(CountGroup { scene, bvh, runs, slots: bvh.group(g) }))
        .reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1))
}

struct CountGroup<'a> {
    scene: &'a Scene,
    bvh: &'a Bvh,
    runs: &'a mut Vec<Run>,
    slots: Range<usize>,
}

impl WithSimd for CountGroup<'_> {
    type Output = (u64, u64);

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> (u64, u64) {
        let Self { scene, bvh, runs, slots: queries } = self;
        let slots = bvh.slots();
        let queries = queries.start..queries.end.min(scene.position[0].len());
        let group = GroupBox::around(slots, queries.clone(), scene.cutoff).expect("groups hold particles");
        runs.clear();
        bvh.runs(&group, &mut Vicinity::default(), runs);
        let (mut found, mut tested) = ([0u32; LANES], 0);
        for run in runs.iter() {
            let shift = scene.sim_box.shift(run.image);
            for first in (run.start as usize..run.end as usize).step_by(LANES) {
                let lanes = first..first + LANES;
                let (x, y, z) = (&slots.x[lanes.clone()], &slots.y[lanes.clone()], &slots.z[lanes.clone()]);
                let mut range2 = [scene.cutoff * scene.cutoff; LANES];
                if !slots.radius.is_empty() {
                    for (range2, radius) in range2.iter_mut().zip(&slots.radius[lanes]) {
                        *range2 = radius * radius;
                    }
                }
                for slot in queries.clone() {
                    let at = slots.at(slot);
                    for lane in 0..LANES {
                        let dx = (x[lane] - at[0]) + shift[0];
                        let dy = (y[lane] - at[1]) + shift[1];
                        let dz = (z[lane] - at[2]) + shift[2];
                        let r2 = dx.mul_add(dx, dy.mul_add(dy, dz * dz));
                        found[lane] += u32::from(r2 < range2[lane]);
                    }
                }
            }
            tested += u64::from(run.end - run.start);
        }
        let mut total = 0;
        for found in found {
            total += u64::from(found);
        }
        (total, tested * queries.len() as u64)
    }
}

/// Median and best time of the work, as text.
fn time(mut work: impl FnMut()) -> String {
    let mut times = [0; 9].map(|_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64() * 1e3
    });
    times.sort_by(f64::total_cmp);
    format!("{:6.1} /{:6.1}", times[times.len() / 2], times[0])
}

fn measure(name: &str, scene: &Scene, images: Images) {
    let mut bvh = Bvh::new(images);
    bvh.build(&scene.input());
    let build = time(|| bvh.build(&scene.input()));
    let refit = time(|| {
        let _ = bvh.refit(&scene.input());
    });
    let (mut pairs, mut tested) = (0, 0);
    let query = time(|| (pairs, tested) = count(scene, &bvh));
    let (n, threads) = (scene.position[0].len() as f64, rayon::current_num_threads());
    println!(
        "{name:<22} {images:<9} {threads} threads:  build {build}  refit {refit}  count {query}  \
         neighbours {:7.1}  tested {:8.1}  cost {:.1}",
        pairs as f64 / n - 1.0,
        tested as f64 / n,
        bvh.quality(),
    );
}

fn main() {
    let filter = std::env::args().nth(1).filter(|arg| !arg.starts_with('-')).unwrap_or_default();
    let wanted = |name: &str| name.contains(&filter);
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            for neighbors in [8.0, 32.0] {
                let name = format!("uniform k={neighbors}");
                if wanted(&name) {
                    let scene = Scene::uniform(1_000_000, neighbors);
                    measure(&format!("{name} random"), &scene, Images::Gamma);
                    let scene = scene.sorted();
                    for &images in Images::ALL {
                        measure(&format!("{name} sorted"), &scene, images);
                    }
                }
            }
            if wanted("clustered") {
                measure("clustered sorted", &Scene::clustered(1_000_000).sorted(), Images::Gamma);
            }
            if wanted("log-normal") {
                let scene = Scene::log_normal(100_000);
                for &images in Images::ALL {
                    measure("log-normal", &scene, images);
                }
            }
        });
    }
}
