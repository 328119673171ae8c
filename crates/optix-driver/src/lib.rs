//! OptiX from Rust with nothing but the NVIDIA driver.
//!
//! The driver (535 or newer) brings `libnvoptix.so.1`. This crate loads it at run time and wraps what ray tracing of
//! custom boxes, spheres, triangles and instances takes: context, modules, program groups, pipeline, shader binding
//! table, acceleration structures, launch. Nothing else is needed, neither to build nor to run: no OptiX SDK, no CUDA
//! toolkit, no bindgen, no C compiler. Without the library [`OptiX::load`] returns an error that says what was looked
//! for.
//!
//! CUDA contexts, streams and device memory are the caller's, passed as the CUDA driver API has them: `CUcontext` and
//! `CUstream` as pointers, `CUdeviceptr` as `u64`. Any CUDA crate will do. Device programs are PTX text.
//!
//! # From load to launch
//!
//! ```no_run
//! use optix_driver::*;
//! use std::ffi::c_void;
//!
//! /// Traces `n` rays against `n` boxes at the device address `boxes`. `alloc` makes 128-byte aligned device memory,
//! /// `upload` copies to it; `params` lays out the launch parameters.
//! fn trace(
//!     cu_context: *mut c_void,
//!     stream: *mut c_void,
//!     ptx: &str,
//!     boxes: u64,
//!     n: u32,
//!     alloc: impl Fn(usize) -> DeviceSpan,
//!     upload: impl Fn(&[u8]) -> DeviceSpan,
//!     params: impl Fn(TraversableHandle) -> Vec<u8>,
//! ) -> Result<()> {
//!     let optix = OptiX::load()?;
//!     // SAFETY: the CUDA context outlives everything here.
//!     let context = unsafe { DeviceContext::new(&optix, cu_context, ContextOptions::default())? };
//!
//!     let options = PipelineOptions { payload_words: 1, ..Default::default() };
//!     let module = Module::from_ptx(&context, ptx, ModuleOptions::default(), &options)?;
//!     let raygen = ProgramGroup::raygen(Program::new(&module, c"__raygen__point_ray"))?;
//!     let miss = ProgramGroup::empty_miss(&context)?;
//!     let intersection = Some(Program::new(&module, c"__intersection__sphere"));
//!     let hit = ProgramGroup::hitgroup(&context, Hitgroup { intersection, ..Default::default() })?;
//!     let pipeline = Pipeline::new(&context, &options, &[raygen.clone(), miss.clone(), hit.clone()])?;
//!
//!     let image = SbtImage::new(SbtRecord::new(&raygen), &[SbtRecord::new(&miss)], &[SbtRecord::new(&hit)])?;
//!     let sbt = image.at(upload(image.bytes()).address)?;
//!
//!     let accel = AccelOptions { allow_update: true, preference: Preference::FastTrace, ..Default::default() };
//!     let inputs = [BuildInput::Aabbs(Aabbs { buffer: boxes, count: n, stride: 24, any_hit: AnyHit::Never })];
//!     let sizes = context.accel_sizes(accel, &inputs)?;
//!     let (temp, output) = (alloc(sizes.temp), alloc(sizes.output));
//!     // SAFETY: the memory is as large as the driver asked for and lives until the stream is synchronised.
//!     unsafe {
//!         let gas = context.accel_build(stream, accel, &inputs, temp, output, None)?;
//!         pipeline.launch(stream, upload(&params(gas)), &sbt, [n, 1, 1])?;
//!     }
//!     Ok(())
//! }
//! ```
//!
//! # Ownership
//!
//! Objects are shared by [`Arc`](std::sync::Arc), keep what they were made from alive, and are destroyed when the last
//! owner drops them, in an order that the driver accepts. They may be used from any thread. What enqueues work on
//! device memory is `unsafe`, as the driver trusts addresses, and so is [`DeviceContext::new`], whose CUDA context the
//! caller promises to keep alive; everything else is safe.
//!
//! # What to know
//!
//! - **OptiX calls cannot be captured into a CUDA graph.** Builds and launches either fail during the capture and
//!   invalidate it, or seem to succeed and the replay reads from an illegal address. Capture plain CUDA work only.
//! - **No RT cores are needed.** [`DeviceContext::rtcore_version`] 0 means that traversal runs in software, as on
//!   data-centre GPUs such as the H200; everything works.
//! - Launches of one pipeline must not overlap, as they share its copy of the launch parameters.
//! - The trace depth is 1: rays start in ray generation programs only. Motion, curves, micromaps, callables and
//!   denoising are not wrapped.
//! - The table of OptiX 8.0 (ABI 87) is used, which newer drivers still offer.
//! - Windows is not supported yet: the driver's library has no fixed place there.

mod accel;
mod build_input;
mod call;
mod context;
mod device_span;
mod error;
mod instance;
mod launch;
mod loader;
#[cfg(test)]
mod mock;
mod module;
mod options;
mod pipeline;
mod program_group;
mod sbt;
mod sys;
mod table;

pub use accel::{AccelOptions, AccelSizes, Preference, TraversableHandle};
pub use build_input::{Aabbs, AnyHit, BuildInput, Instances, SphereRadii, Spheres, Triangles, Triplets};
pub use context::{Cache, ContextOptions, DeviceContext, LogCallback, LogLevel};
pub use device_span::DeviceSpan;
pub use error::{Error, Result};
pub use instance::Instance;
pub use loader::OptiX;
pub use module::Module;
pub use options::{ModuleOptions, PipelineOptions, Primitives, TraversableGraph};
pub use pipeline::Pipeline;
pub use program_group::{Hitgroup, Program, ProgramGroup, ProgramGroupKind};
pub use sbt::{SbtImage, SbtRecord, ShaderBindingTable};
