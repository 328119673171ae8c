//! Where nearly all particles are, and how they fill that region.

use nearfield_kernels::Float4;

/// Part of the sample that is left out at each end of an axis: strays must not stretch the cells.
const TRIM: usize = 200;

/// What is added at each end, over the length of the rest.
const MARGIN: f64 = 0.25;

/// Most bins of the coarse histogram along one axis, and sampled particles to a bin.
const BINS: usize = 16;
const PER_BIN: f64 = 8.0;

/// The region that nearly all particles are in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bulk {
    /// Number of all particles.
    pub n: usize,
    pub lo: [f64; 3],
    pub length: [f64; 3],
    /// Density that a particle sees on average over n / volume: 1 when uniform.
    pub clustering: f64,
}

impl Bulk {
    /// Of `n` particles, by a sample of them.
    pub fn of(n: usize, sample: &[Float4]) -> Self {
        let positions: Vec<[f64; 3]> = sample
            .iter()
            .filter(|p| p.x.is_finite() && p.y.is_finite() && p.z.is_finite())
            .map(|p| [f64::from(p.x), f64::from(p.y), f64::from(p.z)])
            .collect();
        let ranges: [_; 3] = std::array::from_fn(|axis| inner_range(positions.iter().map(|p| p[axis]).collect()));
        let mut bulk = Self { n, lo: ranges.map(|r| r.0), length: ranges.map(|r| r.1 - r.0), clustering: 1.0 };
        bulk.clustering = bulk.measure_clustering(&positions);
        bulk
    }

    /// Expected share of all particles within `r` of one of them.
    pub fn share_within(&self, r: f64) -> f64 {
        let around = self.length.iter().fold(1.0, |share, &length| share * (2.0 * r / length.max(2.0 * r)));
        (0.5 * around * self.clustering).min(1.0)
    }

    /// The mean over particles of the number of others in the same bin, against the uniform expectation.
    fn measure_clustering(&self, positions: &[[f64; 3]]) -> f64 {
        let n = positions.len() as f64;
        let bins = ((n / PER_BIN).cbrt() as usize).clamp(1, BINS);
        let along = self.length.map(|length| if length > 0.0 { bins } else { 1 });
        let mut count = vec![0u32; along.iter().product()];
        for p in positions {
            let bin: [usize; 3] = std::array::from_fn(|axis| {
                let fraction = (p[axis] - self.lo[axis]) / self.length[axis];
                ((fraction * along[axis] as f64) as usize).min(along[axis] - 1)
            });
            count[(bin[2] * along[1] + bin[1]) * along[0] + bin[0]] += 1;
        }
        let together: f64 = count.iter().map(|&c| f64::from(c) * (f64::from(c) - 1.0)).sum();
        (together * count.len() as f64 / (n * (n - 1.0)).max(1.0)).max(1.0)
    }
}

/// The range of all but the ends of `x`, widened, but within that of all; zeros when there are none.
fn inner_range(mut x: Vec<f64>) -> (f64, f64) {
    let n = x.len();
    if x.is_empty() {
        return (0.0, 0.0);
    }
    let (first, last) = x.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), &x| (lo.min(x), hi.max(x)));
    let mut at = |rank: usize| *x.select_nth_unstable_by(rank, f64::total_cmp).1;
    let trimmed = n / TRIM;
    let (lo, hi) = (at(trimmed), at(n - 1 - trimmed));
    let margin = MARGIN * (hi - lo);
    ((lo - margin).max(first), (hi + margin).min(last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_and_infinite_strays_do_not_stretch_the_bulk() {
        let mut sample: Vec<Float4> = (0..1000).map(|i| Float4::new(i as f32 * 1e-3, 0.0, 7.0, 0.0)).collect();
        (sample[500].x, sample[501].y, sample[502].z) = (1e30, f32::INFINITY, f32::NAN);
        let bulk = Bulk::of(1_000_000, &sample);
        assert!(bulk.length[0] < 1.6, "{bulk:?}");
        assert_eq!((bulk.lo[2], bulk.length[2]), (7.0, 0.0));
    }

    #[test]
    fn nothing_is_a_bulk_of_no_extent() {
        assert_eq!(Bulk::of(0, &[]), Bulk { n: 0, lo: [0.0; 3], length: [0.0; 3], clustering: 1.0 });
    }
}
