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

/// A measurement and the step it was made in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    pub step: f64,
    pub value: f64,
}

/// Slope of `samples`, which are in the order of their steps, by Theil's incomplete method: the median slope between each
/// sample of the first half and its partner half the series later. A quarter of the samples may be outliers. `None` below
/// two.
pub(super) fn slope(samples: &[Sample]) -> Option<f64> {
    let half = samples.len().div_ceil(2);
    let between = |(early, late): (&Sample, &Sample)| (late.value - early.value) / (late.step - early.step);
    let mut slopes: Vec<f64> = samples.iter().zip(&samples[half..]).map(between).collect();
    median(&mut slopes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_of_a_line_is_exact_and_survives_outliers() {
        let mut line: Vec<Sample> =
            (0..12).map(|k| f64::from(k * k)).map(|step| Sample { step, value: 3.0 + 0.5 * step }).collect();
        assert_eq!(slope(&line), Some(0.5));
        (line[2].value, line[9].value) = (100.0, 200.0);
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
