//! A GPU behind the CUDA driver: one context, one stream.

use super::{
    Unavailable,
    find::{self, describe},
    graphs::{Graph, Graphs},
    optix::Optix,
};
use crate::{
    Sequence,
    gpu::{Gpu, Launch, Mark, Memory, Queue, RayTracing},
    sequence::Part,
};
use cudarc::{
    driver::{CudaContext, CudaEvent, CudaFunction, CudaModule, CudaStream, DriverError, result, sys},
    nvrtc::Ptx,
};
use nearfield_core::{Error, Result};
use nearfield_kernels::MODULES;
use std::{
    any::Any,
    collections::HashMap,
    ffi::c_void,
    sync::{Arc, Mutex, OnceLock, PoisonError},
};

/// A GPU of this machine.
pub struct CudaDevice {
    context: Arc<CudaContext>,
    stream: Arc<CudaStream>,
    // Before the kernels that they launch, for these must not go first.
    graphs: Mutex<Graphs>,
    loaded: Mutex<Loaded>,
    /// OptiX, or why there is none, once somebody has asked.
    tracing: OnceLock<std::result::Result<Optix, String>>,
}

/// Modules and kernels, loaded when first used.
#[derive(Default)]
struct Loaded {
    modules: HashMap<&'static str, Arc<CudaModule>>,
    kernels: HashMap<&'static str, CudaFunction>,
}

impl CudaDevice {
    /// The GPU of this number.
    ///
    /// # Errors
    /// [`Unavailable`].
    pub fn new(ordinal: usize) -> std::result::Result<Self, Unavailable> {
        Self::on(find::context(ordinal)?).map_err(|error| Unavailable::Driver(error.to_string()))
    }

    /// With a new stream of a context.
    pub(super) fn on(context: Arc<CudaContext>) -> Result<Self> {
        let stream = context.new_stream().map_err(failed("making a stream"))?;
        Ok(Self::with_stream(context, stream))
    }

    fn with_stream(context: Arc<CudaContext>, stream: Arc<CudaStream>) -> Self {
        Self { context, stream, graphs: Mutex::default(), loaded: Mutex::default(), tracing: OnceLock::new() }
    }

    /// Makes the context the calling thread's: engines may move between threads.
    pub(super) fn bind(&self) -> Result<sys::CUstream> {
        self.context.bind_to_thread().map_err(failed("binding the context"))?;
        Ok(self.stream.cu_stream())
    }

    /// The context for other libraries, made the calling thread's.
    pub(super) fn cu_context(&self) -> Result<*mut c_void> {
        self.bind()?;
        Ok(self.context.cu_ctx().cast())
    }

    /// What ray tracing had to say since the last time: warnings and errors of OptiX where the environment variable
    /// `NEARFIELD_OPTIX_VALIDATION` was 1 when it was first used, nothing otherwise.
    pub fn take_ray_tracing_messages(&self) -> Vec<String> {
        self.tracing.get().and_then(|tracing| tracing.as_ref().ok()).map(Optix::take_messages).unwrap_or_default()
    }

    /// Number of sequences that are kept as CUDA graphs now.
    pub fn n_graphs(&self) -> usize {
        self.graphs.lock().unwrap_or_else(PoisonError::into_inner).count()
    }

    fn kernel(&self, module: &'static str, name: &'static str) -> Result<CudaFunction> {
        let mut loaded = self.loaded.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(kernel) = loaded.kernels.get(name) {
            return Ok(kernel.clone());
        }
        let code = match loaded.modules.get(module) {
            Some(code) => code.clone(),
            None => {
                let source = MODULES.iter().find(|m| m.name == module);
                let source = source.ok_or_else(|| Error::Device(format!("there is no module {module}")))?;
                let capability = self.context.compute_capability().map_err(failed("asking what the device can do"))?;
                let ptx = Ptx::from_src(source.ptx_for(capability));
                let code = self.context.load_module(ptx).map_err(failed("loading kernels"))?;
                loaded.modules.insert(module, code.clone());
                code
            }
        };
        let kernel = code.load_function(name).map_err(failed("finding a kernel"))?;
        loaded.kernels.insert(name, kernel.clone());
        Ok(kernel)
    }
}

/// Turns an error of the driver into the engine's.
fn failed(doing: &'static str) -> impl Fn(DriverError) -> Error {
    move |error| Error::Device(format!("{doing}: {}", describe(error)))
}

impl Queue for CudaDevice {
    unsafe fn launch(&self, launch: Launch) -> Result<()> {
        let stream = self.bind()?;
        let kernel = self.kernel(launch.module, launch.name)?;
        let mut arguments = [launch.arguments.as_ptr().cast_mut().cast::<c_void>()];
        let (grid, block) = ((launch.blocks, 1, 1), (launch.threads, 1, 1));
        // SAFETY: a kernel takes one structure, which the driver copies during the call; the caller vouches for the
        // addresses in it.
        unsafe { result::launch_kernel(kernel.cu_function(), grid, block, 0, stream, &mut arguments) }
            .map_err(|error| Error::Device(format!("launching {}: {}", launch.name, describe(error))))
    }

