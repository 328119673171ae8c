//! Morse: `U = ε [exp(-2 α (r - σ)) - 2 exp(-α (r - σ))]`; depth ε at r = σ.

use super::{PairPotential, Real};

/// Anharmonic bond-like attraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Morse {
    /// Width parameter α, \[1/length\].
    pub alpha: f32,
}

impl PairPotential for Morse {
    #[inline(always)]
    fn f_over_r<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        let (r, alpha) = (r2.sqrt(), T::of(f64::from(self.alpha)));
        let e = (-(alpha * (r - sigma))).exp();
        let f = T::of(2.0) * epsilon * alpha * e * (e - T::of(1.0)) / r;
        // At zero distance the force has no direction.
        if r2 > T::of(0.0) { f } else { T::of(0.0) }
    }

    #[inline(always)]
    fn energy<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        let e = (-(T::of(f64::from(self.alpha)) * (r2.sqrt() - sigma))).exp();
        epsilon * e * (e - T::of(2.0))
    }
}
