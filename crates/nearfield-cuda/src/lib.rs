//! The GPU engine of Nearfield: CUDA cores and OptiX ray tracing, with nothing but the NVIDIA driver.

mod buffer;
pub mod gpu;

pub use buffer::Buffer;
pub use gpu::Gpu;
