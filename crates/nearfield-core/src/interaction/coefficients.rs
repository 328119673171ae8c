//! Parameters of a pair: constant, from a table of types, or scaled by the pair's range.

use super::{Interaction, Truncation};
use crate::{
    potentials::{PairPotential, Real},
    with_potential,
};

/// What a [`super::PairLaw`] needs to know of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairCoefficients<T> {
    /// Energy scale.
    pub epsilon: T,
    /// Length scale.
    pub sigma: T,
    /// The pair's cutoff.
    pub range: T,
    /// Untruncated energy at the cutoff, or zero for [`Truncation::Cut`].
    pub energy_shift: T,
    /// Untruncated force `-dU/dr` at the cutoff for [`Truncation::Force`], else zero.
    pub force_shift: T,
}

impl<T: Real> PairCoefficients<T> {
    /// Coefficients of a potential cut at `range`.
    #[inline(always)]
    pub fn new<P: PairPotential>(potential: &P, truncation: Truncation, epsilon: T, sigma: T, range: T) -> Self {
        let zero = T::of(0.0);
        let r2 = range * range;
        let energy_shift = match truncation {
            Truncation::Cut => zero,
            Truncation::Energy | Truncation::Force => potential.energy(r2, epsilon, sigma),
        };
        let force_shift = match truncation {
            Truncation::Force => potential.f_over_r(r2, epsilon, sigma) * range,
            Truncation::Cut | Truncation::Energy => zero,
        };
        Self { epsilon, sigma, range, energy_shift, force_shift }
    }

    /// The same in f32.
    fn to_f32(self) -> PairCoefficients<f32> {
        PairCoefficients {
            epsilon: self.epsilon.to_f64() as f32,
            sigma: self.sigma.to_f64() as f32,
            range: self.range.to_f64() as f32,
            energy_shift: self.energy_shift.to_f64() as f32,
            force_shift: self.force_shift.to_f64() as f32,
        }
    }
}

/// Where a kernel gets a pair's coefficients from.
/// Small values, passed by copy: a kernel that read them through a pointer could not keep them in registers.
pub trait Coefficients: Copy + Send + Sync {
    /// Whether ranges differ from pair to pair; otherwise the one passed in is the uniform cutoff.
    const VARIABLE_RANGE: bool;
    /// Whether types matter.
    const TYPED: bool;
    /// Coefficients of a pair of types with the given range.
    fn get(&self, kind_i: u32, kind_j: u32, range: f32) -> PairCoefficients<f32>;
}

/// One type, one cutoff: constants.
#[derive(Clone, Copy, Debug)]
pub struct Single(pub PairCoefficients<f32>);

impl Coefficients for Single {
    const VARIABLE_RANGE: bool = false;
    const TYPED: bool = false;

    #[inline(always)]
    fn get(&self, _: u32, _: u32, _: f32) -> PairCoefficients<f32> {
        self.0
    }
}

/// A table of type pairs, one cutoff.
#[derive(Clone, Copy, Debug)]
pub struct Typed<'a> {
    n_types: u32,
    table: &'a [PairCoefficients<f32>],
}

impl<'a> Typed<'a> {
    /// Of a table from [`Interaction::typed_table`].
    ///
    /// # Panics
    /// When the table is empty.
    pub fn new(table: &'a [PairCoefficients<f32>]) -> Self {
        assert!(!table.is_empty(), "an interaction has at least one type");
        Self { n_types: table.len().isqrt() as u32, table }
    }
}

impl Coefficients for Typed<'_> {
    const VARIABLE_RANGE: bool = false;
    const TYPED: bool = true;

    #[inline(always)]
    fn get(&self, kind_i: u32, kind_j: u32, _: f32) -> PairCoefficients<f32> {
        // Types are validated, so the last entry never stands in; a panic here would keep loops from being vectorised.
        let last = self.table.len() - 1;
        self.table[((kind_i * self.n_types + kind_j) as usize).min(last)]
    }
}

/// One type and per-particle radii, without shifts at the cutoff: by value, so that loops are vectorised.
#[derive(Clone, Copy, Debug)]
pub struct ScaledCut {
    epsilon: f32,
    sigma_per_range: f32,
}

impl Coefficients for ScaledCut {
    const VARIABLE_RANGE: bool = true;
    const TYPED: bool = false;

