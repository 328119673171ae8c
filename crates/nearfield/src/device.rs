//! The devices of this machine.

use crate::{Device, Error, Result};
use nearfield_core::Engine;
use nearfield_cpu::CpuEngine;
use serde::Serialize;

/// A device and whether it can be used.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DeviceStatus {
    /// Name for `--device`.
    pub name: String,
    /// Whether an engine can be made for it.
    pub usable: bool,
    /// What it is, or why it cannot be used.
    pub detail: String,
}

/// Why CUDA cannot be used by this version.
const NO_CUDA: &str = "this version of Nearfield has no CUDA engine";

/// Every device that Nearfield knows of, usable or not.
pub fn devices() -> Vec<DeviceStatus> {
    let cpu = CpuEngine::new().device();
    vec![
        DeviceStatus { name: "cpu".into(), usable: true, detail: cpu },
        DeviceStatus { name: "cuda".into(), usable: false, detail: NO_CUDA.into() },
    ]
}

/// An engine for a device; `auto` is the fastest usable one.
///
/// # Errors
/// [`Error::DeviceUnavailable`].
pub fn engine(device: Device) -> Result<Box<dyn Engine>> {
    match device {
        Device::Auto | Device::Cpu => Ok(Box::new(CpuEngine::new())),
        Device::Cuda(_) => Err(Error::DeviceUnavailable { device: device.to_string(), reason: NO_CUDA.into() }),
    }
}
