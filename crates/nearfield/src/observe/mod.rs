//! What watches a run: one observer a file.

mod msd;
mod rdf;
mod thermo_table;
mod trajectory;

pub use msd::MeanSquaredDisplacement;
pub use rdf::RadialDistribution;
pub use thermo_table::ThermoTable;
pub use trajectory::TrajectoryWriter;

use crate::{Result, Simulation, Thermo};

/// The moment an observer looks at.
pub struct Sample<'a> {
    /// The simulation, at rest between steps.
    pub simulation: &'a mut Simulation,
    /// Its thermodynamic state.
    pub thermo: Thermo,
}

/// Something that looks at a run at regular steps.
pub trait Observer {
    /// Name, unique among the observers of a run; what it saves is kept under it.
    fn name(&self) -> &'static str;

    /// Steps between observations; 0 is never.
    fn every(&self) -> u64;

    /// Looks at the present step, a multiple of [`Observer::every`].
    ///
    /// # Errors
    /// When its output cannot be written.
    fn observe(&mut self, sample: &mut Sample) -> Result<()>;

    /// What a later [`Observer::restore`] needs to continue as if nothing had happened; everything written so far is
    /// on the disk afterwards.
    ///
    /// # Errors
    /// When its output cannot be written.
    fn save(&mut self) -> Result<Vec<u8>>;

    /// Continues from what [`Observer::save`] gave, dropping anything written after it.
    ///
    /// # Errors
    /// When its output is not there any more.
    fn restore(&mut self, saved: &[u8]) -> Result<()>;
}

/// A file length as saved state.
fn encode_length(length: u64) -> Vec<u8> {
    length.to_le_bytes().to_vec()
}

/// A saved file length; damaged state counts as an empty file.
fn decode_length(saved: &[u8]) -> u64 {
    saved.try_into().map(u64::from_le_bytes).unwrap_or(0)
}