    unsafe fn fill(&self, to: u64, value: u8, bytes: usize) -> Result<()> {
        let stream = self.bind()?;
        // SAFETY: the caller vouches for the address.
        unsafe { result::memset_d8_async(to, value, bytes, stream) }.map_err(failed("filling memory"))
    }
}

impl Gpu for CudaDevice {
    fn name(&self) -> String {
        self.context.name().unwrap_or_else(describe)
    }

    fn memory(&self) -> Result<Memory> {
        self.bind()?;
        let (free, total) = self.context.mem_get_info().map_err(failed("asking for memory"))?;
        Ok(Memory { free: free as u64, total: total as u64 })
    }

    fn allocate(&self, what: &'static str, bytes: usize) -> Result<u64> {
        let stream = self.bind()?;
        // SAFETY: a plain allocation, in the order of the stream where the device can do that.
        let outcome = unsafe {
            if self.context.has_async_alloc() {
                result::malloc_async(stream, bytes)
            } else {
                result::malloc_sync(bytes)
            }
        };
        match outcome {
            Ok(address) => Ok(address),
            Err(error) if error.0 == sys::CUresult::CUDA_ERROR_OUT_OF_MEMORY => {
                Err(Error::OutOfMemory { what, needed: bytes as u64, available: self.memory()?.free })
            }
            Err(error) => Err(failed("allocating memory")(error)),
        }
    }

    unsafe fn release(&self, address: u64) {
        let Ok(stream) = self.bind() else { return };
        // SAFETY: the caller gives the allocation up. A device that fails here has failed before and says so elsewhere.
        let _ = unsafe {
            if self.context.has_async_alloc() {
                result::free_async(address, stream)
            } else {
                result::free_sync(address)
            }
        };
    }

    unsafe fn upload(&self, data: &[u8], to: u64) -> Result<()> {
        let stream = self.bind()?;
        // SAFETY: the caller vouches for the address. Pageable memory is copied before the call returns.
        unsafe { result::memcpy_htod_async(to, data, stream) }.map_err(failed("copying to the device"))
    }

    unsafe fn download(&self, from: u64, data: &mut [u8]) -> Result<()> {
        let stream = self.bind()?;
        // SAFETY: the caller vouches for the address; the copy has ended when `synchronize` returns.
        unsafe { result::memcpy_dtoh_async(data, from, stream) }.map_err(failed("copying from the device"))?;
        self.synchronize()
    }

    unsafe fn copy(&self, from: u64, to: u64, bytes: usize) -> Result<()> {
        let stream = self.bind()?;
        // SAFETY: the caller vouches for the addresses.
        unsafe { result::memcpy_dtod_async(to, from, bytes, stream) }.map_err(failed("copying on the device"))
    }

    unsafe fn run(&self, sequence: &Sequence) -> Result<()> {
        let stream = self.bind()?;
        let mut graphs = self.graphs.lock().unwrap_or_else(PoisonError::into_inner);
        let kernel = |module, name| self.kernel(module, name).ok().map(|kernel| kernel.cu_function());
        // SAFETY: the caller's promise. Where the driver refuses a graph, the parts are launched one by one.
        let make = |parts: &[Part]| unsafe { Graph::new(parts, &self.context, kernel) }.ok();
        match graphs.of(sequence, make) {
            // SAFETY: the caller's promise.
            Some(graph) => unsafe { graph.launch(stream) }.map_err(failed("launching a graph")),
            // SAFETY: as above.
            None => unsafe { sequence.enqueue(self) },
        }
    }

    fn mark(&self) -> Result<Box<dyn Mark>> {
        self.bind()?;
        let flags = sys::CUevent_flags::CU_EVENT_DEFAULT;
        let event = self.stream.record_event(Some(flags)).map_err(failed("recording an event"))?;
        Ok(Box::new(Event(event)))
    }

    fn synchronize(&self) -> Result<()> {
        self.bind()?;
        self.stream.synchronize().map_err(failed("running kernels"))
    }

    fn ray_tracing(&self) -> std::result::Result<&dyn RayTracing, String> {
        // Structures may outlive this value, so OptiX has a handle of its own to context and stream.
        let handle = || Self::with_stream(self.context.clone(), self.stream.clone());
        let tracing = self.tracing.get_or_init(|| Optix::new(handle()));
        tracing.as_ref().map(|tracing| tracing as &dyn RayTracing).map_err(Clone::clone)
    }
}

/// A point in time of the stream.
struct Event(CudaEvent);

impl Mark for Event {
    fn seconds_since(&self, earlier: &dyn Mark) -> Result<f64> {
        let earlier = earlier.as_any().downcast_ref::<Self>().expect("marks of one device have one type");
        let milliseconds = earlier.0.elapsed_ms(&self.0).map_err(failed("reading an event"))?;
        Ok(f64::from(milliseconds) * 1e-3)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
