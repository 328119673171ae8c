//! LAMMPS data files.
//!
//! The format: <https://docs.lammps.org/read_data.html>. Sections `Masses`, `Atom Type Labels`, `Atoms` (styles atomic,
//! charge, molecular, bond, angle, full) and `Velocities` are read; force-field coefficients and bonds are passed over,
//! as interactions come from elsewhere, and so are charges and molecules. The file does not say which axes are
//! periodic.

mod header;
mod read;
mod sections;
mod style;
mod write;

pub(super) use read::read;
pub(super) use write::encode;
