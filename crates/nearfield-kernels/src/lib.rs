//! The device code of Nearfield: CUDA and OptiX kernels as PTX, and the structures that host and device share.
//!
//! Sources are in `cuda/` and `optix/`, one kernel or family of kernels a file. `cargo xtask ptx` compiles them and
//! writes `ptx/` and the generated header `cuda/include/layouts.cuh`; both are committed, so that building needs no
//! CUDA toolkit.

pub mod kernel;
pub mod kernels;
pub mod layout;
pub mod layouts;
mod modules;
mod variants;

pub use kernel::{Kernel, Primitive, RayProgram};
pub use layout::{Float4, Layout, Ptr};
pub use modules::{MODULES, Module, RAY_MODULES};
pub use variants::{ByForce, ByMotion};
