//! Weeks-Chandler-Andersen: Lennard-Jones cut at its minimum `2^(1/6) σ` and shifted up by ε, purely repulsive.

use super::{LennardJones, PairPotential, Real};

/// 2^(1/3): the squared distance of the minimum over σ².
const MINIMUM_SQUARED: f64 = 1.259_921_049_894_873_2;

/// The repulsive part of Lennard-Jones. Zero from `2^(1/6) σ` on, whatever the cutoff.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wca;

impl PairPotential for Wca {
    #[inline(always)]
    fn f_over_r<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        let f = LennardJones.f_over_r(r2, epsilon, sigma);
        if r2 < T::of(MINIMUM_SQUARED) * sigma * sigma { f } else { T::of(0.0) }
    }

    #[inline(always)]
    fn energy<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        let u = LennardJones.energy(r2, epsilon, sigma) + epsilon;
        if r2 < T::of(MINIMUM_SQUARED) * sigma * sigma { u } else { T::of(0.0) }
    }
}
