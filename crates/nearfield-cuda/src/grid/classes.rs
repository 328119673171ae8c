//! Division of particles into classes of similar radius.

use super::bulk::Bulk;

/// Most classes that kernels take.
const MOST: usize = 8;

/// What one more class costs the 8 particles of a warp, in candidates: looking its rows up. More than 5 to 7 classes
/// were worth at most 5 % where radii span three orders of magnitude.
const CLASS_COST: f64 = 128.0;

/// Bins of radius that limits are chosen from.
const BINS: usize = 48;

/// Narrowest bin, in octaves.
const LEAST_OCTAVES: f64 = 0.25;

/// Particles whose radius is at most `limit` and above that of the class before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Class {
    /// Infinite for the last.
    pub limit: f32,
    /// Number of particles, estimated.
    pub n: f64,
    /// No radius of the class is larger.
    pub largest: f32,
}

/// The one class where there is one cutoff.
pub(super) fn single(n: usize, cutoff: f32) -> Vec<Class> {
    vec![Class { limit: f32::INFINITY, n: n as f64, largest: cutoff }]
}

/// Divides particles so that the expected number of candidates, plus the cost of searching each class, is least.
/// `radii` are those of a sample, `largest` is the largest of all.
pub(super) fn divide(mut radii: Vec<f32>, largest: f32, bulk: &Bulk) -> Vec<Class> {
    radii.sort_unstable_by(f32::total_cmp);
    let mut limits = choose_limits(&radii, bulk);
    // Radii larger than all of the sample are few, and must not widen the search for the others.
    match limits.last_mut() {
        Some(last) if *last >= largest => *last = f32::INFINITY,
        _ => limits.push(f32::INFINITY),
    }
    let per_sampled = bulk.n as f64 / (radii.len().max(1)) as f64;
    let mut below = 0;
    limits
        .iter()
        .map(|&limit| {
            let rank = radii.partition_point(|&r| r <= limit);
            let n = (rank - below).max(1) as f64 * per_sampled;
            below = rank;
            Class { limit, n, largest: limit.min(largest) }
        })
        .collect()
}

/// Upper limits of the classes of a sorted sample, ascending, the last at or above its largest radius.
///
/// Pairs of two classes are searched for from the smaller, so particles below the limit R meet the particles of its
/// class within R. A class from rank `a` to rank `b` costs `n share(R) (b - a) b` candidates, whatever the other
/// classes are, and its overhead for each particle below `b`. So the best division is a shortest path.
fn choose_limits(radii: &[f32], bulk: &Bulk) -> Vec<f32> {
    let (Some(&first), Some(&last)) = (radii.first(), radii.last()) else { return Vec::new() };
    let (first, last) = (f64::from(first), f64::from(last));
    let octaves = ((last / first).log2() / BINS as f64).max(LEAST_OCTAVES);
    // The last edge of those that matter is the largest radius itself: rounding must not leave it out.
    let edges: Vec<f32> = (1..=BINS)
        .map(|k| first * (octaves * k as f64).exp2())
        .map(|edge| if edge * (1.0 + 1e-6) >= last { last as f32 } else { edge as f32 })
        .collect();
    let share = |&edge: &f32| radii.partition_point(|&r| r <= edge) as f64 / radii.len() as f64;
    let ranks: Vec<f64> = std::iter::once(0.0).chain(edges.iter().map(share)).collect();
    let candidates: Vec<f64> = edges.iter().map(|&edge| bulk.n as f64 * bulk.share_within(f64::from(edge))).collect();
    let cost = |begin: usize, end: usize| {
        let (a, b) = (ranks[begin], ranks[end]);
        if b > a { candidates[end - 1] * (b - a) * b + CLASS_COST * b } else { 0.0 }
    };

    // best[k][end]: least cost of the particles below edge `end` in k classes, and where the last class begins. One
    // class is kept for radii beyond the sample.
    let mut best = vec![vec![(f64::INFINITY, 0); BINS + 1]; MOST];
    best[0][0].0 = 0.0;
    for k in 1..MOST {
        for end in 1..=BINS {
            best[k][end] = (0..end)
                .map(|begin| (best[k - 1][begin].0 + cost(begin, end), begin))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .expect("there is a begin before every end");
        }
    }
    let mut k = (1..MOST).min_by(|&a, &b| best[a][BINS].0.total_cmp(&best[b][BINS].0)).expect("MOST is larger");
    let mut limits = Vec::new();
    let mut end = BINS;
    while k > 0 {
        let begin = best[k][end].1;
        if ranks[end] > ranks[begin] {
            limits.push(edges[end - 1]);
        }
        (k, end) = (k - 1, begin);
    }
    limits.reverse();
    limits
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bulk(n: usize) -> Bulk {
        Bulk { n, lo: [0.0; 3], length: [1000.0; 3], clustering: 1.0 }
    }

    #[test]
    fn equal_radii_are_one_class() {
        let classes = divide(vec![3.0; 1000], 3.0, &bulk(1000));
        assert_eq!(classes, [Class { limit: f32::INFINITY, n: 1000.0, largest: 3.0 }]);
    }

    #[test]
    fn a_few_giants_are_kept_apart_from_many_small_ones() {
        let mut radii = vec![1.0; 8000];
        radii.resize(8100, 250.0);
        let classes = divide(radii, 250.0, &bulk(810_000));
        assert_eq!(classes.len(), 2, "{classes:?}");
        assert!(classes[0].largest < 1.2 && classes[1].largest == 250.0, "{classes:?}");
        assert_eq!((classes[0].n, classes[1].n), (800_000.0, 10_000.0));
    }

    #[test]
    fn giants_that_no_sample_has_met_have_a_class_of_their_own() {
        let classes = divide(vec![1.0; 8000], 300.0, &bulk(1_000_000));
        assert_eq!(classes.len(), 2, "{classes:?}");
        assert_eq!((classes[0].largest, classes[1].largest), (1.0, 300.0));
    }

    #[test]
    fn many_sizes_are_no_more_classes_than_kernels_take() {
        let radii: Vec<f32> = (0..8192).map(|i| (i as f32 * 1e-3).exp2()).collect();
        let classes = divide(radii, 400.0, &bulk(10_000_000));
        assert!((4..=MOST).contains(&classes.len()), "{classes:?}");
        assert!(classes.windows(2).all(|w| w[0].limit < w[1].limit), "{classes:?}");
        assert_eq!(classes.last().unwrap().limit, f32::INFINITY);
    }

    #[test]
    fn no_radii_are_one_class() {
        assert_eq!(divide(Vec::new(), 0.0, &bulk(0)).len(), 1);
    }
}
