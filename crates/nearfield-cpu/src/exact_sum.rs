//! Sums that do not depend on the order of their terms, so that totals are equal whatever the memory order.

use rayon::prelude::*;

/// Bits kept below the largest term: 90 of the 127 of an `i128`, leaving room for 2^36 terms.
const BITS: i32 = 90;

/// The sum of `term(0..n)`: each term is rounded to a multiple of 2^-90 of the largest one's binade, and the rounded
/// terms are summed exactly. NaN or infinite terms give NaN.
pub(crate) fn exact_sum(n: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    let largest = (0..n)
        .into_par_iter()
        .with_min_len(4096)
        .map(|i| term(i).abs())
        .reduce(|| 0.0, |a, b| if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) });
    if largest == 0.0 {
        return 0.0;
    }
    if !largest.is_finite() {
        return f64::NAN;
    }
    // Splitting the power keeps both factors normal numbers.
    let exponent = BITS - largest.log2().ceil() as i32;
    let (half, rest) = ((exponent / 2), exponent - exponent / 2);
    let (up, down) = (2f64.powi(half), 2f64.powi(rest));
    let total: i128 = (0..n).into_par_iter().with_min_len(4096).map(|i| (term(i) * up * down) as i128).sum();
    total as f64 / up / down
}

#[cfg(test)]
mod tests {
    use super::exact_sum;

    #[test]
    fn the_order_of_terms_does_not_matter_and_the_sum_is_right() {
        let term = |i: usize| ((i as f64 * 1.618).sin() * 10.0).powi(7) + 1e-9;
        let n = 20_000;
        let forward = exact_sum(n, term);
        let backward = exact_sum(n, |i| term(n - 1 - i));
        assert_eq!(forward.to_bits(), backward.to_bits());
        let mut compensated = (0.0f64, 0.0f64);
        for i in 0..n {
            let (x, (sum, carry)) = (term(i), compensated);
            let t = sum + x;
            compensated = (t, carry + if sum.abs() >= x.abs() { (sum - t) + x } else { (x - t) + sum });
        }
        let reference = compensated.0 + compensated.1;
        assert!((forward - reference).abs() <= 1e-15 * 1e7 * n as f64, "{forward} {reference}");
    }

    #[test]
    fn extreme_terms_neither_overflow_nor_vanish() {
        assert_eq!(exact_sum(3, |i| [1e300, -1e300, 5e299][i]), 5e299);
        assert_eq!(exact_sum(2, |_| 1e-300), 2e-300);
        assert_eq!(exact_sum(0, |_| 1.0), 0.0);
        assert!(exact_sum(2, |i| [1.0, f64::INFINITY][i]).is_nan());
    }
}
