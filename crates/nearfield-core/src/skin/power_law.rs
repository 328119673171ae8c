//! Power laws from noisy pairs.

use serde::{Deserialize, Serialize};

/// Part of what is known that each new pair leaves: about the last ten count.
const MEMORY: f64 = 0.9;
/// How firmly the expected exponent is believed, as the sum of squares of ln x about its mean: pairs whose x differ by a
/// factor of 1.2 outweigh it.
const BELIEF: f64 = 0.02;

/// y = c xᵖ by least squares of logarithms, older pairs counting less. Weighted sums of 1, ln x, ln y and products.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct PowerLaw {
    weight: f64,
    x: f64,
    y: f64,
    xx: f64,
    xy: f64,
}

impl PowerLaw {
    /// Takes a pair, both positive.
    pub fn add(&mut self, x: f64, y: f64) {
        let (x, y) = (x.ln(), y.ln());
        let keep = |sum: f64, term: f64| MEMORY * sum + term;
        *self = Self {
            weight: keep(self.weight, 1.0),
            x: keep(self.x, x),
            y: keep(self.y, y),
            xx: keep(self.xx, x * x),
            xy: keep(self.xy, x * y),
        };
    }

    /// Whether there is no pair yet.
    pub fn is_empty(&self) -> bool {
        self.weight == 0.0
    }

    /// The exponent, near `expected` while x have hardly differed, and between zero and twice that.
    pub fn exponent(&self, expected: f64) -> f64 {
        let squares = self.xx - self.x * self.x / self.weight;
        let products = self.xy - self.x * self.y / self.weight;
        ((products + BELIEF * expected) / (squares + BELIEF)).clamp(0.0, 2.0 * expected)
    }

    /// y at `x` where the exponent is `exponent`.
    pub fn at(&self, x: f64, exponent: f64) -> f64 {
        (self.y / self.weight + exponent * (x.ln() - self.x / self.weight)).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted(pairs: impl Iterator<Item = (f64, f64)>) -> PowerLaw {
        let mut law = PowerLaw::default();
        pairs.for_each(|(x, y)| law.add(x, y));
        law
    }

    #[test]
    fn one_pair_is_followed_by_the_expected_exponent() {
        let law = fitted([(2.0, 5.0)].into_iter());
        assert_eq!(law.exponent(3.0), 3.0);
        assert!((law.at(4.0, 3.0) - 40.0).abs() < 1e-9);
    }

    #[test]
    fn pairs_of_a_power_law_give_its_exponent() {
        let law = fitted((1..30).map(|k| (f64::from(k), 7.0 * f64::from(k).powf(1.7))));
        assert!((law.exponent(1.0) - 1.7).abs() < 0.01, "{law:?}");
        assert!((law.at(50.0, 1.7) / (7.0 * 50f64.powf(1.7)) - 1.0).abs() < 0.01);
    }

    #[test]
    fn what_was_long_ago_is_forgotten() {
        let early = (0..100).map(|k| (1.0 + f64::from(k % 5), 1.0));
        let late = (0..100).map(|k| (1.0 + f64::from(k % 5), (1.0 + f64::from(k % 5)).powi(2)));
        assert!((fitted(early.chain(late)).exponent(1.0) - 2.0).abs() < 0.02);
    }
}
