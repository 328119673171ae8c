//! Real devices, through the NVIDIA driver.

mod cuda;
mod error;
mod find;
mod graphs;
mod optix;
mod structure;

pub use cuda::CudaDevice;
pub use error::Unavailable;
pub use find::{DeviceInfo, devices};
