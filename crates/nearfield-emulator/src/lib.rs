//! Runs the GPU kernels of Nearfield on the host, so that the engine is tested where there is no GPU.
//!
//! The sources of `nearfield-kernels` are compiled as C++ with stand-ins for what CUDA and OptiX provide (`shim/`), and
//! [`Emulator`] implements [`nearfield_cuda::Gpu`] with them. Blocks run one after another; the threads of a block are
//! fibers that run until a warp operation or barrier, where they meet. Acceleration structures are trees of boxes,
//! and built-in spheres and triangles are intersected in f32.
//!
//! What a GPU leaves undefined is made visible: new memory holds a pattern, writes beyond buffers are found at the next
//! download, and a lane that a warp operation waits for in vain ends the launch with an error. Not seen: races between
//! threads, and differences in conversions of numbers beyond the range of integers, where the device saturates.

mod clock;
mod emulator;
mod launch;
mod memory;
mod primitives;
mod tracing;
mod tree;

pub use emulator::Emulator;

/// Whether kernels were compiled for the host when this crate was built: it takes a C++ compiler.
pub const fn available() -> bool {
    cfg!(host_compiler)
}
