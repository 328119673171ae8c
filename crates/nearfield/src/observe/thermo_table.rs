//! thermo.csv: a row of thermodynamic state.

use super::{Observer, Sample, decode_length, encode_length};
use crate::{Result, io::AppendFile};
use std::path::{Path, PathBuf};

/// Columns, in order.
const HEADER: &str =
    "step,time,temperature,kinetic_energy,potential_energy,total_energy,pressure,virial,pairs,max_force\n";

/// Appends a row at each observation.
pub struct ThermoTable {
    path: PathBuf,
    every: u64,
    file: Option<AppendFile>,
}

impl ThermoTable {
    /// A table at `path` with a row each `every` steps. The file is created at the first row.
    pub fn new(path: &Path, every: u64) -> Self {
        Self { path: path.to_owned(), every, file: None }
    }

    fn file(&mut self) -> Result<&mut AppendFile> {
        if self.file.is_none() {
            let mut file = AppendFile::create(&self.path)?;
            file.append(HEADER.as_bytes())?;
            self.file = Some(file);
        }
        Ok(self.file.as_mut().expect("the file was just opened"))
    }
}

impl Observer for ThermoTable {
    fn name(&self) -> &'static str {
        "thermo"
    }

    fn every(&self) -> u64 {
        self.every
    }

    fn observe(&mut self, sample: &mut Sample) -> Result<()> {
        let t = sample.thermo;
        let row = format!(
            "{},{},{},{},{},{},{},{},{},{}\n",
            t.step,
            t.time,
            t.temperature,
            t.kinetic_energy,
            t.potential_energy,
            t.total_energy,
            t.pressure,
            t.virial,
            t.pairs,
            t.max_force
        );
        Ok(self.file()?.append(row.as_bytes())?)
    }

    fn save(&mut self) -> Result<Vec<u8>> {
        let Some(file) = &self.file else { return Ok(encode_length(0)) };
        file.sync()?;
        Ok(encode_length(file.length()))
    }

    fn restore(&mut self, saved: &[u8]) -> Result<()> {
        let length = decode_length(saved);
        self.file = if length > 0 { Some(AppendFile::open_at(&self.path, length)?) } else { None };
        Ok(())
    }
}
