//! Tests of distributions. Seeds are fixed, so they pass or fail for good; the false-alarm rates below are those of an
//! engine that is right but draws other numbers.

/// Fails unless independent samples look standard normal: mean, variance and fourth moment within five standard
/// errors (false alarm 6e-7 each), and the Kolmogorov-Smirnov distance below its 0.1 % quantile.
pub fn assert_standard_normal(mut samples: Vec<f64>, what: &str) {
    let n = samples.len() as f64;
    let moment = |k: i32| samples.iter().map(|x| x.powi(k)).sum::<f64>() / n;
    for (k, expected, variance) in [(1, 0.0, 1.0f64), (2, 1.0, 2.0), (4, 3.0, 96.0)] {
        let (found, error) = (moment(k), (variance / n).sqrt());
        assert!((found - expected).abs() < 5.0 * error, "{what}: moment {k} is {found}, not {expected} ± {error}");
    }
    samples.sort_unstable_by(f64::total_cmp);
    let distance = samples
        .iter()
        .enumerate()
        .map(|(k, &x)| {
            let cdf = 0.5 * libm::erfc(-x / std::f64::consts::SQRT_2);
            (cdf - k as f64 / n).abs().max((cdf - (k + 1) as f64 / n).abs())
        })
        .fold(0.0, f64::max);
    // Kolmogorov's distribution: P(D sqrt(n) > 1.95) = 0.001.
    assert!(distance * n.sqrt() < 1.95, "{what}: Kolmogorov-Smirnov distance {distance} of {n} samples");
}

/// Mean and the standard error of the mean of independent samples.
pub fn mean_and_error(samples: &[f64]) -> (f64, f64) {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    let variance = samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearfield_core::philox::{Stream, normals};

    fn draws() -> Vec<f64> {
        (0..1000).flat_map(|i| normals(3, Stream::Langevin, 0, i)).collect()
    }

    #[test]
    fn normal_numbers_pass() {
        assert_standard_normal(draws(), "normal");
    }

    #[test]
    #[should_panic(expected = "moment 2")]
    fn a_tenth_too_wide_fails() {
        assert_standard_normal(draws().iter().map(|x| 1.1 * x).collect(), "wide");
    }

    #[test]
    #[should_panic(expected = "moment 4")]
    fn uniform_numbers_of_unit_variance_fail() {
        let n = 4000;
        let samples = (0..n).map(|k| 12f64.sqrt() * ((f64::from(k) + 0.5) / f64::from(n) - 0.5)).collect();
        assert_standard_normal(samples, "uniform");
    }

    #[test]
    #[should_panic(expected = "Kolmogorov")]
    fn a_distribution_with_the_right_moments_fails_by_its_shape() {
        // Three points with mean 0, variance 1 and fourth moment 3.
        let samples = (0..6000).map(|k| [0.0, 0.0, 0.0, 0.0, 1.0, -1.0][k % 6] * 3f64.sqrt()).collect();
        assert_standard_normal(samples, "three points");
    }
}
