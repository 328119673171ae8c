//! The GPU engine of Nearfield: CUDA cores and OptiX ray tracing, with nothing but the NVIDIA driver.

pub mod gpu;

pub use gpu::Gpu;
