//! The trajectory: frames of extended XYZ that OVITO and ASE open.

use super::{Observer, Sample, decode_length, encode_length};
use crate::{
    Result,
    io::{Configuration, Trajectory},
};
use std::path::{Path, PathBuf};

/// Appends a frame at each observation.
pub struct TrajectoryWriter {
    path: PathBuf,
    every: u64,
    velocities: bool,
    file: Option<Trajectory>,
}

impl TrajectoryWriter {
    /// A trajectory at `path` with a frame each `every` steps. The file is created at the first frame.
    pub fn new(path: &Path, every: u64, velocities: bool) -> Self {
        Self { path: path.to_owned(), every, velocities, file: None }
    }
}

impl Observer for TrajectoryWriter {
    fn name(&self) -> &'static str {
        "trajectory"
    }

    fn every(&self) -> u64 {
        self.every
    }

    fn observe(&mut self, sample: &mut Sample) -> Result<()> {
        let system = sample.simulation.system()?;
        let mut frame = Configuration::from(system);
        frame.id = Some((0..system.particles.len() as u64).collect());
        frame.step = Some(sample.thermo.step);
        frame.time = Some(sample.thermo.time);
        if !self.velocities {
            frame.velocity = None;
        }
        if self.file.is_none() {
            self.file = Some(Trajectory::create(&self.path)?);
        }
        let file = self.file.as_mut().expect("the file was just opened");
        Ok(file.append(&frame)?)
    }

    fn save(&mut self) -> Result<Vec<u8>> {
        let Some(file) = &self.file else { return Ok(encode_length(0)) };
        file.sync()?;
        Ok(encode_length(file.length()))
    }

    fn restore(&mut self, saved: &[u8]) -> Result<()> {
        let length = decode_length(saved);
        self.file = if length > 0 { Some(Trajectory::open_at(&self.path, length)?) } else { None };
        Ok(())
    }
}
