//! One error type for the core and every engine.

use crate::{Method, sim_box::AXES};

/// Shorthand for results of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// What can be wrong with a system, a plan or a run. Particle numbers are indices in input order, from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A coordinate is NaN or infinite.
    #[error("particle {particle}: coordinate {axis} is {value}, but must be finite", axis = AXES[*axis])]
    NonFiniteCoordinate {
        /// Index of the particle.
        particle: usize,
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// The offending value.
        value: f32,
    },
    /// A velocity is NaN or infinite.
    #[error("particle {particle}: velocity {axis} is {value}, but must be finite", axis = AXES[*axis])]
    NonFiniteVelocity {
        /// Index of the particle.
        particle: usize,
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// The offending value.
        value: f32,
    },
    /// A particle lies outside the box on an axis that has walls.
    #[error("particle {particle}: coordinate {axis} = {value} lies outside the walls [{lo}, {hi}]", axis = AXES[*axis])]
    OutsideWalls {
        /// Index of the particle.
        particle: usize,
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// The offending value.
        value: f32,
        /// Lower wall.
        lo: f32,
        /// Upper wall.
        hi: f32,
    },
    /// The box has zero, negative or non-finite length.
    #[error("box axis {axis}: bounds [{lo}, {hi}) must be finite and have positive length", axis = AXES[*axis])]
    InvalidBox {
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// Lower bound.
        lo: f32,
        /// Upper bound.
        hi: f32,
    },
    /// The uniform cutoff is zero, negative or not finite.
    #[error("cutoff {0} must be positive and finite")]
    InvalidCutoff(f32),
    /// A particle's radius is zero, negative or not finite.
    #[error("particle {particle}: radius {value} must be positive and finite")]
    InvalidRadius {
        /// Index of the particle.
        particle: usize,
        /// The offending value.
        value: f32,
    },
    /// The interaction range reaches beyond half a periodic length, where the nearest image is not the only one.
    #[error(
        "cutoff {cutoff}{} exceeds half the periodic length of axis {axis} ({length} / 2 = {half}); \
         use a smaller cutoff or a larger box",
        particle.map(|p| format!(" (radius of particle {p})")).unwrap_or_default(),
        axis = AXES[*axis], half = length / 2.0
    )]
    CutoffTooLarge {
        /// The cutoff or radius.
        cutoff: f32,
        /// The particle whose radius it is, where radii are per particle.
        particle: Option<usize>,
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// Periodic length of the axis.
        length: f32,
    },
    /// Arrays that describe the same particles differ in length.
    #[error("{what} has {found} entries, but there are {expected} particles")]
    LengthMismatch {
        /// Name of the array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The number of particles.
        expected: usize,
    },
    /// A type index has no entry in the interaction's table of types.
    #[error("particle {particle} has type {kind}, but the interaction defines {n_types} type(s)")]
    UnknownType {
        /// Index of the particle.
        particle: usize,
        /// The type index.
        kind: u32,
        /// Number of types defined.
        n_types: usize,
    },
    /// A parameter of the interaction, the dynamics or the plan is out of range.
    #[error("{name} = {value}: {reason}")]
    InvalidParameter {
        /// Which parameter.
        name: &'static str,
        /// Its value, as text.
        value: String,
        /// What is allowed.
        reason: &'static str,
    },
    /// More particles than 32-bit indices can number.
    #[error("{0} particles are too many: indices are 32-bit")]
    TooManyParticles(usize),
    /// A run needs at least one particle.
    #[error("the system has no particles")]
    Empty,
    /// The method cannot treat this system.
    #[error("method {method} does not support this system: {reason}")]
    Unsupported {
        /// The method asked for.
        method: Method,
        /// Why not, and what to use instead.
        reason: &'static str,
    },
    /// Two particles coincide and the potential diverges there.
    #[error(
        "particles {0} and {1} are at the same place, where the potential diverges; \
         move one, or set dynamics.max_displacement to start from overlaps"
    )]
    Coincident(usize, usize),
    /// A quantity became NaN or infinite in a run.
    #[error(
        "step {step}: {what} of particle {particle} is {value}; a smaller dt or dynamics.max_displacement may help"
    )]
    NonFinite {
        /// Step at whose end it was found.
        step: u64,
        /// Which quantity.
        what: &'static str,
        /// Index of the particle.
        particle: usize,
        /// The offending value.
        value: f64,
    },
    /// Something needs more memory than the budget or the device allows.
    #[error("{what} needs {needed} bytes, but {available} are available")]
    OutOfMemory {
        /// What was to be stored.
        what: &'static str,
        /// Bytes needed.
        needed: u64,
        /// Bytes available.
        available: u64,
    },
    /// A device or its driver failed.
    #[error("the device failed: {0}")]
    Device(String),
    /// The engine was used before a system was loaded.
    #[error("no system is loaded")]
    NotLoaded,
}
