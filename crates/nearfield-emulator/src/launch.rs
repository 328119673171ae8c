//! The compiled kernels, called by name: the only foreign functions of this crate.

use nearfield_core::{Error, Result};
use nearfield_cuda::gpu::{Launch, Trace};
use nearfield_kernels::Primitive;
use std::ffi::{CStr, CString, c_char, c_void};

/// A ray, or what there is of it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    pub origin: [f32; 3],
    /// Of length 1.
    pub direction: [f32; 3],
    pub length: f32,
}

/// Called with the numbers of a primitive and of its instance, and how far along the ray it is met.
pub type Visit = unsafe extern "C" fn(primitive: u32, instance: u32, distance: f32);

/// Visits what a ray meets; why not, where that fails.
pub type Traverse =
    unsafe extern "C" fn(scene: *const c_void, handle: u64, segment: *const Segment, visit: Visit) -> *const c_char;

/// What rays are traced against.
pub trait Scene {
    /// Calls `visit` for each primitive of the structure behind `handle` that the ray meets.
    fn traverse(&self, handle: u64, segment: &Segment, visit: Visit) -> std::result::Result<(), &'static CStr>;
}

/// Bytes for the text of an error.
const TEXT: usize = 512;

/// Runs a kernel.
///
/// # Safety
/// The addresses in the arguments are of memory as large as the kernel takes it to be, and nothing else uses it.
pub unsafe fn launch(launch: Launch) -> Result<()> {
    let (module, name) = (text(launch.module)?, text(launch.name)?);
    let Launch { blocks, threads, arguments, .. } = launch;
    call(|error, capacity| {
        // SAFETY: texts end with zero, lengths belong to their arrays, and the caller's promise for the arguments.
        unsafe {
            ffi::nearfield_emulator_launch(
                module.as_ptr(),
                name.as_ptr(),
                blocks,
                threads,
                arguments.as_ptr().cast(),
                arguments.len(),
                error,
                capacity,
            )
        }
    })
}

/// Runs ray-tracing programs.
///
/// # Safety
/// As [`launch`].
pub unsafe fn trace<S: Scene>(trace: Trace, scene: &S) -> Result<()> {
    let (module, raygen, hit) = (text(trace.module)?, text(trace.raygen)?, text(trace.hit)?);
    let Trace { rays, parameters, primitive, .. } = trace;
    call(|error, capacity| {
        // SAFETY: as in `launch`; the scene outlives the call and is of the type that `traverse` takes it for.
        unsafe {
            ffi::nearfield_emulator_trace(
                module.as_ptr(),
                raygen.as_ptr(),
                hit.as_ptr(),
                primitive != Primitive::Box,
                rays,
                parameters.as_ptr().cast(),
                parameters.len(),
                traverse::<S>,
                (&raw const *scene).cast(),
                error,
                capacity,
            )
        }
    })
}

/// # Safety
/// `scene` is of an `S`, and `segment` is valid.
unsafe extern "C" fn traverse<S: Scene>(
    scene: *const c_void,
    handle: u64,
    segment: *const Segment,
    visit: Visit,
) -> *const c_char {
    // SAFETY: the caller's promise.
    let (scene, segment) = unsafe { (&*scene.cast::<S>(), &*segment) };
    match scene.traverse(handle, segment, visit) {
        Ok(()) => std::ptr::null(),
        Err(text) => text.as_ptr(),
    }
}

fn text(name: &str) -> Result<CString> {
    CString::new(name).map_err(|_| Error::Device(format!("{name:?} is no name of a kernel")))
}

fn call(function: impl FnOnce(*mut c_char, usize) -> bool) -> Result<()> {
    let mut error = [0u8; TEXT];
    if function(error.as_mut_ptr().cast(), error.len()) {
        return Ok(());
    }
    let text = CStr::from_bytes_until_nul(&error).map(CStr::to_string_lossy).unwrap_or_default();
    Err(Error::Device(text.into_owned()))
}

#[cfg(host_compiler)]
mod ffi {
    use super::{Traverse, c_char, c_void};

    unsafe extern "C" {
        pub fn nearfield_emulator_launch(
            module: *const c_char,
            name: *const c_char,
            blocks: u32,
            threads: u32,
            arguments: *const c_void,
            size: usize,
            error: *mut c_char,
            capacity: usize,
        ) -> bool;

        pub fn nearfield_emulator_trace(
            module: *const c_char,
            raygen: *const c_char,
            hit: *const c_char,
            anyhit: bool,
            rays: u32,
            parameters: *const c_void,
            size: usize,
            traverse: Traverse,
            scene: *const c_void,
            error: *mut c_char,
            capacity: usize,
        ) -> bool;
    }
}

/// Without compiled kernels every call fails; [`crate::Emulator::new`] does before.
#[cfg(not(host_compiler))]
#[expect(clippy::too_many_arguments, reason = "the signatures of the foreign functions")]
mod ffi {
    use super::{Traverse, c_char, c_void};

    pub unsafe fn nearfield_emulator_launch(
        _: *const c_char,
        _: *const c_char,
        _: u32,
        _: u32,
        _: *const c_void,
        _: usize,
        _: *mut c_char,
        _: usize,
    ) -> bool {
        false
    }

    pub unsafe fn nearfield_emulator_trace(
        _: *const c_char,
        _: *const c_char,
        _: *const c_char,
        _: bool,
        _: u32,
        _: *const c_void,
        _: usize,
        _: Traverse,
        _: *const c_void,
        _: *mut c_char,
        _: usize,
    ) -> bool {
        false
    }
}
