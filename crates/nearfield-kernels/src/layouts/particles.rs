//! The particles and how they move.

use super::physics::{Box3, Results};
use crate::layout::{Float4, Ptr, layouts};

layouts! {
    /// The particles in memory order.
    pub struct Particles {
        /// Position; w is the radius where radii are per particle.
        pub position: Ptr<Float4>,
        /// Velocity; the bits of w are the type.
        pub velocity: Ptr<Float4>,
        /// Box crossings, `[n][3]`.
        pub image: Ptr<i32>,
        /// Input index of each particle.
        pub id: Ptr<u32>,
        /// Number of particles.
        pub n: u32,
        /// Zero.
        pub unused: u32,
    }

    /// What went wrong first: `step << 32 | id` of the least step and id, all ones while nothing did.
    pub struct Status {
        /// A force is not finite.
        pub force: u64,
        /// A coordinate is not finite.
        pub position: u64,
    }

    /// Velocity Verlet and its thermostats.
    pub struct Integrator {
        /// The box.
        pub space: Box3,
        /// Time step.
        pub dt: f32,
        /// Largest speed, from the displacement limit; infinite without.
        pub speed_limit: f32,
        /// 1 for Langevin dynamics.
        pub langevin: u32,
        /// exp(-friction dt).
        pub damping: f32,
        /// Seed of the thermostat, low and high half.
        pub seed: [u32; 2],
        /// Half a time step over the mass, by type.
        pub half_kick: Ptr<f32>,
        /// Standard deviation of Langevin noise, by type.
        pub noise: Ptr<f32>,
    }

    /// Arguments of `integrate`.
    pub struct IntegrateArgs {
        /// How.
        pub integrator: Integrator,
        /// The particles.
        pub particles: Particles,
        /// Forces at the present positions.
        pub force: Ptr<Float4>,
        /// What went wrong.
        pub status: Ptr<Status>,
        /// The step that the forces belong to.
        pub step: u64,
        /// 1 for the second half kick of `step`.
        pub finish: u32,
        /// 1 for the first half kick and the drift of the step after.
        pub start: u32,
    }

    /// Sums over particles.
    pub struct TotalSums {
        /// Kinetic energy.
        pub kinetic: f64,
        /// Total momentum.
        pub momentum: [f64; 3],
        /// Largest squared force.
        pub max_force2: f64,
        /// Potential energy.
        pub potential: f64,
        /// Virial.
        pub virial: f64,
        /// Neighbours of all particles.
        pub neighbors: u64,
    }

    /// Arguments of `totals`: sums over particles in input order, so that they do not depend on memory order.
    pub struct TotalsArgs {
        /// The particles.
        pub particles: Particles,
        /// Place of each input index.
        pub place: Ptr<u32>,
        /// Mass by type.
        pub mass: Ptr<f64>,
        /// Forces and energies; null members are left out.
        pub results: Results,
        /// Sums of each block, then of all, `[blocks + 1]`.
        pub sums: Ptr<TotalSums>,
        /// What went wrong.
        pub status: Ptr<Status>,
        /// Step the forces belong to.
        pub step: u64,
    }

    /// Arguments of `rescale`: velocity rescaling after a step (Bussi, Donadio and Parrinello, 2007).
    pub struct RescaleArgs {
        /// The particles.
        pub particles: Particles,
        /// The sums whose kinetic energy counts.
        pub sums: Ptr<TotalSums>,
        /// Standard normal draws of the batch of steps.
        pub normal: Ptr<f64>,
        /// Chi-squared draws of the batch of steps.
        pub chi_squared: Ptr<f64>,
        /// Target temperature.
        pub temperature: f64,
        /// exp(-dt / relaxation time).
        pub decay: f64,
        /// Which draw.
        pub index: u64,
    }

    /// Arguments of `motion`: how far particles have moved from remembered positions.
    pub struct MotionArgs {
        /// The particles.
        pub particles: Particles,
        /// Box lengths.
        pub length: [f32; 3],
        /// The one cutoff; zero where radii are per particle.
        pub cutoff: f32,
        /// Remembered positions.
        pub position: Ptr<Float4>,
        /// Remembered box crossings, `[n][3]`.
        pub image: Ptr<i32>,
        /// Largest squared distance (bits of an f32) and sum of distances over radii in units of 2^-20, `[2]`.
        pub moved: Ptr<u64>,
    }

    /// Arguments of `permute`: the particles in another memory order.
    pub struct PermuteArgs {
        /// From.
        pub from: Particles,
        /// To.
        pub to: Particles,
        /// Forces, from and to.
        pub force: [Ptr<Float4>; 2],
        /// Place of origin of each particle.
        pub order: Ptr<u32>,
        /// Place of each input index, written.
        pub place: Ptr<u32>,
    }

    /// Arguments of `morton_count` and `morton_scatter`: the order along the Morton curve.
    pub struct MortonArgs {
        /// Positions.
        pub position: Ptr<Float4>,
        /// Cell of each particle, written by the count.
        pub cell: Ptr<u32>,
        /// Its number within the cell.
        pub rank: Ptr<u32>,
        /// Particles of each cell, zeroed, `[8^bits]`.
        pub count: Ptr<u32>,
        /// First place of each cell.
        pub start: Ptr<u32>,
        /// The particle at each place, written by the scatter.
        pub order: Ptr<u32>,
        /// Where cells begin; the outermost extend to infinity.
        pub lo: [f32; 3],
        /// Cells per length.
        pub per_length: [f32; 3],
        /// Cells along an axis are two to this power, at most 10.
        pub bits: u32,
        /// Number of particles.
        pub n: u32,
    }

    /// Arguments of `bounds`.
    pub struct BoundsArgs {
        /// Positions, at least one.
        pub position: Ptr<Float4>,
        /// Low and high corner by `ordered_bits`, `[6]`; low all ones and high zeros before.
        pub bounds: Ptr<u32>,
        /// Number of particles.
        pub n: u64,
    }

    /// Arguments of `sample`: positions at even strides.
    pub struct SampleArgs {
        /// Positions.
        pub position: Ptr<Float4>,
        /// Sampled ones.
        pub sample: Ptr<Float4>,
        /// Number of particles.
        pub n: u64,
        /// Size of the sample, at most `n`.
        pub n_sampled: u64,
    }

    /// Arguments of `finish_exact`: from quanta to numbers.
    pub struct FinishExactArgs {
        /// From `exact` to the others.
        pub results: Results,
        /// Quanta in a unit of force.
        pub force_quanta: f32,
        /// Quanta in a unit of energy.
        pub energy_quanta: f32,
        /// Number of particles.
        pub n: u32,
        /// 1 to convert energies and virials too.
        pub energy: u32,
        /// 1 where overlaps are allowed.
        pub capped: u32,
        /// Zero.
        pub unused: u32,
    }
}
