//! Lennard-Jones 12-6: `U = 4 ε [(σ/r)¹² - (σ/r)⁶]`.
//!
//! Paper A's eq. (4) lacks the factor 2 on the r⁻¹² term of the force; it stands here.

use super::{PairPotential, Real};

/// The 12-6 potential.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LennardJones;

impl PairPotential for LennardJones {
    #[inline(always)]
    fn f_over_r<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        let inverse_r2 = T::of(1.0) / r2;
        let s2 = sigma * sigma * inverse_r2;
        let s6 = s2 * s2 * s2;
        T::of(48.0) * epsilon * inverse_r2 * (s6 * (s6 - T::of(0.5)))
    }

    #[inline(always)]
    fn energy<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        let s2 = sigma * sigma / r2;
        let s6 = s2 * s2 * s2;
        T::of(4.0) * epsilon * (s6 * (s6 - T::of(1.0)))
    }
}
