//! Where the particles are: bounds of all, bounds of the bulk, and how clustered they are.

use super::order::range;
use crate::Input;
use crate::lanes::{Isa, Kernel, Lanes};
use rayon::prelude::*;

/// Corners of the box around all particles.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bounds {
    pub lo: [f32; 3],
    pub hi: [f32; 3],
}

impl Bounds {
    /// The bounds of `input`; zeros when it is empty.
    pub fn of(input: &Input) -> Self {
        if input.is_empty() {
            return Self::default();
        }
        let isa = Isa::detect();
        let axis = |a: usize| {
            input.position[a]
                .par_chunks(1 << 15)
                .map(|values| isa.run(RangeOf(values)))
                .reduce(|| [f32::MAX, f32::MIN], |a, b| [a[0].min(b[0]), a[1].max(b[1])])
        };
        let ranges = [axis(0), axis(1), axis(2)];
        Self { lo: ranges.map(|r| r[0]), hi: ranges.map(|r| r[1]) }
    }
}

/// See [`range`].
struct RangeOf<'a>(&'a [f32]);

impl Kernel for RangeOf<'_> {
    type Output = [f32; 2];

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> [f32; 2] {
        range(lanes, self.0)
    }
}

/// Largest sample that quantiles are taken from.
const QUANTILE_SAMPLE: usize = 1024;

/// Largest sample for the clustering and the classes.
const SAMPLE: usize = 8192;

/// Most bins of the coarse histogram along one axis.
const BINS: usize = 16;

/// The region nearly all particles are in, and how they fill it.
#[derive(Clone, Debug, Default)]
pub(super) struct Bulk {
    pub n: usize,
    pub lo: [f32; 3],
    pub hi: [f32; 3],
    /// Density a particle sees on average, over n / volume: 1 when uniform.
    pub clustering: f64,
}

impl Bulk {
    /// Surveys `input` by samples at even strides.
    pub fn of(input: &Input, bounds: &Bounds) -> Self {
        let n = input.len();
        let mut bulk = Self { n, lo: bounds.lo, hi: bounds.hi, clustering: 1.0 };
        if n == 0 {
            return bulk;
        }
        for axis in 0..3 {
            (bulk.lo[axis], bulk.hi[axis]) = inner_range(input.position[axis], bounds.lo[axis], bounds.hi[axis]);
        }
        bulk.clustering = bulk.measure_clustering(input);
        bulk
    }

    /// Lengths of the region.
    pub fn lengths(&self) -> [f64; 3] {
        std::array::from_fn(|axis| f64::from(self.hi[axis]) - f64::from(self.lo[axis]))
    }

    /// Expected share of all particles within `r` of one of them.
    pub fn share_within(&self, r: f64) -> f64 {
        let lengths = self.lengths();
        let around = lengths.iter().fold(1.0, |share, &length| share * (2.0 * r / length.max(2.0 * r)));
        (0.5 * around * self.clustering).min(1.0)
    }

    /// The mean over particles of the number of others in the same bin, against the uniform expectation.
    fn measure_clustering(&self, input: &Input) -> f64 {
        let sample = sample_indices(input.len(), SAMPLE);
        let bins = ((sample.len() as f64 / 8.0).cbrt() as usize).clamp(1, BINS);
        let mut count = vec![0u32; BINS * BINS * BINS];
        let mut n_bins = 1.0;
        let scale: [f32; 3] = std::array::from_fn(|axis| {
            let length = self.hi[axis] - self.lo[axis];
            let scale = bins as f32 / length;
            if length > 0.0 && scale.is_finite() {
                n_bins *= bins as f64;
                scale
            } else {
                0.0
            }
        });
        let n_sampled = sample.len() as f64;
        for i in sample {
            let p = input.at(i);
            let bin: [usize; 3] =
                std::array::from_fn(|axis| (((p[axis] - self.lo[axis]) * scale[axis]) as usize).min(bins - 1));
            count[(bin[2] * BINS + bin[1]) * BINS + bin[0]] += 1;
        }
        let together: f64 = count.iter().map(|&c| f64::from(c) * (f64::from(c) - 1.0)).sum();
        (together * n_bins / (n_sampled * (n_sampled - 1.0)).max(1.0)).max(1.0)
    }
}

/// At most `limit` of `0..n`, at an even stride.
pub(super) fn sample_indices(n: usize, limit: usize) -> impl ExactSizeIterator<Item = usize> {
    let size = n.min(limit);
    (0..size).map(move |k| (k as u64 * n as u64 / size as u64) as usize)
}

/// The range of the inner 98 % of `x`, widened by half on each side, within `[lo, hi]`.
fn inner_range(x: &[f32], lo: f32, hi: f32) -> (f32, f32) {
    let mut sample: Vec<f32> = sample_indices(x.len(), QUANTILE_SAMPLE).map(|i| x[i]).collect();
    let (low, high) = (sample.len() / 100, sample.len() - 1 - sample.len() / 100);
    let low = *sample.select_nth_unstable_by(low, f32::total_cmp).1;
    let high = *sample.select_nth_unstable_by(high, f32::total_cmp).1;
    let margin = 0.5 * (high - low);
    ((low - margin).max(lo), (high + margin).min(hi))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::InputRadii;
    use nearfield_core::{Boundary, SimBox};

    #[test]
    fn a_far_outlier_does_not_stretch_the_bulk() {
        let mut x: Vec<f32> = (0..1000).map(|i| i as f32 * 1e-3).collect();
        x[500] = 1e30;
        let sim_box = SimBox::cubic(1.0, Boundary::Open).unwrap();
        let input = Input { sim_box: &sim_box, position: [&x; 3], radii: InputRadii::Uniform(0.1), kind: &[] };
        let bounds = Bounds::of(&input);
        assert_eq!(bounds.hi, [1e30; 3]);
        let bulk = Bulk::of(&input, &bounds);
        assert!(bulk.hi[0] < 2.0, "{bulk:?}");
        assert!(bulk.clustering > 5.0, "points on a diagonal are clustered: {bulk:?}");
    }
}
