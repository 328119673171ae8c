//! The energy that is lost to pairs that a list misses.
//!
//! A list holds the pairs within its reach where particles are expected halfway through its life. A pair beyond may be
//! within the cutoff at some time of this life all the same. Its energy grows from zero while it approaches, unnoticed,
//! and appears when the next list is made. If displacements of pairs along the line between them, from what was expected,
//! are normal with deviation s, the energy missed is
//!
//! ∫ n' |U(cutoff - x) - U(cutoff)| Q((b + x) / s) dx,   b = reach - cutoff,   Q(t) = erfc(t / √2) / 2,
//!
//! where n' pairs lie in a unit of distance beyond the reach (S. Páll and B. Hess, Comput. Phys. Commun. 2013,
//! doi:10.1016/j.cpc.2013.06.003; the manual of GROMACS, "Using buffered pair lists"), and U is taken by its first three
//! derivatives. Two things differ here:
//! - Particles are listed where their velocities v take them by half the life t. If they fly straight on they are v t / 2
//!   from there at either end of it, s² = v² t² / 4. If they do not, s² grows with what they forget of their velocities,
//!   and is v² t² / 2 at most while these remain correlated positively: that is taken.
//! - A list of groups of particles holds most pairs somewhat beyond the reach because others of the same two groups are
//!   within. So n' is not that of all pairs, but the number of pairs of groups by which a list grows with its reach: each
//!   is missed for one closest pair of particles. Other pairs of the same groups are not counted.
//!
//! What is missed at the beginning of a life has the other sign in the total energy, and is not subtracted. So the estimate
//! is of the order of an upper bound, but no bound: for that, lists must be tested for what has moved.

use crate::{
    Interaction,
    interaction::{PairLaw, Truncated},
    with_potential,
};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Longest that particles may be expected to stray, as part of the cutoff: beyond it three derivatives say too little.
const FARTHEST: f64 = 0.15;
/// Deviations beyond which nothing is missed in double precision.
const ALL: f64 = 12.0;

/// How pairs of types interact near the cutoff, and how many there are of each.
#[derive(Clone, Debug)]
pub struct CutoffEdge {
    cutoff: f64,
    /// Part of the particles that is of each type.
    shares: Vec<f64>,
    /// Magnitudes of the first three derivatives of the energy, row-major by pairs of types.
    derivatives: Vec<[f64; 3]>,
}

impl CutoffEdge {
    /// Of an interaction cut at `cutoff` \[length\], in a system of which `shares` are of each type.
    pub fn new(interaction: &Interaction, cutoff: f32, shares: &[f64]) -> Self {
        let table = interaction.pair_table(cutoff);
        let cutoff = f64::from(cutoff);
        let h = 1e-3 * cutoff;
        let derivatives = table.iter().map(|c| {
            // From within: tables end at the cutoff.
            let [f0, f1, f2] = [0.0, 1.0, 2.0].map(|k| {
                let r = cutoff - k * h;
                r * with_potential!(&interaction.potential, p => Truncated::<_, true>(p).f_over_r(r * r, c))
            });
            [f0.abs(), (3.0 * f0 - 4.0 * f1 + f2).abs() / (2.0 * h), (f0 - 2.0 * f1 + f2).abs() / (h * h)]
        });
        Self { cutoff, shares: shares.to_vec(), derivatives: derivatives.collect() }
    }

    /// What is missed where the mean square of a component of the particles' velocities is `velocity2` for each type.
    pub fn missed(&self, velocity2: &[f64]) -> Missed {
        let n = self.shares.len();
        let approaches = (0..n * n).map(|pair| {
            let (a, b) = (pair / n, pair % n);
            Approach {
                share: self.shares[a] * self.shares[b],
                velocity2: velocity2[a] + velocity2[b],
                derivatives: self.derivatives[pair],
            }
        });
        Missed { cutoff: self.cutoff, approaches: approaches.filter(|pair| pair.share > 0.0).collect() }
    }
}

/// Pairs of two types.
#[derive(Clone, Copy, Debug)]
struct Approach {
    /// Part of all pairs.
    share: f64,
    /// Mean square of a component of the relative velocity.
    velocity2: f64,
    derivatives: [f64; 3],
}

/// Pairs of groups in a list, by its reach: a power law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ListSize {
    /// Number for each particle with a reach of `reach`.
    pub pairs: f64,
    /// \[length\]
    pub reach: f64,
    /// Power of the reach.
    pub exponent: f64,
}

impl ListSize {
    /// Of a list of pairs of particles, `density` to a unit of volume: what is assumed before there was a list.
    pub fn of_particles(density: f64, reach: f64) -> Self {
        Self { pairs: 2.0 / 3.0 * PI * density * reach.powi(3), reach, exponent: 3.0 }
    }

