//! Which GPUs there are.

use super::{CudaDevice, Unavailable};
use crate::Gpu;
use cudarc::driver::{CudaContext, DriverError, result, sys};
use std::sync::Arc;

/// CUDA version of PTX 8.2, which the kernels are compiled to.
const LEAST_CUDA: i32 = 12020;

/// A GPU of this machine.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceInfo {
    /// Its number.
    pub ordinal: usize,
    /// Its name.
    pub name: String,
    /// Its identifier in the driver's other libraries, as in `GPU-8a56a4bc-...`.
    pub uuid: String,
    /// Memory, \[bytes\].
    pub memory: u64,
    /// Compute capability.
    pub compute_capability: (i32, i32),
    /// What traces rays, or why nothing does.
    pub ray_tracing: Result<String, String>,
}

/// Every GPU that can be used.
///
/// # Errors
/// [`Unavailable`] when there is none: why the first cannot be.
pub fn devices() -> Result<Vec<DeviceInfo>, Unavailable> {
    let mut reason = None;
    let mut usable = Vec::new();
    for ordinal in 0..count()? {
        match info(ordinal) {
            Ok(device) => usable.push(device),
            Err(error) => {
                reason.get_or_insert(error);
            }
        }
    }
    match reason {
        Some(reason) if usable.is_empty() => Err(reason),
        _ => Ok(usable),
    }
}

fn info(ordinal: usize) -> Result<DeviceInfo, Unavailable> {
    let context = context(ordinal)?;
    let driver = |error: DriverError| Unavailable::Driver(describe(error));
    let (name, memory) = (context.name().map_err(driver)?, context.total_mem().map_err(driver)? as u64);
    let compute_capability = context.compute_capability().map_err(driver)?;
    let uuid = hyphenated(context.uuid().map_err(driver)?);
    let device = CudaDevice::on(context).map_err(|error| Unavailable::Driver(error.to_string()))?;
    let ray_tracing = device.ray_tracing().map(|tracing| tracing.describe());
    Ok(DeviceInfo { ordinal, name, uuid, memory, compute_capability, ray_tracing })
}

/// As NVML and nvidia-smi write it.
fn hyphenated(uuid: sys::CUuuid) -> String {
    let mut text = String::from("GPU");
    for (at, byte) in uuid.bytes.iter().enumerate() {
        if matches!(at, 0 | 4 | 6 | 8 | 10) {
            text.push('-');
        }
        // The element type is the platform's char, which has a sign or not.
        let [byte] = byte.to_ne_bytes();
        text += &format!("{byte:02x}");
    }
    text
}

/// A context on a device whose driver and compute capability suffice.
pub(super) fn context(ordinal: usize) -> Result<Arc<CudaContext>, Unavailable> {
    let count = count()?;
    if ordinal >= count {
        return Err(Unavailable::NoSuchDevice { ordinal, count });
    }
    let driver = |error: DriverError| Unavailable::Driver(describe(error));
    let context = CudaContext::new(ordinal).map_err(driver)?;
    // SAFETY: the engine uses one stream, and orders the others it makes by itself.
    unsafe { context.disable_event_tracking() };
    let (major, minor) = context.compute_capability().map_err(driver)?;
    if (major, minor) < (7, 5) {
        return Err(Unavailable::OldDevice { name: context.name().map_err(driver)?, major, minor });
    }
    Ok(context)
}

fn count() -> Result<usize, Unavailable> {
    // SAFETY: looks for the library only. The first call without it would panic.
    if !unsafe { sys::is_culib_present() } {
        return Err(Unavailable::NoDriver);
    }
    result::init().map_err(|error| Unavailable::NoDevice(describe(error)))?;
    let mut version = 0;
    // SAFETY: writes one integer.
    let outcome = unsafe { sys::cuDriverGetVersion(&raw mut version) }.result();
    outcome.map_err(|error| Unavailable::Driver(describe(error)))?;
    if version < LEAST_CUDA {
        let text = |version: i32| format!("{}.{}", version / 1000, version % 1000 / 10);
        return Err(Unavailable::OldDriver { found: text(version), needed: text(LEAST_CUDA) });
    }
    let count = CudaContext::device_count().map_err(|error| Unavailable::Driver(describe(error)))?;
    Ok(usize::try_from(count).unwrap_or(0))
}

/// An error of the driver in words.
pub(super) fn describe(error: DriverError) -> String {
    let text = |found: Result<&std::ffi::CStr, DriverError>| {
        found.map(|text| text.to_string_lossy().into_owned()).unwrap_or_default()
    };
    format!("{}: {}", text(error.error_name()), text(error.error_string()))
}
