//! What the engine needs of a GPU: memory, kernels, a clock and ray tracing.
//!
//! The driver implements it for real devices ([`crate::CudaDevice`]); the crate `nearfield-emulator` runs the same
//! kernel sources on the host, so that the engine is tested where there is no GPU. Calls are asynchronous in one order,
//! that of a CUDA stream, except where they say that they wait.

use crate::Sequence;
use nearfield_core::Result;
use nearfield_kernels::{Float4, Kernel, Layout, Primitive, Ptr, RayProgram};

/// Where work is put: a device, which begins it at once, or a [`Sequence`].
pub trait Queue {
    /// Enqueues a kernel; prefer [`launch`].
    ///
    /// # Safety
    /// The addresses in `arguments` are of memory as large as the kernel takes it to be, and stay so until it has run.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    unsafe fn launch(&self, launch: Launch) -> Result<()>;

    /// Sets each byte to `value`.
    ///
    /// # Safety
    /// `to` is the address of at least `bytes` bytes of the device, until the work is done.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    unsafe fn fill(&self, to: u64, value: u8, bytes: usize) -> Result<()>;
}

/// A device, or a stand-in for one.
pub trait Gpu: Queue + Send + Sync {
    /// Name of the device, for reports.
    fn name(&self) -> String;

    /// Bytes free and in all.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    fn memory(&self) -> Result<Memory>;

    /// Address of newly allocated memory, aligned to 256 bytes. Its content is arbitrary.
    ///
    /// # Errors
    /// [`nearfield_core::Error::OutOfMemory`] with what was needed and free; [`nearfield_core::Error::Device`].
    fn allocate(&self, what: &'static str, bytes: usize) -> Result<u64>;

    /// Gives memory back once the work enqueued before has ended.
    ///
    /// # Safety
    /// `address` came from [`Gpu::allocate`] of this device and is not used again.
    unsafe fn release(&self, address: u64);

    /// Copies from the host. The data may be changed when this returns.
    ///
    /// # Safety
    /// `to` is the address of at least `data.len()` bytes of this device.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    unsafe fn upload(&self, data: &[u8], to: u64) -> Result<()>;

    /// Copies to the host, after the work enqueued before, and waits for it.
    ///
    /// # Safety
    /// `from` is the address of at least `data.len()` bytes of this device.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`], of any work enqueued before.
    unsafe fn download(&self, from: u64, data: &mut [u8]) -> Result<()>;

    /// Copies within the device.
    ///
    /// # Safety
    /// Both are addresses of at least `bytes` bytes of this device and do not overlap.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    unsafe fn copy(&self, from: u64, to: u64, bytes: usize) -> Result<()>;

    /// Enqueues all work of a sequence. A device may find that cheaper than its parts, the more so if there was an equal
    /// sequence before.
    ///
    /// # Safety
    /// As for each part of it.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    unsafe fn run(&self, sequence: &Sequence) -> Result<()>;

    /// A point in time between the work enqueued before and after.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    fn mark(&self) -> Result<Box<dyn Mark>>;

    /// Waits for all work.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`], of any work enqueued before.
    fn synchronize(&self) -> Result<()>;

    /// Ray tracing on this device.
    ///
    /// # Errors
    /// Why there is none, in words.
    fn ray_tracing(&self) -> std::result::Result<&dyn RayTracing, String>;
}

/// Memory of a device, \[bytes\].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Free.
    pub free: u64,
    /// In all.
    pub total: u64,
}

/// A kernel to be enqueued.
#[derive(Clone, Copy, Debug)]
pub struct Launch<'a> {
    /// Module of the kernel.
    pub module: &'static str,
    /// Entry point.
    pub name: &'static str,
    /// Number of blocks.
    pub blocks: u32,
    /// Threads to a block.
    pub threads: u32,
    /// The structure it takes.
    pub arguments: &'a [u8],
}

/// Enqueues a kernel with enough blocks for `threads` threads; nothing when there are none.
///
/// # Safety
/// As [`Queue::launch`].
///
/// # Errors
/// As [`Queue::launch`].
pub unsafe fn launch<A: Layout>(queue: &dyn Queue, kernel: Kernel<A>, threads: u64, arguments: &A) -> Result<()> {
    if threads == 0 {
        return Ok(());
    }
    let launch = Launch {
        module: kernel.module,
        name: kernel.name,
        blocks: u32::try_from(threads.div_ceil(u64::from(kernel.threads))).expect("32-bit indices need fewer blocks"),
        threads: kernel.threads,
        arguments: bytemuck::bytes_of(arguments),
    };
    // SAFETY: the caller's promise.
    unsafe { queue.launch(launch) }
}

