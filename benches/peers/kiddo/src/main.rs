//! Full neighbour lists of uniform points with kiddo's immutable k-d tree, in single precision and open space (it has
//! no periodic boundaries). Prints the median of three times, index and output included. Threads: RAYON_NUM_THREADS.

use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::{f64::consts::PI, time::Instant};

fn main() {
    println!("n,k,tool,threads,milliseconds,entries");
    for n in [100_000usize, 1_000_000] {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        let length = (n as f64).cbrt() as f32;
        let points: Vec<[f32; 3]> =
            (0..n).map(|_| std::array::from_fn(|_| random.random_range(0.0..length))).collect();
        for k in [8.0f64, 32.0, 100.0] {
            let r = (k / (4.0 / 3.0 * PI)).cbrt() as f32;
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
            println!("{n},{k},kiddo full,{},{:.1},{entries}", rayon::current_num_threads(), times[1]);
        }
    }
}