    #[inline(always)]
    fn get(&self, _: u32, _: u32, range: f32) -> PairCoefficients<f32> {
        let sigma = range * self.sigma_per_range;
        PairCoefficients { epsilon: self.epsilon, sigma, range, energy_shift: 0.0, force_shift: 0.0 }
    }
}

/// Per-particle radii: sigma = range / `radius_per_sigma`, epsilon by type.
#[derive(Debug)]
pub struct RadiusScaled<'a, P> {
    potential: &'a P,
    truncation: Truncation,
    sigma_per_range: f32,
    n_types: u32,
    /// Row-major by pairs of types.
    epsilon: &'a [f32],
}

impl<P> Clone for RadiusScaled<'_, P> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<P> Copy for RadiusScaled<'_, P> {}

impl<P: PairPotential> Coefficients for RadiusScaled<'_, P> {
    const VARIABLE_RANGE: bool = true;
    const TYPED: bool = true;

    #[inline(always)]
    fn get(&self, kind_i: u32, kind_j: u32, range: f32) -> PairCoefficients<f32> {
        let epsilon =
            if self.n_types == 1 { self.epsilon[0] } else { self.epsilon[(kind_i * self.n_types + kind_j) as usize] };
        PairCoefficients::new(self.potential, self.truncation, epsilon, range * self.sigma_per_range, range)
    }
}

impl Interaction {
    /// Coefficients of every pair of types for a uniform cutoff, in f64, row-major `[n_types, n_types]`.
    pub fn pair_table(&self, cutoff: f32) -> Vec<PairCoefficients<f64>> {
        let mut table = Vec::with_capacity(self.types.len() * self.types.len());
        for a in &self.types {
            for b in &self.types {
                let (epsilon, sigma) = self.mixing.mix(a, b);
                table.push(with_potential!(&self.potential, p => {
                    PairCoefficients::new(p, self.truncation, epsilon, sigma, f64::from(cutoff))
                }));
            }
        }
        table
    }

    /// Constants for a system of one type and one cutoff.
    pub fn single(&self, cutoff: f32) -> Single {
        Single(self.pair_table(cutoff)[0].to_f32())
    }

    /// The table for several types and one cutoff, for [`Typed::new`].
    pub fn typed_table(&self, cutoff: f32) -> Vec<PairCoefficients<f32>> {
        self.pair_table(cutoff).into_iter().map(PairCoefficients::to_f32).collect()
    }

    /// Epsilon of every pair of types, row-major, for [`Interaction::radius_scaled`].
    pub fn epsilon_table(&self) -> Vec<f32> {
        let pairs = self.types.iter().flat_map(|a| self.types.iter().map(move |b| (a, b)));
        pairs.map(|(a, b)| self.mixing.mix(a, b).0 as f32).collect()
    }

    /// The same as [`Interaction::radius_scaled`] where there is one type and nothing is shifted; `None` elsewhere.
    pub fn scaled_cut(&self) -> Option<ScaledCut> {
        let is_simple = self.types.len() == 1 && self.truncation == Truncation::Cut;
        let epsilon = *self.epsilon_table().first()?;
        is_simple.then_some(ScaledCut { epsilon, sigma_per_range: 1.0 / self.radius_per_sigma })
    }

    /// Range-scaled coefficients for per-particle radii. `potential` is the one of this interaction, `epsilon` its
    /// [`Interaction::epsilon_table`].
    pub fn radius_scaled<'a, P: PairPotential>(&self, potential: &'a P, epsilon: &'a [f32]) -> RadiusScaled<'a, P> {
        RadiusScaled {
            potential,
            truncation: self.truncation,
            sigma_per_range: 1.0 / self.radius_per_sigma,
            n_types: self.types.len() as u32,
            epsilon,
        }
    }

    /// Coefficients of one pair in f64, for the oracle.
    pub fn pair_f64(&self, kind_i: u32, kind_j: u32, range: f32, uniform: bool) -> PairCoefficients<f64> {
        let (epsilon, sigma) = self.mixing.mix(&self.types[kind_i as usize], &self.types[kind_j as usize]);
        let range = f64::from(range);
        let sigma = if uniform { sigma } else { range / f64::from(self.radius_per_sigma) };
        with_potential!(&self.potential, p => {
            PairCoefficients::new(p, self.truncation, epsilon, sigma, range)
        })
    }
}
