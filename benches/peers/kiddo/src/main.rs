//! Full neighbour lists with kiddo's immutable k-d tree, in single precision and open space (it has no periodic
//! boundaries): uniform points, points on a sphere and in a normal cluster. Prints the median of three times, index and
//! output included. Threads: RAYON_NUM_THREADS.

use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::{
    f64::consts::{PI, TAU},
    time::Instant,
};

/// Name, points and cutoff.
type Cloud = (String, Vec<[f32; 3]>, f32);

fn clouds(n: usize) -> Vec<Cloud> {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
    let length = (n as f64).cbrt() as f32;
    let uniform: Vec<[f32; 3]> = (0..n).map(|_| std::array::from_fn(|_| random.random_range(0.0..length))).collect();
    // Box and Muller.
    let mut normal = || {
        let (u, v): (f64, f64) = (1.0 - random.random::<f64>(), random.random());
        ((-2.0 * u.ln()).sqrt() * (TAU * v).cos()) as f32
    };
    let normal: Vec<[f32; 3]> = (0..n).map(|_| std::array::from_fn(|_| normal())).collect();
    let on_sphere = |p: &[f32; 3]| p.map(|x| x / p.iter().map(|x| x * x).sum::<f32>().sqrt());
    let sphere: Vec<_> = normal.iter().map(on_sphere).collect();
    let cluster: Vec<_> = normal.iter().map(|p| p.map(|x| 25.0 * x)).collect();
    let in_space = |k: f64| (format!("uniform k={k}"), uniform.clone(), (k / (4.0 / 3.0 * PI)).cbrt() as f32);
    let on_surface = |k: f64| (format!("sphere k={k}"), sphere.clone(), (2.0 * (k / n as f64).sqrt()) as f32);
    let clouds = [8.0, 32.0, 100.0].map(in_space).into_iter().chain([9.0, 72.0].map(on_surface));
    clouds.chain([("cluster r=1".into(), cluster, 1.0)]).collect()
}

fn main() {
    println!("n,points,tool,threads,milliseconds,entries");
    for n in [100_000usize, 1_000_000] {
        for (name, points, r) in clouds(n) {
            let mut times = Vec::new();
            let mut entries = 0;
            for _ in 0..3 {
                let start = Instant::now();
                let tree: ImmutableKdTree<f32, 3> = ImmutableKdTree::new_from_slice(&points);
                let near = |p: &[f32; 3]| tree.within_unsorted::<SquaredEuclidean>(p, r * r);
                let rows: Vec<Vec<u32>> =
                    points.par_iter().map(|p| near(p).into_iter().map(|x| x.item as u32).collect()).collect();
                times.push(1e3 * start.elapsed().as_secs_f64());
                // Each point finds itself.
                entries = rows.iter().map(Vec::len).sum::<usize>() - n;
            }
            times.sort_by(f64::total_cmp);
            println!("{n},{name},kiddo full,{},{:.1},{entries}", rayon::current_num_threads(), times[1]);
        }
    }
}
