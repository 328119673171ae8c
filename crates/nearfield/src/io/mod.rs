//! Files in and out, one format a file.
//!
//! [`read`] turns a file (or standard input) into a [`Configuration`], [`write()`] does the reverse; both tell the
//! format by extension. [`Frames`] streams the frames of an extended XYZ trajectory, [`Trajectory`] writes one. Files
//! that are written once go through [`atomic_write`], files that grow through [`AppendFile`], so that a kill at any
//! moment leaves something readable.
//!
//! | format | extensions | read | written |
//! |---|---|---|---|
//! | extended XYZ, plain XYZ | `.xyz` `.extxyz` | yes | yes |
//! | LAMMPS data | `.data` `.lmp` | yes | yes |
//! | GROMACS | `.gro` | yes | no |
//! | tables of forces and pairs | `.csv` `.npz` | no | yes |
//!
//! **Invariant:** particles keep the order of the file, and lengths are kept in the file's units.

mod append_file;
mod atomic_write;
mod configuration;
mod error;
mod extended_xyz;
mod format;
mod gro;
mod lammps_data;
mod line_reader;
mod number;
mod row;
mod tables;
mod trajectory;

pub use append_file::AppendFile;
pub use atomic_write::atomic_write;
pub use configuration::{Bounds, Configuration, Species};
pub use error::{IoError, Problem, Result};
pub use extended_xyz::Frames;
pub use format::{Format, Frame, ReadOptions, input_name, read, write};
pub use tables::{write_forces_csv, write_pairs_csv, write_pairs_npz};
pub use trajectory::Trajectory;
