//! What can be wrong with a file, always naming the file and, where there is one, the line.

use std::{io, path::PathBuf};

/// Shorthand for results of this module.
pub type Result<T> = std::result::Result<T, IoError>;

/// Result of looking at one line, whose place the reader knows.
pub(super) type Parsed<T> = std::result::Result<T, Problem>;

/// A file could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// The file does not exist or may not be opened.
    #[error("cannot open {}: {source}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Reading failed half way.
    #[error("cannot read {file}: {source}")]
    Read {
        /// The file, or `standard input`.
        file: String,
        /// What the system said.
        source: io::Error,
    },
    /// The file could not be created or written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The extension tells no known format.
    #[error("{}: unknown file format; the known extensions are {known}", path.display())]
    UnknownExtension {
        /// The file.
        path: PathBuf,
        /// The extensions that would do.
        known: &'static str,
    },
    /// The file has no content.
    #[error("{file} is empty")]
    Empty {
        /// The file, or `standard input`.
        file: String,
    },
    /// The content of a line is wrong.
    #[error("{file}:{line}: {problem}")]
    Parse {
        /// The file, or `standard input`.
        file: String,
        /// Line number, from 1.
        line: usize,
        /// What is wrong.
        problem: Problem,
    },
    /// The trajectory is shorter than the frame asked for.
    #[error("{file} has {found} frame(s), but frame {frame} (counted from 0) was asked for")]
    NoSuchFrame {
        /// The file, or `standard input`.
        file: String,
        /// The frame asked for, from 0.
        frame: usize,
        /// Number of frames.
        found: usize,
    },
    /// A frame other than the first was asked of a format that holds one.
    #[error("{file}: only extended XYZ files hold more than one frame")]
    SingleFrame {
        /// The file, or `standard input`.
        file: String,
    },
    /// What is to be written does not fit the format.
    #[error("cannot write {}: {reason}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
    /// A growing file is shorter than when it was last appended to.
    #[error("cannot continue {}: it holds {found} bytes, but should hold at least {expected}", path.display())]
    TooShort {
        /// The file.
        path: PathBuf,
        /// Bytes that were written before.
        expected: u64,
        /// Bytes that are there.
        found: u64,
    },
}

/// What is wrong with a line. Particles are counted from 0 in the order of the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// The line has too few or too many fields.
    #[error("expected {expected} fields ({layout}), found {found}")]
    Fields {
        /// Fields of a correct line.
        expected: usize,
        /// What they are.
        layout: String,
        /// Fields of this line.
        found: usize,
    },
    /// A field is not a number.
    #[error("{what} of particle {particle}: `{text}` is not a number")]
    NotANumber {
        /// Which quantity.
        what: &'static str,
        /// The particle.
        particle: usize,
        /// The field.
        text: String,
    },
    /// A number is NaN, infinite or beyond single precision.
    #[error("{what} of particle {particle} is {text}, but must be finite in single precision")]
    NotFinite {
        /// Which quantity.
        what: &'static str,
        /// The particle.
        particle: usize,
        /// The field.
        text: String,
    },
    /// Something else stands where the format wants a certain thing.
    #[error("expected {expected}, found {found}")]
    Expected {
        /// What the format wants.
        expected: String,
        /// What is there.
        found: String,
    },
    /// The file ends, or the next section starts, before all particles came.
    #[error("expected {expected} {what}, found only {found}")]
    TooFew {
        /// Entries of what, for example `atoms`.
        what: &'static str,
        /// The number that the header promises.
        expected: usize,
        /// The number that is there.
        found: usize,
    },
    /// There is more than the header says.
    #[error("unexpected line after the {expected} {what} that the header announces: `{text}`")]
    Trailing {
        /// Entries of what, for example `atoms`.
        what: &'static str,
        /// The number that the header promises.
        expected: usize,
        /// The line.
        text: String,
    },
    /// The box is not orthorhombic.
    #[error("the box is triclinic ({what}); only orthorhombic boxes along x, y, z are supported")]
    Triclinic {
        /// The entry that says so.
        what: String,
    },
    /// The box has zero, negative or non-finite length.
    #[error("box axis {axis}: bounds [{lo}, {hi}) must be finite and have positive length")]
    InvalidBox {
        /// `x`, `y` or `z`.
        axis: &'static str,
        /// Lower bound.
        lo: f64,
        /// Upper bound.
        hi: f64,
    },
    /// The format or the rest of the file needs a box and there is none.
    #[error("{0}")]
    MissingBox(&'static str),
    /// Two particles carry the same id.
    #[error("atom id {id} occurs twice")]
    DuplicateId {
        /// The id.
        id: u64,
    },
    /// Two particles of one species have different masses.
    #[error("particle {particle} of species {species} has mass {found}, but an earlier one has {first}")]
    MassDiffers {
        /// The particle.
        particle: usize,
        /// Its species.
        species: String,
        /// Mass of the first particle of this species.
        first: f32,
        /// Mass of this one.
        found: f32,
    },
    /// The line is not UTF-8 text.
    #[error("this is not text (invalid UTF-8)")]
    NotText,
}

impl Problem {
    /// [`Problem::Expected`], quoting the line.
    pub(super) fn expected(expected: impl Into<String>, found: &str) -> Self {
        let found = if found.trim().is_empty() { "a blank line".to_owned() } else { format!("`{}`", found.trim()) };
        Self::Expected { expected: expected.into(), found }
    }
}
