//! Ray tracing through OptiX, on the stream of a device.

use super::{
    CudaDevice,
    structure::{self, OptixStructure},
};
use crate::{
    Buffer, Gpu,
    gpu::{AccelerationStructure, RayTracing, Trace},
};
use nearfield_core::{Error, Result};
use nearfield_kernels::{Primitive, RAY_MODULES, kernels};
use optix_driver::{
    ContextOptions, DeviceContext, DeviceSpan, Hitgroup, LogCallback, LogLevel, Module, ModuleOptions, OptiX, Pipeline,
    PipelineOptions, Primitives, Program, ProgramGroup, SbtImage, SbtRecord, ShaderBindingTable, TraversableGraph,
};
use std::{
    collections::{HashMap, hash_map::Entry},
    ffi::CString,
    sync::{Arc, Mutex, PoisonError},
};

/// The variable that switches validation on, when it is 1: launches take a fifth longer.
const VALIDATION: &str = "NEARFIELD_OPTIX_VALIDATION";

/// OptiX on a device.
pub(super) struct Optix {
    context: Arc<DeviceContext>,
    device: Arc<CudaDevice>,
    loaded: Mutex<Loaded>,
    messages: Arc<Mutex<Vec<String>>>,
}

/// What has been loaded because it was asked for.
struct Loaded {
    modules: HashMap<&'static str, Arc<Module>>,
    programs: HashMap<(&'static str, &'static str), Launchable>,
    /// Launch parameters. One place will do: copies and launches take turns on the stream.
    parameters: Buffer<u8>,
}

/// A ray generation with the program of what its rays meet.
struct Launchable {
    pipeline: Arc<Pipeline>,
    table: ShaderBindingTable,
    _table_memory: Buffer<u8>,
}

impl Optix {
    /// On the context and stream of a device.
    ///
    /// # Errors
    /// Why OptiX cannot be used, in words.
    pub fn new(device: CudaDevice) -> std::result::Result<Self, String> {
        let cu_context = device.cu_context().map_err(|error| error.to_string())?;
        let messages = Arc::new(Mutex::new(Vec::new()));
        let validation = std::env::var(VALIDATION).is_ok_and(|value| value == "1");
        let log = validation.then(|| collect(messages.clone()));
        let options = ContextOptions { validation, log, ..ContextOptions::default() };
        let optix = OptiX::load().map_err(|error| error.to_string())?;
        // SAFETY: `device` keeps its context alive, and everything made from the OptiX context is dropped before
        // `device`, or keeps it alive too.
        let context = unsafe { DeviceContext::new(&optix, cu_context, options) }.map_err(|error| error.to_string())?;
        let device = Arc::new(device);
        let gpu: Arc<dyn Gpu> = device.clone();
        let loaded = Loaded {
            modules: HashMap::new(),
            programs: HashMap::new(),
            parameters: Buffer::new(&gpu, "launch parameters"),
        };
        Ok(Self { context, device, loaded: Mutex::new(loaded), messages })
    }

