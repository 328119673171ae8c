//! Modules: compiled device programs.

use std::sync::Arc;

use crate::accel::AccelOptions;
use crate::call::LogBuffer;
use crate::context::DeviceContext;
use crate::error::Result;
use crate::options::{ModuleOptions, PipelineOptions};
use crate::sys;

/// Compiled programs, from PTX or built into the driver.
#[derive(Debug)]
pub struct Module {
    pub(crate) handle: sys::ModuleHandle,
    pub(crate) context: Arc<DeviceContext>,
    log: String,
}

// SAFETY: a module is not changed after its creation and is destroyed by its only owner.
unsafe impl Send for Module {}
// SAFETY: as above.
unsafe impl Sync for Module {}

impl Module {
    /// Compiles PTX source; takes hundreds of milliseconds, below one if the driver has it in its cache.
    ///
    /// The PTX is for an instruction set no newer than the GPU and in a version that the driver knows (8.2 for 535).
    ///
    /// # Errors
    /// [`Error::Call`](crate::Error::Call) with the compiler's log.
    pub fn from_ptx(
        context: &Arc<DeviceContext>,
        ptx: &str,
        options: ModuleOptions,
        pipeline: &PipelineOptions,
    ) -> Result<Arc<Self>> {
        let mut handle = sys::ModuleHandle::NULL;
        let mut log = LogBuffer::new();
        let (log_text, log_size) = log.arguments();
        let table = context.table();
        // SAFETY: the context is alive; options, source and log live during the call, with the lengths named.
        let code = unsafe {
            (table.module_create)(
                context.handle,
                &options.lower(),
                &pipeline.lower(),
                ptx.as_ptr().cast(),
                ptx.len(),
                log_text,
                log_size,
                &mut handle,
            )
        };
        let log = table.check_logged("optixModuleCreate", code, log)?;
        Ok(Arc::new(Self { handle, context: Arc::clone(context), log }))
    }

    /// The driver's intersection program for built-in spheres, for the
    /// [`intersection`](crate::Hitgroup::intersection) of a hitgroup.
    ///
    /// `accel` are the options that the spheres' acceleration structure is built with. Spheres are shells: a ray that
    /// starts and ends inside hits nothing.
    ///
    /// # Errors
    /// [`Error::Call`](crate::Error::Call).
    pub fn builtin_spheres(
        context: &Arc<DeviceContext>,
        options: ModuleOptions,
        pipeline: &PipelineOptions,
        accel: AccelOptions,
    ) -> Result<Arc<Self>> {
        let builtin = sys::BuiltinIsOptions {
            primitive: sys::BUILTIN_SPHERE,
            uses_motion: 0,
            build_flags: accel.flags(),
            end_cap_flags: 0,
        };
        let mut handle = sys::ModuleHandle::NULL;
        let table = context.table();
        // SAFETY: the context is alive, and the options live during the call.
        let code = unsafe {
            (table.builtin_is_module_get)(context.handle, &options.lower(), &pipeline.lower(), &builtin, &mut handle)
        };
        table.check("optixBuiltinISModuleGet", code)?;
        Ok(Arc::new(Self { handle, context: Arc::clone(context), log: String::new() }))
    }

    /// What the compiler had to say about a module that it accepted; often nothing.
    pub fn log(&self) -> &str {
        &self.log
    }
}

impl Drop for Module {
    fn drop(&mut self) {
        // SAFETY: the only owner of a live handle; groups made from it held an `Arc` and are destroyed.
        unsafe { (self.context.table().module_destroy)(self.handle) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::Preference;
    use crate::error::Error;
    use crate::mock;
    use crate::options::{Primitives, TraversableGraph};

    #[test]
    fn ptx_and_options_reach_the_compiler() {
        let context = mock::context();
        let pipeline = PipelineOptions {
            graph: TraversableGraph::Both,
            payload_words: 3,
            attribute_words: 4,
            primitives: Primitives::TRIANGLES,
            params_name: c"launch_params".to_owned(),
        };
        let module = Module::from_ptx(&context, ".version 8.2", ModuleOptions { max_registers: 64 }, &pipeline);
        assert_eq!(module.unwrap().log(), "");
        assert_eq!(
            mock::calls()[0],
            "optixModuleCreate 1 registers=64 graph=3 payload=3 attributes=4 params=launch_params \
             primitives=0x80000000 ptx=.version 8.2"
        );
    }

    #[test]
    fn the_compilers_log_is_in_the_error() {
        let context = mock::context();
        mock::fail("optixModuleCreate", 7200, "line 1: not PTX\n");
        let error = Module::from_ptx(&context, "?", ModuleOptions::default(), &PipelineOptions::default()).unwrap_err();
        let Error::Call { code, log, .. } = error else { panic!("another error") };
        assert_eq!((code, &*log), (7200, "line 1: not PTX"));
        assert_eq!(mock::calls().len(), 1, "nothing was made, so nothing is destroyed");
    }

    #[test]
    fn a_log_longer_than_its_buffer_is_cut_off() {
        let context = mock::context();
        mock::fail("optixModuleCreate", 7200, &"x".repeat(100_000));
        let error = Module::from_ptx(&context, "?", ModuleOptions::default(), &PipelineOptions::default()).unwrap_err();
        let Error::Call { log, .. } = error else { panic!("another error") };
        assert!(log.len() > 1000 && log.len() < 100_000 && log.bytes().all(|byte| byte == b'x'));
    }

    #[test]
    fn built_in_spheres_are_asked_for_with_the_build_flags_of_their_structure() {
        let context = mock::context();
        let accel = AccelOptions { allow_update: true, allow_compaction: false, preference: Preference::FastTrace };
        let pipeline = PipelineOptions { primitives: Primitives::SPHERES, ..Default::default() };
        drop(Module::builtin_spheres(&context, ModuleOptions::default(), &pipeline, accel).unwrap());
        assert_eq!(
            mock::calls(),
            ["optixBuiltinISModuleGet 1 primitive=0x2506 flags=5 primitives=0x40", "optixModuleDestroy 2"]
        );
    }
}
