//! Gaussian core: `U = ε exp(-r² / (2 σ²))`.

use super::{PairPotential, Real};

/// Soft repulsion, finite at zero distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gaussian;

impl PairPotential for Gaussian {
    #[inline(always)]
    fn f_over_r<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        let s2 = sigma * sigma;
        epsilon / s2 * (-(r2 / (T::of(2.0) * s2))).exp()
    }

    #[inline(always)]
    fn energy<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        epsilon * (-(r2 / (T::of(2.0) * sigma * sigma))).exp()
    }
}
