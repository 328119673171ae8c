//! The devices of this machine.

use crate::{Device, Error, Result};
use nearfield_core::Engine;
use nearfield_cpu::CpuEngine;
use nearfield_cuda::{CudaEngine, DeviceInfo, Unavailable};
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
    /// More about a GPU.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub gpu: Option<GpuStatus>,
}

/// What a GPU has.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GpuStatus {
    /// Its name.
    pub model: String,
    /// Its identifier in the driver's tools, as in `GPU-8a56a4bc-...`.
    pub uuid: String,
    /// Memory, \[bytes\].
    pub memory: u64,
    /// Compute capability, as in `9.0`.
    pub compute_capability: String,
    /// How rays are traced; `None` where the methods that trace rays cannot run.
    pub ray_tracing: Option<String>,
}

/// Every device that Nearfield knows of, usable or not.
pub fn devices() -> Vec<DeviceStatus> {
    let cpu = CpuEngine::new().device();
    let mut devices = vec![DeviceStatus { name: "cpu".into(), usable: true, detail: cpu, gpu: None }];
    match nearfield_cuda::devices() {
        Ok(found) => devices.extend(found.iter().map(status)),
        Err(reason) => devices.push(DeviceStatus {
            name: "cuda".into(),
            usable: false,
            // One line each.
            detail: reason.to_string().replace('\n', " "),
            gpu: None,
        }),
    }
    devices
}

fn status(info: &DeviceInfo) -> DeviceStatus {
    let (major, minor) = info.compute_capability;
    let compute_capability = format!("{major}.{minor}");
    let ray_tracing = match &info.ray_tracing {
        Ok(how) => format!("ray tracing: {how}"),
        Err(reason) => format!("no ray tracing: {reason}"),
    };
    let gibibytes = info.memory as f64 / (1u64 << 30) as f64;
    let detail = format!("{}, {gibibytes:.1} GiB, compute capability {compute_capability}, {ray_tracing}", info.name);
    DeviceStatus {
        name: format!("cuda:{}", info.ordinal),
        usable: true,
        detail: detail.replace('\n', " "),
        gpu: Some(GpuStatus {
            model: info.name.clone(),
            uuid: info.uuid.clone(),
            memory: info.memory,
            compute_capability,
            ray_tracing: info.ray_tracing.clone().ok(),
        }),
    }
}

/// An engine for a device; `auto` is the first GPU that can be used, else the CPU.
///
/// # Errors
/// [`Error::DeviceUnavailable`], naming the device and what was looked for.
pub fn engine(device: Device) -> Result<Box<dyn Engine>> {
    let unavailable =
        |reason: Unavailable| Error::DeviceUnavailable { device: device.to_string(), reason: reason.to_string() };
    match device {
        Device::Cpu => Ok(Box::new(CpuEngine::new())),
        Device::Cuda(Some(ordinal)) => Ok(Box::new(CudaEngine::new(ordinal as usize).map_err(unavailable)?)),
        Device::Cuda(None) => Ok(Box::new(first_gpu().map_err(unavailable)?)),
        Device::Auto => Ok(match first_gpu() {
            Ok(gpu) => Box::new(gpu),
            Err(_) => Box::new(CpuEngine::new()),
        }),
    }
}

/// Name of the device that [`engine`] takes, and the identifier of a GPU.
pub(crate) fn identity(device: Device) -> (String, Option<String>) {
    let ordinal = match device {
        Device::Cpu => None,
        Device::Cuda(Some(ordinal)) => Some(ordinal as usize),
        Device::Auto | Device::Cuda(None) => {
            nearfield_cuda::devices().ok().and_then(|found| found.first().map(|info| info.ordinal))
        }
    };
    let Some(ordinal) = ordinal else { return ("cpu".into(), None) };
    let found = nearfield_cuda::devices().unwrap_or_default();
    let uuid = found.iter().find(|info| info.ordinal == ordinal).map(|info| info.uuid.clone());
    (format!("cuda:{ordinal}"), uuid)
}

/// The first GPU for which an engine can be made; the error of the very first where there is none.
fn first_gpu() -> Result<CudaEngine, Unavailable> {
    CudaEngine::new(0).or_else(|error| {
        for ordinal in 1.. {
            match CudaEngine::new(ordinal) {
                Ok(engine) => return Ok(engine),
                Err(Unavailable::OldDevice { .. }) => {}
                Err(_) => break,
            }
        }
        Err(error)
    })
}
