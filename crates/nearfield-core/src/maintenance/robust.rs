//! Estimators that a few outliers cannot move: timings are noisy upwards (page faults, other processes).

/// The median; the lower of the two middle values for an even count. `None` when empty. Reorders `values`.
pub(super) fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len().checked_sub(1)? / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The median of the last five samples: two outliers among them do no harm.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RecentMedian {
    samples: [f64; 5],
    count: usize,
}

impl RecentMedian {
    pub(super) fn add(&mut self, sample: f64) {
        self.samples[self.count % 5] = sample;
        self.count += 1;
    }

    /// Samples seen, the forgotten ones included.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    pub(super) fn value(&self) -> Option<f64> {
        let mut samples = self.samples;
        median(&mut samples[..self.count.min(5)])
    }
}

/// Slope of `samples` over their index by Theil's incomplete method: the median slope between each sample of the
/// first half and its partner half the series later. A quarter of the samples may be outliers. `None` below two.
pub(super) fn slope(samples: &[f64]) -> Option<f64> {
    let half = samples.len().div_ceil(2);
    let mut slopes: Vec<f64> =
        samples.iter().zip(&samples[half..]).map(|(early, late)| (late - early) / half as f64).collect();
    median(&mut slopes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_of_a_line_is_exact_and_survives_outliers() {
        let mut line: Vec<f64> = (0..12).map(|k| 3.0 + 0.5 * f64::from(k)).collect();
        assert_eq!(slope(&line), Some(0.5));
        (line[2], line[9]) = (100.0, 200.0);
        assert_eq!(slope(&line), Some(0.5));
        assert_eq!(slope(&line[..1]), None);
        assert_eq!(slope(&[]), None);
    }

    #[test]
    fn the_recent_median_forgets_the_sixth_sample_and_ignores_two_outliers() {
        let mut median = RecentMedian::default();
        assert_eq!(median.value(), None);
        for sample in [9.0, 2.0, 1.0, 50.0, 50.0] {
            median.add(sample);
        }
        assert_eq!(median.value(), Some(9.0));
        median.add(3.0);
        assert_eq!(median.value(), Some(3.0));
    }
}