    /// The power law by two lists, numbers for each particle and reaches, the larger one first. It grows with the first to
    /// third power, as the third where the two do not tell.
    pub fn of_lists([large, small]: [f64; 2], [reach, smaller]: [f64; 2]) -> Self {
        let exponent = (large / small).ln() / (reach / smaller).ln();
        let exponent = if exponent.is_finite() { exponent.clamp(1.0, 3.0) } else { 3.0 };
        Self { pairs: large, reach, exponent }
    }

    /// Number for each particle.
    pub fn at(&self, reach: f64) -> f64 {
        self.pairs * (reach / self.reach).powf(self.exponent)
    }

    /// Its growth in a unit of length.
    fn slope(&self, reach: f64) -> f64 {
        self.exponent * self.at(reach) / reach
    }
}

/// What lists miss of a system in a given state of motion.
#[derive(Clone, Debug)]
pub struct Missed {
    cutoff: f64,
    approaches: Vec<Approach>,
}

impl Missed {
    /// The cutoff, \[length\].
    pub fn cutoff(&self) -> f64 {
        self.cutoff
    }

    /// The largest mean square of a component of the velocities of two particles.
    pub(super) fn largest_velocity2(&self) -> f64 {
        self.approaches.iter().map(|pair| pair.velocity2).fold(0.0, f64::max)
    }

    /// Expected drift of the energy, for each particle and unit of time, by lists of `size` that are made with a `reach` and
    /// serve for `time`.
    pub fn drift(&self, size: &ListSize, reach: f64, time: f64) -> f64 {
        let energy: f64 =
            self.approaches.iter().map(|pair| pair.share * pair.energy(size, self.cutoff, reach, time)).sum();
        energy / time
    }

    /// Expected number of closest pairs of groups within the cutoff that such a list misses at the end of its life, for
    /// each particle.
    pub fn pairs(&self, size: &ListSize, reach: f64, time: f64) -> f64 {
        let pairs = self.approaches.iter().map(|pair| {
            let s = pair.deviation(time);
            pair.share * size.slope(reach + s) * tails(reach - self.cutoff, s)[0]
        });
        pairs.sum()
    }

    /// The thinnest reach with which lists of `size` may serve for `time` if the drift is to be no more than `tolerance`;
    /// never below the cutoff. `None` where it can not be foretold for so long.
    pub fn reach(&self, size: &ListSize, time: f64, tolerance: f64) -> Option<f64> {
        let s = self.approaches.iter().map(|pair| pair.deviation(time)).fold(0.0, f64::max);
        if s > FARTHEST * self.cutoff {
            return None;
        }
        let (mut thin, mut enough) = (self.cutoff, self.cutoff + ALL * s);
        if self.drift(size, thin, time) <= tolerance {
            return Some(thin);
        }
        while enough - thin > 1e-4 * self.cutoff {
            let between = 0.5 * (thin + enough);
            if self.drift(size, between, time) <= tolerance { enough = between } else { thin = between }
        }
        Some(enough)
    }
}

impl Approach {
    /// Deviation of a pair's distance from what was expected, at the end of `time`.
    fn deviation(&self, time: f64) -> f64 {
        time * (0.5 * self.velocity2).sqrt()
    }

    /// Energy missed for each particle.
    fn energy(&self, size: &ListSize, cutoff: f64, reach: f64, time: f64) -> f64 {
        let s = self.deviation(time);
        let [_, first, second, third] = tails(reach - cutoff, s);
        let [slope, curvature, third_derivative] = self.derivatives;
        size.slope(reach + s) * (slope * first + curvature * second + third_derivative * third)
    }
}

