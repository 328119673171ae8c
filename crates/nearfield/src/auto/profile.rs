//! The constants of the cost model, by device: some come with Nearfield, and a small file may add a machine's own.

use super::{Cost, Survey};
use crate::{Error, Result, io::atomic_write};
use nearfield_core::Method;
use serde::{Deserialize, Serialize};
use std::{
    collections::BTreeMap,
    env, fs,
    path::{Path, PathBuf},
};

/// What comes with Nearfield.
const EMBEDDED: &str = include_str!("../../data/profile.toml");
/// Names the file to use instead of the user's own.
const VARIABLE: &str = "NEARFIELD_PROFILE";

/// The constants of some devices.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// By device.
    #[serde(default, rename = "device")]
    pub devices: Vec<DeviceProfile>,
}

/// The constants of a device.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceProfile {
    /// Devices whose name begins so are meant.
    pub name: String,
    /// Where the constants are from.
    #[serde(default)]
    pub source: String,
    /// Whether the constants are of one thread, and the work is shared by as many as there are.
    #[serde(default)]
    pub per_thread: bool,
    /// By method; others are no candidates of `auto`.
    pub method: BTreeMap<String, Cost>,
}

impl Profile {
    /// What comes with Nearfield, and before it what the user's file says.
    ///
    /// # Errors
    /// [`Error::Profile`] when there is a file that cannot be read.
    pub fn load() -> Result<Self> {
        let embedded: Self = toml::from_str(EMBEDDED).expect("the embedded profile is valid");
        let own = match Self::path() {
            Some(path) if path.exists() => Self::read(&path)?,
            _ => Self::default(),
        };
        Ok(Self { devices: own.devices.into_iter().chain(embedded.devices).collect() })
    }

    /// The user's file: what the environment variable `NEARFIELD_PROFILE` names, or `nearfield/profile.toml` in the folder
    /// for configurations; none where there is no such folder.
    pub fn path() -> Option<PathBuf> {
        let folder = || dirs::config_dir().map(|folder| folder.join("nearfield").join("profile.toml"));
        env::var_os(VARIABLE).map(PathBuf::from).or_else(folder)
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::Profile`].
    pub fn read(path: &Path) -> Result<Self> {
        let refused = |reason: String| Error::Profile { path: path.into(), reason };
        let text = fs::read_to_string(path).map_err(|error| refused(error.to_string()))?;
        let profile: Self = toml::from_str(&text).map_err(|error| refused(error.to_string().trim_end().to_owned()))?;
        let names = profile.devices.iter().flat_map(|device| device.method.keys());
        for name in names {
            name.parse::<Method>().map_err(&refused)?;
        }
        Ok(profile)
    }

    /// Writes a file, making its folder.
    ///
    /// # Errors
    /// A folder or file that cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        let refused = |reason: String| Error::Profile { path: path.into(), reason };
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(|error| refused(error.to_string()))?;
        }
        let text = toml::to_string(self).expect("a profile can be written");
        let heading = "# Constants of Nearfield's cost model, written by `nearfield bench auto`. Seconds of a step:\n\
                       # step + particle x number of particles + pair x number of ordered pairs within range.\n";
        Ok(atomic_write(path, |out| write!(out, "{heading}{text}"))?)
    }

    /// Replaces the constants of a device by others.
    pub fn put(&mut self, device: DeviceProfile) {
        self.devices.retain(|other| other.name != device.name);
        self.devices.push(device);
    }

    /// The constants for a device: of those whose name the device's begins with, the longest; of equal ones, the first.
    pub fn of(&self, device: &str) -> Option<&DeviceProfile> {
        let candidates = self.devices.iter().filter(|entry| device.starts_with(&entry.name));
        candidates.rev().max_by_key(|entry| entry.name.len())
    }
}

impl DeviceProfile {
    /// Predicted seconds of a step of each method.
    pub fn predict(&self, survey: &Survey) -> Vec<(Method, f64)> {
        let threads = if self.per_thread { rayon::current_num_threads() as f64 } else { 1.0 };
        let cost = |(name, cost): (&String, &Cost)| {
            let method: Method = name.parse().ok()?;
            Some((method, cost.seconds(method, survey) / threads))
        };
        self.method.iter().filter_map(cost).collect()
    }
}
