//! The compiled kernels, called by name: the only foreign functions of this crate.

use crate::tree::{Point, Visit};
use nearfield_core::{Error, Result};
use nearfield_cuda::gpu::{Launch, Trace};
use std::ffi::{CStr, CString, c_char, c_void};

/// Visits the boxes around a point; why not, where that fails.
pub type Traverse =
    unsafe extern "C" fn(scene: *const c_void, handle: u64, x: f32, y: f32, z: f32, visit: Visit) -> *const c_char;

/// What rays are traced against.
pub trait Scene {
    /// Calls `visit` for each box of the structure behind `handle` that holds the point.
    fn traverse(&self, handle: u64, point: Point, visit: Visit) -> std::result::Result<(), &'static CStr>;
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
    let (module, raygen, intersection) = (text(trace.module)?, text(trace.raygen)?, text(trace.intersection)?);
    let Trace { rays, parameters, .. } = trace;
    call(|error, capacity| {
        // SAFETY: as in `launch`; the scene outlives the call and is of the type that `traverse` takes it for.
        unsafe {
            ffi::nearfield_emulator_trace(
                module.as_ptr(),
                raygen.as_ptr(),
                intersection.as_ptr(),
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
/// `scene` is of an `S`.
unsafe extern "C" fn traverse<S: Scene>(
    scene: *const c_void,
    handle: u64,
    x: f32,
    y: f32,
    z: f32,
    visit: Visit,
) -> *const c_char {
    // SAFETY: the caller's promise.
    let scene = unsafe { &*scene.cast::<S>() };
    match scene.traverse(handle, [x, y, z], visit) {
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
            intersection: *const c_char,
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
