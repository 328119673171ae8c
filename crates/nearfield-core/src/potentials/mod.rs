//! Pair potentials: one file each, arithmetic only, no loops.
//!
//! A potential knows r² and the pair's parameters, nothing of truncation, types or neighbours. To add one: a file
//! here, a variant of [`Potential`] and an arm in [`with_potential!`](crate::with_potential).

mod gaussian;
mod lennard_jones;
mod morse;
mod real;
mod table;
mod wca;
mod yukawa;

pub use gaussian::Gaussian;
pub use lennard_jones::LennardJones;
pub use morse::Morse;
pub use real::Real;
pub use table::{Table, TableError};
pub use wca::Wca;
pub use yukawa::Yukawa;

use std::sync::Arc;

/// An untruncated pair potential, in f32 for the kernels and f64 for the oracle by one definition.
pub trait PairPotential: Clone + Send + Sync {
    /// `-(1/r) dU/dr` at squared distance `r2`, \[energy/length²\]. The force on i is `-f_over_r * dr`.
    fn f_over_r<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T;

    /// `U` at squared distance `r2`, \[energy\].
    fn energy<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T;
}

impl<P: PairPotential> PairPotential for Arc<P> {
    #[inline(always)]
    fn f_over_r<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        P::f_over_r(self, r2, epsilon, sigma)
    }

    #[inline(always)]
    fn energy<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        P::energy(self, r2, epsilon, sigma)
    }
}

/// The potential of a system.
#[derive(Clone, Debug, PartialEq)]
pub enum Potential {
    /// 12-6 Lennard-Jones.
    LennardJones(LennardJones),
    /// Weeks-Chandler-Andersen: the repulsive part of Lennard-Jones.
    Wca(Wca),
    /// Screened Coulomb.
    Yukawa(Yukawa),
    /// Morse.
    Morse(Morse),
    /// Gaussian repulsion.
    Gaussian(Gaussian),
    /// Tabulated, from a file.
    Table(Arc<Table>),
}

impl Potential {
    /// The names used in configuration files.
    pub const NAMES: [&str; 6] = ["lennard-jones", "wca", "yukawa", "morse", "gaussian", "table"];

    /// Name used in configuration files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::LennardJones(_) => "lennard-jones",
            Self::Wca(_) => "wca",
            Self::Yukawa(_) => "yukawa",
            Self::Morse(_) => "morse",
            Self::Gaussian(_) => "gaussian",
            Self::Table(_) => "table",
        }
    }

    /// Whether force or energy is infinite at zero distance, so that coincident particles are an error. The others
    /// have a finite energy there, and no direction to push in: their force is taken as zero.
    pub fn diverges_at_zero(&self) -> bool {
        matches!(self, Self::LennardJones(_) | Self::Wca(_) | Self::Yukawa(_))
    }
}

/// Runs `$body` with `$p` bound to the concrete potential, so that the code behind it is monomorphic.
#[macro_export]
macro_rules! with_potential {
    ($potential:expr, $p:ident => $body:expr) => {
        match $potential {
            $crate::potentials::Potential::LennardJones($p) => $body,
            $crate::potentials::Potential::Wca($p) => $body,
            $crate::potentials::Potential::Yukawa($p) => $body,
            $crate::potentials::Potential::Morse($p) => $body,
            $crate::potentials::Potential::Gaussian($p) => $body,
            $crate::potentials::Potential::Table($p) => $body,
        }
    };
}
