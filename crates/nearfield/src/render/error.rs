//! What can be wrong with a request for a picture.

use std::path::PathBuf;

/// Shorthand for results of this module.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// A picture that cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is nothing to draw.
    #[error("there are no particles to draw")]
    Empty,
    /// The particle to look at does not exist.
    #[error("there is no particle {focus} to focus on: the {n} particles are counted from 0")]
    Focus {
        /// The particle asked for.
        focus: usize,
        /// Number of particles.
        n: usize,
    },
    /// An option out of its range.
    #[error("{option} {value} {reason}")]
    Invalid {
        /// What it sets.
        option: &'static str,
        /// Its value.
        value: String,
        /// What would be right.
        reason: &'static str,
    },
    /// Only PNG is written.
    #[error("{}: pictures are written as .png", .0.display())]
    Extension(PathBuf),
}
