//! A potential with its truncation applied.

use super::PairCoefficients;
use crate::potentials::{PairPotential, Real};

/// Force and energy of a pair within range.
pub trait PairLaw: Send + Sync {
    /// `-(1/r) dU/dr`, truncation applied.
    fn f_over_r<T: Real>(&self, r2: T, c: &PairCoefficients<T>) -> T;
    /// `U`, truncation applied.
    fn energy<T: Real>(&self, r2: T, c: &PairCoefficients<T>) -> T;
}

/// Applies the shifts that `PairCoefficients` holds. `FORCE_SHIFT` costs a square root, so it is a constant.
#[derive(Clone, Debug)]
pub struct Truncated<'a, P, const FORCE_SHIFT: bool>(pub &'a P);

impl<P: PairPotential, const FORCE_SHIFT: bool> PairLaw for Truncated<'_, P, FORCE_SHIFT> {
    #[inline(always)]
    fn f_over_r<T: Real>(&self, r2: T, c: &PairCoefficients<T>) -> T {
        let f = self.0.f_over_r(r2, c.epsilon, c.sigma);
        // Coincident particles of a finite potential: any finite factor will do, it is multiplied by dr = 0.
        if FORCE_SHIFT { f - c.force_shift / r2.max(T::of(f64::from(f32::MIN_POSITIVE))).sqrt() } else { f }
    }

    #[inline(always)]
    fn energy<T: Real>(&self, r2: T, c: &PairCoefficients<T>) -> T {
        let u = self.0.energy(r2, c.epsilon, c.sigma) - c.energy_shift;
        if FORCE_SHIFT { u + (r2.sqrt() - c.range) * c.force_shift } else { u }
    }
}
