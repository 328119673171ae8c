//! The GPU engine of Nearfield: CUDA cores and OptiX ray tracing, with nothing but the NVIDIA driver.

mod buffer;
mod cluster;
mod device;
mod engine;
pub mod gpu;
pub mod grid;
mod list;
mod scan;
mod sequence;
pub mod tracing;

pub use buffer::Buffer;
pub use cluster::Variant;
pub use device::{CudaDevice, DeviceInfo, Unavailable, devices};
pub use engine::CudaEngine;
pub use gpu::Gpu;
pub use list::DeviceList;
pub use sequence::Sequence;
