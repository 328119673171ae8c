//! Mean squared displacement from the first observation, along unwrapped paths.

use super::{Observer, Sample};
use crate::{Result, io::AppendFile};
use nearfield_core::{SimBox, Vec3s};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Appends `step,time,msd,x,y,z` to a table: the mean over particles of |r(t) - r(0)|² and its parts by axis,
/// \[length²\]. Box crossings are followed.
pub struct MeanSquaredDisplacement {
    path: PathBuf,
    every: u64,
    file: Option<AppendFile>,
    start: Start,
}

/// The first observation.
#[derive(Default, Serialize, Deserialize)]
struct Start {
    position: Vec3s,
    image: Vec<[i32; 3]>,
    file_length: u64,
}

impl MeanSquaredDisplacement {
    /// A table at `path` with a row each `every` steps.
    pub fn new(path: &Path, every: u64) -> Self {
        Self { path: path.to_owned(), every, file: None, start: Start::default() }
    }

    /// Mean squared displacement by axis.
    fn by_axis(&self, sim_box: &SimBox, position: &Vec3s, image: &[[i32; 3]]) -> [f64; 3] {
        let lengths = sim_box.lengths();
        std::array::from_fn(|axis| {
            let (now, then) = (position.axes()[axis], self.start.position.axes()[axis]);
            let squared = |i: usize| {
                let crossings = f64::from(image[i][axis]) - f64::from(self.start.image[i][axis]);
                (f64::from(now[i]) - f64::from(then[i]) + crossings * f64::from(lengths[axis])).powi(2)
            };
            (0..now.len()).map(squared).sum::<f64>() / now.len() as f64
        })
    }
}

impl Observer for MeanSquaredDisplacement {
    fn name(&self) -> &'static str {
        "msd"
    }

    fn every(&self) -> u64 {
        self.every
    }

    fn observe(&mut self, sample: &mut Sample) -> Result<()> {
        let system = sample.simulation.system()?;
        let particles = &system.particles;
        if self.file.is_none() {
            self.start = Start { position: particles.position.clone(), image: particles.image.clone(), file_length: 0 };
            let mut file = AppendFile::create(&self.path)?;
            file.append(b"step,time,msd,x,y,z\n")?;
            self.file = Some(file);
        }
        let [x, y, z] = self.by_axis(&system.sim_box, &particles.position, &particles.image);
        let row = format!("{},{},{},{x},{y},{z}\n", sample.thermo.step, sample.thermo.time, x + y + z);
        let file = self.file.as_mut().expect("the file was just opened");
        Ok(file.append(row.as_bytes())?)
    }

    fn save(&mut self) -> Result<Vec<u8>> {
        if let Some(file) = &self.file {
            file.sync()?;
            self.start.file_length = file.length();
        }
        Ok(rmp_serde::to_vec(&self.start).expect("plain arrays can be encoded"))
    }

    fn restore(&mut self, saved: &[u8]) -> Result<()> {
        self.start = rmp_serde::from_slice(saved).unwrap_or_default();
        let length = self.start.file_length;
        self.file = if length > 0 { Some(AppendFile::open_at(&self.path, length)?) } else { None };
        Ok(())
    }
}
