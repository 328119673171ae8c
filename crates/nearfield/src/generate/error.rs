//! What can be wrong with a request for initial conditions.

/// Shorthand for results of this module.
pub type Result<T> = std::result::Result<T, Error>;

/// A request that cannot be generated. Keys are those of `[system.generate]`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A parameter is out of range.
    #[error("{key} = {value}: {reason}")]
    InvalidParameter {
        /// The key, relative to `system.generate`.
        key: &'static str,
        /// Its value, as text.
        value: String,
        /// What is allowed.
        reason: &'static str,
    },
    /// Neither or both of density and box were given.
    #[error(
        "{}: give either density or box = [x, y, z]",
        if *.both { "density and box are both given" } else { "the size of the box is missing" }
    )]
    BoxSize {
        /// Both were given, else neither.
        both: bool,
    },
    /// The number of particles leaves sites of the crystal empty.
    #[error("n = {n} does not fill an fcc crystal in this box; the nearest numbers that do are {below} and {above}")]
    ImperfectCrystal {
        /// The number asked for.
        n: usize,
        /// The next smaller perfect number.
        below: usize,
        /// The next larger perfect number.
        above: usize,
    },
    /// Random draws do not land in the allowed range.
    #[error("{what}: practically no draw falls into [{low}, {high}]; widen the range or move the distribution")]
    NothingInRange {
        /// What was drawn.
        what: &'static str,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// No arrangement has this name.
    #[error("unknown positions \"{0}\"; there are fcc, lattice, disordered, uniform, cluster, sphere-surface")]
    UnknownPositions(String),
    /// A distribution of radii on the command line could not be read.
    #[error("radii \"{0}\": write constant:R, uniform:LOW,HIGH or lognormal:MU,SIGMA,LOW,HIGH[,clamp]")]
    UnknownRadii(String),
    /// The box is not valid.
    #[error(transparent)]
    Box(#[from] nearfield_core::Error),
}
