//! Round numbers along an axis.

/// Values at which a linear axis is labelled.
pub(super) fn linear(low: f64, high: f64) -> Vec<f64> {
    let rough = (high - low).max(f64::MIN_POSITIVE) / 4.0;
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|&step| step >= rough).unwrap_or(rough);
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last).map(|k| k as f64 * step).collect()
}

/// Values at which a logarithmic axis is labelled: powers of ten, with 2 and 5 where there are few, not all where there
/// are many.
pub(super) fn log(low: f64, high: f64) -> Vec<f64> {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let decades = high.log10() - low.log10();
    let mantissas: &[f64] = if decades < 2.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let stride = (decades / 6.0).ceil().max(1.0) as i32;
    let all = (first..=last).filter(|power| power.rem_euclid(stride) == 0);
    let within = |value: &f64| (low * 0.999..=high * 1.001).contains(value);
    all.flat_map(|power| mantissas.iter().map(move |m| m * 10f64.powi(power))).filter(within).collect()
}

/// A label: `0.002`, `40`, `30k`, `2M`, `5G`, `1e-5`.
pub(super) fn label(value: f64) -> String {
    let size = value.abs();
    let (scaled, suffix) = match size {
        0.0 => return "0".into(),
        _ if !(9.99e-4..9.99e14).contains(&size) => return format!("{value:.0e}"),
        _ if size < 9_999.0 => (value, ""),
        _ if size < 999_999.0 => (value / 1e3, "k"),
        _ if size < 1e9 => (value / 1e6, "M"),
        _ if size < 1e12 => (value / 1e9, "G"),
        _ => (value / 1e12, "T"),
    };
    let digits = format!("{scaled:.4}");
    let short = if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { &digits };
    format!("{short}{suffix}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_labelled_at_round_numbers_within_their_range() {
        assert_eq!(linear(0.0, 300.0), [0.0, 100.0, 200.0, 300.0]);
        assert_eq!(log(0.9, 1200.0), [1.0, 10.0, 100.0, 1000.0]);
        assert_eq!(log(450.0, 5000.0), [500.0, 1000.0, 2000.0, 5000.0]);
        assert!(log(1e-9, 1e9).len() < 10);
    }

    #[test]
    fn labels_are_short() {
        let labels = [0.0, 0.002, 40.0, 2.5, 30_000.0, 2e6, 1e-5, 5e9].map(label);
        assert_eq!(labels, ["0", "0.002", "40", "2.5", "30k", "2M", "1e-5", "5G"]);
    }
}
