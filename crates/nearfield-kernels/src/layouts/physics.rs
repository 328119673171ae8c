//! Box and interaction.

use crate::layout::{Float4, Ptr, layouts};

layouts! {
    /// The orthorhombic box. Periodic image `c` of 27 is `(c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1)` box lengths away, so
    /// 13 is the box itself.
    pub struct Box3 {
        /// Lower corner.
        pub lo: [f32; 3],
        /// Upper corner.
        pub hi: [f32; 3],
        /// Edge lengths, rounded to f32: periodic shifts are multiples of these.
        pub length: [f32; 3],
        /// Of each axis: 0 periodic, 1 wall, 2 open.
        pub boundary: [u32; 3],
    }

    /// Potential, truncation and parameters of pairs.
    pub struct Law {
        /// 0 Lennard-Jones, 1 WCA, 2 Yukawa, 3 Morse, 4 Gaussian, 5 table.
        pub potential: u32,
        /// 0 cut, 1 energy shifted, 2 force shifted.
        pub truncation: u32,
        /// Number of particle types.
        pub n_types: u32,
        /// 1 where radii are per particle, 0 where one cutoff serves all pairs.
        pub variable: u32,
        /// The one cutoff.
        pub cutoff: f32,
        /// Sigma of a pair over its range, where radii are per particle.
        pub sigma_per_range: f32,
        /// Upper limit of f/r and of a pair's energy; infinite unless overlaps are allowed.
        pub cap: f32,
        /// Kappa of Yukawa, alpha of Morse.
        pub parameter: f32,
        /// 48 epsilon sigma^12 of the only type, for the uniform Lennard-Jones kernel; epsilon for the scaled one.
        pub lj_repulsion: f32,
        /// 24 epsilon sigma^6 of the only type.
        pub lj_attraction: f32,
        /// First distance of the table over sigma.
        pub table_start: f32,
        /// Last distance of the table over sigma.
        pub table_end: f32,
        /// Intervals of the table per sigma.
        pub table_per_sigma: f32,
        /// Number of intervals of the table.
        pub table_intervals: u32,
        /// Quanta of order-independent sums in a unit of force, a power of two.
        pub force_quanta: f32,
        /// Quanta of order-independent sums in a unit of energy, a power of two.
        pub energy_quanta: f32,
        /// Epsilon, sigma, energy shift and force shift by pair of types, row-major; sigma and shifts are unused where
        /// radii are per particle.
        pub pairs: Ptr<Float4>,
        /// Polynomial coefficients of U over epsilon in each interval of the table, in fractions of the interval.
        pub table_energy: Ptr<Float4>,
        /// The same of the force times sigma over epsilon; the fourth is zero.
        pub table_force: Ptr<Float4>,
    }

    /// Where forces and energies of particles go, in memory order. Scattering methods add to zeroed arrays; exact sums
    /// go to `exact` instead and are converted afterwards.
    pub struct Results {
        /// Forces, `[n]`.
        pub force: Ptr<Float4>,
        /// Half of the energies of each particle's pairs, `[n]`.
        pub energy: Ptr<f64>,
        /// Half of the virials of each particle's pairs, `[n]`.
        pub virial: Ptr<f64>,
        /// Number of neighbours, `[n]`.
        pub neighbors: Ptr<u32>,
        /// Sums in quanta: force x, y, z, energy, virial of each particle, `[5][n]`; the last two only with energies.
        pub exact: Ptr<i64>,
    }
}
