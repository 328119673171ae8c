//! Yukawa (screened Coulomb, Debye-Hückel): `U = ε (σ/r) exp(-κ r)`.

use super::{PairPotential, Real};

/// Screened repulsion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yukawa {
    /// Inverse screening length κ, \[1/length\].
    pub kappa: f32,
}

impl PairPotential for Yukawa {
    #[inline(always)]
    fn f_over_r<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        let (r, kappa) = (r2.sqrt(), T::of(f64::from(self.kappa)));
        epsilon * sigma * (-(kappa * r)).exp() * (T::of(1.0) / r + kappa) / r2
    }

    #[inline(always)]
    fn energy<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        let (r, kappa) = (r2.sqrt(), T::of(f64::from(self.kappa)));
        epsilon * sigma * (-(kappa * r)).exp() / r
    }
}
