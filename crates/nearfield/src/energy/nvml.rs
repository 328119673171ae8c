//! The energy counter of NVIDIA boards (Volta and newer), which the driver refreshes every 20 to 100 ms.
//!
//! Through nvml-wrapper, which loads the driver's library at run time, rather than by declarations of our own: NVML's
//! errors and versioned functions are kept up to date there.

use nvml_wrapper::error::NvmlError;

/// The counter of one board.
#[derive(Debug)]
pub(super) struct Nvml {
    library: nvml_wrapper::Nvml,
    uuid: String,
    first: u64,
    last: u64,
}

impl Nvml {
    pub fn find(uuid: &str) -> Result<Self, NvmlError> {
        let library = nvml_wrapper::Nvml::init()?;
        let first = millijoules(&library, uuid)?;
        Ok(Self { library, uuid: uuid.into(), first, last: first })
    }

    /// Energy since the meter was found, \[J\].
    pub fn joules(&mut self) -> f64 {
        // A reading that fails leaves the one before.
        self.last = millijoules(&self.library, &self.uuid).unwrap_or(self.last);
        self.last.saturating_sub(self.first) as f64 * 1e-3
    }
}

fn millijoules(library: &nvml_wrapper::Nvml, uuid: &str) -> Result<u64, NvmlError> {
    library.device_by_uuid(uuid)?.total_energy_consumption()
}

/// Version of the NVIDIA driver, where there is one.
pub(crate) fn driver_version() -> Option<String> {
    nvml_wrapper::Nvml::init().ok()?.sys_driver_version().ok()
}
