//! Division of particles into classes of similar radius.

use super::survey::{Bulk, sample_indices};
use rayon::prelude::*;

/// What one more class costs a query, in candidates: looking its pencils up.
const CLASS_COST: f64 = 64.0;

/// Bins of radius that class limits are chosen from.
const BINS: usize = 48;

/// Narrowest bin, in octaves.
const LEAST_OCTAVES: f32 = 0.25;

/// Largest sample the limits are chosen by.
const SAMPLE: usize = 8192;

/// Particles whose radius is at most `limit` and above that of the class before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Class {
    pub limit: f32,
    /// Number of particles.
    pub n: usize,
    /// Their largest radius; zero where there is one radius for all, which queries bring with them.
    pub largest: f32,
}

/// One class for all.
pub(super) fn single(n: usize) -> Vec<Class> {
    vec![Class { limit: f32::INFINITY, n, largest: 0.0 }]
}

/// The class of a radius.
#[inline(always)]
pub(super) fn class_of(limits: &[f32], radius: f32) -> usize {
    limits.iter().filter(|&&limit| radius > limit).count()
}

/// Divides particles so that the expected number of candidates, plus the cost of searching each class, is least.
pub(super) fn divide(radii: &[f32], bulk: &Bulk) -> Vec<Class> {
    let limits = choose_limits(radii, bulk);
    let empty = || vec![(0usize, 0.0f32); limits.len()];
    let tally = radii
        .par_chunks(1 << 15)
        .map(|chunk| {
            let mut tally = empty();
            for &r in chunk {
                let (n, largest) = &mut tally[class_of(&limits, r)];
                *n += 1;
                *largest = largest.max(r);
            }
            tally
        })
        .reduce(empty, |a, b| a.iter().zip(&b).map(|(a, b)| (a.0 + b.0, a.1.max(b.1))).collect());
    limits.iter().zip(tally).map(|(&limit, (n, largest))| Class { limit, n, largest }).collect()
}

/// Upper limits of the classes, ascending; the last is infinite.
///
/// Queries of radius up to R meet all particles of a class within max(R, R_class). Summed over pairs of classes,
/// each pair is charged to its larger one: a class of limit R that holds the particles from rank `a` to rank `b`
/// costs `share(R) (b² - a²)` candidates, whatever the other classes are. So the best division is a shortest path.
fn choose_limits(radii: &[f32], bulk: &Bulk) -> Vec<f32> {
    let mut sample: Vec<f32> = sample_indices(radii.len(), SAMPLE).map(|i| radii[i]).collect();
    sample.sort_unstable_by(f32::total_cmp);
    let (Some(&first), Some(&last)) = (sample.first(), sample.last()) else { return vec![f32::INFINITY] };
    let octaves = ((last / first).log2() / BINS as f32).max(LEAST_OCTAVES);
    let edges: Vec<f32> = (1..=BINS).map(|k| first * (octaves * k as f32).exp2()).collect();
    let ranks: Vec<f64> = std::iter::once(0)
        .chain(edges.iter().map(|&edge| sample.partition_point(|&r| r <= edge)))
        .map(|rank| rank as f64 / sample.len() as f64)
        .collect();

    let n = bulk.n as f64;
    let candidates: Vec<f64> = edges.iter().map(|&edge| n * bulk.share_within(f64::from(edge.min(last)))).collect();
    // best[k]: least cost for a query of the particles below edge k, and where the last class begins.
    let mut best = vec![(0.0, 0); BINS + 1];
    for end in 1..=BINS {
        best[end] = (0..end)
            .map(|begin| {
                let class = candidates[end - 1] * (ranks[end].powi(2) - ranks[begin].powi(2));
                let overhead = if ranks[end] > ranks[begin] { CLASS_COST } else { 0.0 };
                (best[begin].0 + class + overhead, begin)
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .expect("there is a begin before every end");
    }
    let mut limits = Vec::new();
    let mut end = BINS;
    while end > 0 {
        let begin = best[end].1;
        if ranks[end] > ranks[begin] {
            limits.push(edges[end - 1]);
        }
        end = begin;
    }
    limits.reverse();
    *limits.last_mut().expect("the sample is in some class") = f32::INFINITY;
    limits
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bulk(n: usize) -> Bulk {
        Bulk { n, lo: [0.0; 3], hi: [1000.0; 3], clustering: 1.0 }
    }

    #[test]
    fn equal_radii_are_one_class() {
        let classes = divide(&vec![3.0; 1000], &bulk(1000));
        assert_eq!(classes, [Class { limit: f32::INFINITY, n: 1000, largest: 3.0 }]);
    }

    #[test]
    fn a_few_giants_are_kept_apart_from_many_small_ones() {
        let mut radii = vec![1.0; 100_000];
        radii[7] = 300.0;
        radii[8] = 299.0;
        radii.resize(101_000, 250.0);
        let classes = divide(&radii, &bulk(radii.len()));
        assert!(classes.len() >= 2, "{classes:?}");
        assert_eq!(classes[0].largest, 1.0);
        assert_eq!(classes.iter().map(|c| c.n).sum::<usize>(), radii.len());
        assert_eq!(classes.last().unwrap().largest, 300.0);
    }

    #[test]
    fn no_radii_are_one_class_of_none() {
        assert_eq!(divide(&[], &bulk(0)), [Class { limit: f32::INFINITY, n: 0, largest: 0.0 }]);
    }
}