/// A point in the time of a device.
pub trait Mark: Send {
    /// Seconds from an earlier mark of the same device to this one; waits until this one is reached.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`], of the work between.
    fn seconds_since(&self, earlier: &dyn Mark) -> Result<f64>;

    /// For implementations to find their own type again.
    fn as_any(&self) -> &dyn std::any::Any;
}

/// An axis-aligned box as acceleration structures take it: six floats, low corner then high corner.
pub type Aabb = [f32; 6];

/// Three vertices.
pub type Triangle = [[f32; 3]; 3];

/// What an acceleration structure is over, in device memory.
#[derive(Clone, Copy, Debug)]
pub enum Bodies {
    /// Boxes, 8-aligned.
    Boxes(Ptr<Aabb>),
    /// Spheres.
    Spheres {
        /// Their centres, 16-aligned, whose w means nothing.
        center: Ptr<Float4>,
        /// The radius of all.
        radius: Ptr<f32>,
    },
    /// Triangles.
    Triangles(Ptr<Triangle>),
}

/// What an acceleration structure is to be good at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preference {
    /// Being built and refitted quickly.
    Builds,
    /// Being traced quickly.
    Traces,
}

/// Ray tracing against boxes, spheres and triangles.
pub trait RayTracing {
    /// What traces, for reports.
    fn describe(&self) -> String;

    /// An empty acceleration structure.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    fn structure(&self) -> Result<Box<dyn AccelerationStructure>>;

    /// Runs `rays` instances of a program; prefer [`trace`].
    ///
    /// # Safety
    /// As [`Queue::launch`], for the parameters and the structure they name.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    unsafe fn trace(&self, trace: Trace) -> Result<()>;
}

/// A ray-tracing launch.
#[derive(Clone, Copy, Debug)]
pub struct Trace<'a> {
    /// Module of the programs.
    pub module: &'static str,
    /// What rays are traced against.
    pub primitive: Primitive,
    /// Ray generation, without prefix.
    pub raygen: &'static str,
    /// Intersection for boxes, else any-hit, without prefix.
    pub hit: &'static str,
    /// Number of rays.
    pub rays: u32,
    /// The launch parameters.
    pub parameters: &'a [u8],
}

/// Runs `rays` instances of a program; nothing when there are none.
///
/// # Safety
/// As [`Queue::launch`], for the parameters and the structure they name.
///
/// # Errors
/// [`nearfield_core::Error::Device`].
pub unsafe fn trace<A: Layout>(
    tracing: &dyn RayTracing,
    program: RayProgram<A>,
    rays: u32,
    parameters: &A,
) -> Result<()> {
    if rays == 0 {
        return Ok(());
    }
    let trace = Trace {
        module: program.module,
        primitive: program.primitive,
        raygen: program.raygen,
        hit: program.hit,
        rays,
        parameters: bytemuck::bytes_of(parameters),
    };
    // SAFETY: the caller's promise.
    unsafe { tracing.trace(trace) }
}

/// A bounding-volume hierarchy in device memory.
pub trait AccelerationStructure: Send {
    /// Builds over `n` bodies. A preference is a wish.
    ///
    /// # Safety
    /// The addresses are of `n` bodies until the work is done.
    ///
    /// # Errors
    /// [`nearfield_core::Error::OutOfMemory`], [`nearfield_core::Error::Device`].
    unsafe fn build(&mut self, bodies: Bodies, n: u32, preference: Preference) -> Result<()>;

    /// Fits the hierarchy of the last build to bodies that have changed, `n` of the same kind as then.
    ///
    /// # Safety
    /// As [`AccelerationStructure::build`].
    ///
    /// # Errors
    /// As [`AccelerationStructure::build`].
    unsafe fn refit(&mut self, bodies: Bodies, n: u32) -> Result<()>;

    /// Builds over translated instances of another structure, which must be built or refitted before and stay where it
    /// is. The number of an instance is its place in `translations`.
    ///
    /// # Errors
    /// As [`AccelerationStructure::build`].
    fn build_instances(&mut self, of: &dyn AccelerationStructure, translations: &[[f32; 3]]) -> Result<()>;

    /// Handle that rays are traced against; zero before the first build.
    fn handle(&self) -> u64;

    /// Bytes held on the device.
    fn bytes(&self) -> u64;
}