/// ∫ (x - b)^m / m! of a normal distribution of deviation `s` from `b` on, for m = 1 to 4: repeated integrals of its tail.
fn tails(b: f64, s: f64) -> [f64; 4] {
    if s == 0.0 {
        return [0.0; 4];
    }
    let density = (-0.5 * (b / s).powi(2)).exp() / (s * (2.0 * PI).sqrt());
    let mut last = [density, 0.5 * libm::erfc(FRAC_1_SQRT_2 * b / s)];
    std::array::from_fn(|k| {
        // Differences of ever smaller terms: what is lost of them in rounding is far below any tolerance.
        let next = ((s * s * last[0] - b * last[1]) / (k + 1) as f64).max(0.0);
        last = [last[1], next];
        next
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_distr::StandardNormal;

    fn melt(velocity2: f64) -> Missed {
        CutoffEdge::new(&Interaction::lennard_jones(), 2.5, &[1.0]).missed(&[velocity2])
    }

    const SIZE: ListSize = ListSize { pairs: 3.5, reach: 2.5, exponent: 2.0 };

    #[test]
    fn derivatives_at_the_cutoff_are_those_of_lennard_jones() {
        let r = 2.5f64;
        let exact = [
            24.0 * (r.powi(-7) - 2.0 * r.powi(-13)),
            24.0 * (7.0 * r.powi(-8) - 26.0 * r.powi(-14)),
            24.0 * (56.0 * r.powi(-9) - 364.0 * r.powi(-15)),
        ];
        for (found, exact) in melt(1.0).approaches[0].derivatives.into_iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < 0.02, "{found} {exact}");
        }
        let mut shifted = Interaction::lennard_jones();
        shifted.truncation = crate::Truncation::Force;
        assert!(CutoffEdge::new(&shifted, 2.5, &[1.0]).derivatives[0][0] < 1e-12);
    }

    /// Pairs at uniform distances beyond the reach, displaced by random straight flight: those that end within the cutoff.
    #[test]
    fn the_estimate_is_what_random_displacements_give() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(3);
        // Nearly as many pairs everywhere, so that it does not matter where their number is taken.
        let size = ListSize { exponent: 1.0, ..SIZE };
        for (velocity2, time, buffer) in [(0.71, 0.2, 0.0), (0.71, 0.2, 0.1), (1.4, 0.1, 0.05), (0.71, 0.3, 0.3)] {
            let missed = melt(velocity2);
            let (s, reach) = (time * f64::sqrt(velocity2), 2.5 + buffer);
            let width = 6.0 * s;
            let energy = |r: f64| 4.0 * (r.powi(-12) - r.powi(-6));
            let (mut sums, n) = ([0.0; 2], 4_000_000);
            for _ in 0..n {
                let from = reach + width * rng.random::<f64>();
                let to = from + s * rng.sample::<f64, _>(StandardNormal);
                if to < 2.5 {
                    sums[0] += 1.0;
                    sums[1] += (energy(to) - energy(2.5)).abs();
                }
            }
            let [pairs, energy] = sums.map(|sum| sum * width * size.slope(reach) / f64::from(n));
            let estimate = [missed.pairs(&size, reach, time), missed.drift(&size, reach, time) * time];
            for (found, expected) in [pairs, energy].into_iter().zip(estimate) {
                assert!((found / expected - 1.0).abs() < 0.06, "{time} {buffer}: {found}, not {expected}");
            }
        }
    }

    #[test]
    fn the_thinnest_reach_keeps_to_the_tolerance_and_one_thinner_does_not() {
        let missed = melt(0.71);
        for time in [0.02, 0.1, 0.2, 0.4] {
            for tolerance in [1e-1, 1e-2, 1e-4, 1e-8] {
                let reach = missed.reach(&SIZE, time, tolerance).unwrap();
                assert!(missed.drift(&SIZE, reach, time) <= tolerance);
                assert!(reach == 2.5 || missed.drift(&SIZE, reach - 1e-3, time) > tolerance, "{time} {tolerance}");
            }
        }
    }

    #[test]
    fn a_longer_life_and_a_smaller_tolerance_need_a_larger_reach() {
        let missed = melt(0.71);
        let reach = |time: f64, tolerance: f64| missed.reach(&SIZE, time, tolerance).unwrap();
        assert!(reach(0.1, 1e-4) < reach(0.2, 1e-4) && reach(0.2, 1e-4) < reach(0.4, 1e-4));
        assert!(reach(0.2, 1e-3) < reach(0.2, 1e-4) && reach(0.2, 1e-4) < reach(0.2, 1e-6));
        assert_eq!(missed.reach(&SIZE, 10.0, 1.0), None);
    }

    #[test]
    fn types_count_by_their_share_and_particles_at_rest_miss_nothing() {
        let mut interaction = Interaction::lennard_jones();
        interaction.types.push(crate::ParticleType { epsilon: 0.0, ..crate::ParticleType::default() });
        let half = CutoffEdge::new(&interaction, 2.5, &[0.5, 0.5]);
        let (both, alone) = (half.missed(&[0.71, 0.71]), melt(0.71));
        let ratio = both.drift(&SIZE, 2.6, 0.2) / alone.drift(&SIZE, 2.6, 0.2);
        assert!((ratio - 0.25).abs() < 1e-9, "only pairs of the first type have energy: {ratio}");
        assert_eq!(melt(0.0).drift(&SIZE, 2.5, 1.0), 0.0);
    }
}
