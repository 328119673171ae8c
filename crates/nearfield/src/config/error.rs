//! What can be wrong with a configuration.

use nearfield_core::potentials::TableError;
use std::{fmt, path::PathBuf};

/// Shorthand for results of this module.
pub type Result<T> = std::result::Result<T, Error>;

/// Where a value was given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Line of the file, from 1.
    Line(usize),
    /// The text of a `--set` option.
    Option(String),
    /// Nowhere that could be told: a value built by a program.
    Unknown,
}

/// The beginning of a message: the place and a colon, or nothing.
impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}: "),
            Self::Option(option) => write!(f, "--set {option}: "),
            Self::Unknown => Ok(()),
        }
    }
}

/// A configuration that cannot be used. Messages name the line or option, the key, and what would be right.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// The text is not TOML.
    #[error("{at}{message}")]
    Syntax {
        /// Where.
        at: Origin,
        /// What the parser says.
        message: String,
    },
    /// An override is not `KEY=VALUE`.
    #[error("--set {0}: write KEY=VALUE, as in --set dynamics.dt=0.002")]
    NotKeyValue(String),
    /// No such key or section.
    #[error(
        "{at}unknown key \"{key}\"{}; {hint}",
        if section.is_empty() { String::new() } else { format!(" in [{section}]") }
    )]
    UnknownKey {
        /// Where.
        at: Origin,
        /// The key.
        key: String,
        /// The section it stands in; empty at the top.
        section: String,
        /// The nearest known key, the section it belongs to, or all known keys.
        hint: String,
    },
    /// A value has the wrong type, is not among the choices, or is out of range.
    #[error("{at}{key} = {value}: {reason}")]
    InvalidValue {
        /// Where.
        at: Origin,
        /// The dotted key.
        key: String,
        /// The value as text.
        value: String,
        /// What is allowed.
        reason: String,
    },
    /// Particles come from a file and from a generator.
    #[error("system.input and [system.generate] are both given; keep one of them")]
    TwoSources,
    /// Particles come from nowhere.
    #[error("there is nothing to simulate: set system.input = \"FILE\" or add a [system.generate] section")]
    NoSource,
    /// A potential needs a file.
    #[error("interaction.potential = \"table\" needs a file of columns r U F: set interaction.table")]
    NoTable,
    /// A line of a table file is not three numbers.
    #[error("{}, line {line}: expected three numbers r U F", path.display())]
    TableRow {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
    },
    /// The table's numbers cannot be interpolated.
    #[error("{}: {source}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: TableError,
    },
    /// Two types have the same name.
    #[error("two [[interaction.type]] entries are named \"{0}\"; names must differ")]
    DuplicateType(String),
    /// The input has a species that no type describes.
    #[error(
        "the input has particles of species \"{species}\", but no [[interaction.type]] has that name; \
         known types are {known}"
    )]
    UnknownSpecies {
        /// The species or LAMMPS type id.
        species: String,
        /// Known names.
        known: String,
    },
    /// A value that a program put in has no place in TOML, such as a path that is not UTF-8.
    #[error("the configuration cannot be written as TOML: {0}")]
    NotToml(#[from] toml::ser::Error),
    /// Initial conditions cannot be generated.
    #[error("system.generate: {0}")]
    Generate(#[from] crate::generate::Error),
}

impl Error {
    /// A value out of range, the place still to be told.
    pub(super) fn invalid(key: impl Into<String>, value: impl ToString, reason: impl Into<String>) -> Self {
        Self::InvalidValue { at: Origin::Unknown, key: key.into(), value: value.to_string(), reason: reason.into() }
    }

    /// The same error with the place of its key looked up.
    pub(super) fn located(self, origin: impl FnOnce(&str) -> Origin) -> Self {
        match self {
            Self::InvalidValue { key, value, reason, .. } => {
                Self::InvalidValue { at: origin(&key), key, value, reason }
            }
            other => other,
        }
    }
}