    /// What OptiX had to say, under validation only: warnings and errors since the last time.
    pub fn take_messages(&self) -> Vec<String> {
        std::mem::take(&mut *self.messages.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl RayTracing for Optix {
    fn describe(&self) -> String {
        match self.context.rtcore_version() {
            Ok(0) => "OptiX 8.0, in software: no RT cores".into(),
            Ok(version) => format!("OptiX 8.0, RT cores {}.{}", version / 10, version % 10),
            Err(error) => format!("OptiX 8.0 ({error})"),
        }
    }

    fn structure(&self) -> Result<Box<dyn AccelerationStructure>> {
        Ok(Box::new(OptixStructure::new(&self.context, &self.device)))
    }

    unsafe fn trace(&self, trace: Trace) -> Result<()> {
        let stream = self.device.bind()?;
        let mut loaded = self.loaded.lock().unwrap_or_else(PoisonError::into_inner);
        let Loaded { modules, programs, parameters } = &mut *loaded;
        let program = match programs.entry((trace.module, trace.raygen)) {
            Entry::Occupied(found) => found.into_mut(),
            Entry::Vacant(place) => {
                let module = module(&self.context, modules, &trace)?;
                place.insert(Launchable::new(&self.context, &self.device, module, &trace)?)
            }
        };
        parameters.upload(trace.parameters)?;
        let parameters = DeviceSpan { address: parameters.ptr().address(), bytes: trace.parameters.len() };
        // SAFETY: the stream is of the context's device and captures nothing; table and parameters were uploaded on it
        // and live as long as this; all launches are on this stream, one after another; the caller vouches for what the
        // parameters point to.
        unsafe { program.pipeline.launch(stream.cast(), parameters, &program.table, [trace.rays, 1, 1]) }
            .map_err(|error| failed(&format!("tracing {}", trace.raygen), error))
    }
}

impl Drop for Optix {
    fn drop(&mut self) {
        // Pipelines, modules and the context are destroyed in the CUDA context that is current, on whatever thread this
        // is. A device that fails here has failed before and says so elsewhere.
        let _ = self.device.bind();
    }
}

impl Launchable {
    fn new(
        context: &Arc<DeviceContext>,
        device: &Arc<CudaDevice>,
        module: &Arc<Module>,
        trace: &Trace,
    ) -> Result<Self> {
        let linking = |error| failed(&format!("linking {}", trace.raygen), error);
        let entry = |kind: &str, name: &str| CString::new(format!("__{kind}__{name}")).expect("names are words");
        let raygen = entry("raygen", trace.raygen);
        let raygen = ProgramGroup::raygen(Program::new(module, &raygen)).map_err(linking)?;
        let miss = ProgramGroup::empty_miss(context).map_err(linking)?;
        let options = options(trace.primitive);
        let (intersection, any_hit) = (entry("intersection", trace.hit), entry("anyhit", trace.hit));
        let any_hit = Some(Program::new(module, &any_hit));
        let spheres;
        let hitgroup = match trace.primitive {
            Primitive::Box => {
                Hitgroup { intersection: Some(Program::new(module, &intersection)), ..Hitgroup::default() }
            }
            Primitive::Sphere => {
                spheres = Module::builtin_spheres(context, ModuleOptions::default(), &options, structure::OPTIONS)
                    .map_err(linking)?;
                Hitgroup { any_hit, intersection: Some(Program::builtin(&spheres)), ..Hitgroup::default() }
            }
            Primitive::Triangle => Hitgroup { any_hit, ..Hitgroup::default() },
        };
        let hit = ProgramGroup::hitgroup(context, hitgroup).map_err(linking)?;
        let groups = [raygen, miss, hit];
        let pipeline = Pipeline::new(context, &options, &groups).map_err(linking)?;
        let [raygen, miss, hit] = groups.each_ref().map(SbtRecord::new);
        let image = SbtImage::new(raygen, &[miss], &[hit]).map_err(linking)?;
        let gpu: Arc<dyn Gpu> = device.clone();
        let mut memory = Buffer::new(&gpu, "a shader binding table");
        memory.upload(image.bytes())?;
        let table = image.at(memory.ptr().address()).map_err(linking)?;
        Ok(Self { pipeline, table, _table_memory: memory })
    }
}

/// The module of a launch, compiled when it is first asked for.
fn module<'a>(
    context: &Arc<DeviceContext>,
    modules: &'a mut HashMap<&'static str, Arc<Module>>,
    trace: &Trace,
) -> Result<&'a Arc<Module>> {
    let name = trace.module;
    match modules.entry(name) {
        Entry::Occupied(found) => Ok(found.into_mut()),
        Entry::Vacant(place) => {
            let source = RAY_MODULES.iter().find(|module| module.name == name);
            let source = source.ok_or_else(|| Error::Device(format!("there is no ray-tracing module {name}")))?;
            let module = Module::from_ptx(context, source.ptx, ModuleOptions::default(), &options(trace.primitive));
            Ok(place.insert(module.map_err(|error| failed(&format!("compiling {name}"), error))?))
        }
    }
}

/// Of modules and pipelines whose rays are traced against such primitives, or against instances of a structure of them.
fn options(primitive: Primitive) -> PipelineOptions {
    PipelineOptions {
        graph: TraversableGraph::Both,
        payload_words: kernels::PAYLOAD_WORDS,
        primitives: match primitive {
            Primitive::Box => Primitives::CUSTOM,
            Primitive::Sphere => Primitives::SPHERES,
            Primitive::Triangle => Primitives::TRIANGLES,
        },
        ..PipelineOptions::default()
    }
}

/// Keeps warnings and errors.
fn collect(messages: Arc<Mutex<Vec<String>>>) -> LogCallback {
    Box::new(move |level, topic, text| {
        if level <= LogLevel::Warning {
            messages.lock().unwrap_or_else(PoisonError::into_inner).push(format!("{level:?}, {topic}: {text}"));
        }
    })
}

/// Turns an error of OptiX into the engine's.
pub(super) fn failed(doing: &str, error: optix_driver::Error) -> Error {
    Error::Device(format!("{doing}: {error}"))
}
