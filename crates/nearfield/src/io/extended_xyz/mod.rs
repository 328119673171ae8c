//! Extended XYZ: a count, a comment line of `key=value` pairs, one line a particle; frame after frame.
//!
//! The format: <https://github.com/libAtoms/extxyz>. The columns `species`, `pos`, `velo`, `forces`, `masses`,
//! `radius`, `map_shift` (image counts) and `id` are read and written, under these names because ASE and OVITO know
//! them; others are passed over. `Origin`, the lower corner of the box, is OVITO's. Plain XYZ, whose comment is free
//! text, is read too.

mod columns;
mod comment;
mod elements;
mod frames;
mod write;

pub use frames::Frames;
pub(super) use write::encode;
