//! Program groups: the programs that one record of a shader binding table stands for.

use std::ffi::CStr;
use std::ptr;
use std::sync::Arc;

use crate::call::LogBuffer;
use crate::context::DeviceContext;
use crate::error::{Error, Result};
use crate::module::Module;
use crate::sys;

/// One program of a module.
#[derive(Clone, Copy, Debug)]
pub struct Program<'a> {
    module: &'a Arc<Module>,
    entry: Option<&'a CStr>,
}

impl<'a> Program<'a> {
    /// The program of this name, `__intersection__sphere` for example.
    pub fn new(module: &'a Arc<Module>, entry: &'a CStr) -> Self {
        Self { module, entry: Some(entry) }
    }

    /// The intersection program of [`Module::builtin_spheres`], which has no name.
    pub fn builtin(module: &'a Arc<Module>) -> Self {
        Self { module, entry: None }
    }

    fn lower(self) -> sys::Program {
        sys::Program { module: self.module.handle, entry: self.entry.map_or(ptr::null(), CStr::as_ptr) }
    }
}

/// The programs of a hitgroup. Triangles need no intersection program.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hitgroup<'a> {
    /// Runs once a ray, for its closest hit.
    pub closest_hit: Option<Program<'a>>,
    /// Runs for every hit on the way.
    pub any_hit: Option<Program<'a>>,
    /// Finds hits in a primitive's box.
    pub intersection: Option<Program<'a>>,
}

/// Which section of a shader binding table a group's records belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProgramGroupKind {
    /// Where a launch starts.
    Raygen,
    /// What runs if a ray hits nothing.
    Miss,
    /// What runs if a ray meets geometry.
    Hitgroup,
}

/// Programs that run together, from one or more modules.
#[derive(Debug)]
pub struct ProgramGroup {
    pub(crate) handle: sys::ProgramGroupHandle,
    pub(crate) context: Arc<DeviceContext>,
    kind: ProgramGroupKind,
    _modules: Vec<Arc<Module>>,
}

// SAFETY: a group is not changed after its creation and is destroyed by its only owner.
unsafe impl Send for ProgramGroup {}
// SAFETY: as above.
unsafe impl Sync for ProgramGroup {}

impl ProgramGroup {
    /// A ray generation program.
    ///
    /// # Errors
    /// [`Error::Call`], for an unknown entry with code 7001.
    pub fn raygen(program: Program<'_>) -> Result<Arc<Self>> {
        Self::create(&program.module.context, ProgramGroupKind::Raygen, [Some(program), None, None])
    }

    /// A miss program.
    ///
    /// # Errors
    /// [`Error::Call`], for an unknown entry with code 7001.
    pub fn miss(program: Program<'_>) -> Result<Arc<Self>> {
        Self::create(&program.module.context, ProgramGroupKind::Miss, [Some(program), None, None])
    }

    /// A miss group that does nothing.
    ///
    /// # Errors
    /// [`Error::Call`].
    pub fn empty_miss(context: &Arc<DeviceContext>) -> Result<Arc<Self>> {
        Self::create(context, ProgramGroupKind::Miss, [None; 3])
    }

    /// The programs for one kind of geometry; all may be absent.
    ///
    /// # Errors
    /// [`Error::Call`], for an unknown entry with code 7001; [`Error::ContextMismatch`] if a module was made from
    /// another context.
    pub fn hitgroup(context: &Arc<DeviceContext>, hitgroup: Hitgroup<'_>) -> Result<Arc<Self>> {
        let programs = [hitgroup.closest_hit, hitgroup.any_hit, hitgroup.intersection];
        Self::create(context, ProgramGroupKind::Hitgroup, programs)
    }

    /// Which section of a shader binding table the group's records belong to.
    pub fn kind(&self) -> ProgramGroupKind {
        self.kind
    }

    fn create(
        context: &Arc<DeviceContext>,
        kind: ProgramGroupKind,
        programs: [Option<Program<'_>>; 3],
    ) -> Result<Arc<Self>> {
        let modules: Vec<_> = programs.iter().flatten().map(|program| Arc::clone(program.module)).collect();
        if modules.iter().any(|module| !Arc::ptr_eq(&module.context, context)) {
            return Err(Error::ContextMismatch("a module of the program group"));
        }
        let absent = sys::Program { module: sys::ModuleHandle::NULL, entry: ptr::null() };
        let description = sys::ProgramGroupDesc {
            kind: match kind {
                ProgramGroupKind::Raygen => sys::GROUP_RAYGEN,
                ProgramGroupKind::Miss => sys::GROUP_MISS,
                ProgramGroupKind::Hitgroup => sys::GROUP_HITGROUP,
            },
            flags: 0,
            programs: programs.map(|program| program.map_or(absent, Program::lower)),
        };
        let options = sys::ProgramGroupOptions { payload_type: ptr::null() };
        let mut handle = sys::ProgramGroupHandle::NULL;
        let mut log = LogBuffer::new();
        let (log_text, log_size) = log.arguments();
        let table = context.table();
        // SAFETY: context and modules are alive and belong together; one description is named and one handle filled.
        let code = unsafe {
            (table.program_group_create)(context.handle, &description, 1, &options, log_text, log_size, &mut handle)
        };
        table.check_logged("optixProgramGroupCreate", code, log)?;
        Ok(Arc::new(Self { handle, context: Arc::clone(context), kind, _modules: modules }))
    }
}

impl Drop for ProgramGroup {
    fn drop(&mut self) {
        // SAFETY: the only owner of a live handle; pipelines made from it held an `Arc` and are destroyed.
        unsafe { (self.context.table().program_group_destroy)(self.handle) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock;

    #[test]
    fn each_kind_of_group_describes_its_programs_to_the_driver() {
        let context = mock::context();
        let (module, builtin) = (mock::module(&context), mock::module(&context));
        mock::take_calls();
        let program = |name| Program::new(&module, name);
        let groups = [
            ProgramGroup::raygen(program(c"__raygen__a")),
            ProgramGroup::miss(program(c"__miss__b")),
            ProgramGroup::empty_miss(&context),
            ProgramGroup::hitgroup(
                &context,
                Hitgroup {
                    closest_hit: None,
                    any_hit: Some(program(c"__anyhit__c")),
                    intersection: Some(Program::builtin(&builtin)),
                },
            ),
        ];
        assert_eq!(
            mock::calls(),
            [
                "optixProgramGroupCreate 1 kind=0x2421 [2:__raygen__a, -, -]",
                "optixProgramGroupCreate 1 kind=0x2422 [2:__miss__b, -, -]",
                "optixProgramGroupCreate 1 kind=0x2422 [-, -, -]",
                "optixProgramGroupCreate 1 kind=0x2424 [-, 2:__anyhit__c, 3:]",
            ]
        );
        use ProgramGroupKind::{Hitgroup as Hit, Miss, Raygen};
        assert_eq!(groups.map(|group| group.unwrap().kind()), [Raygen, Miss, Miss, Hit]);
    }

    #[test]
    fn an_unknown_entry_is_an_error_with_the_drivers_log() {
        let context = mock::context();
        let module = mock::module(&context);
        mock::fail("optixProgramGroupCreate", 7001, "entry not found");
        let error = ProgramGroup::raygen(Program::new(&module, c"__raygen__x")).unwrap_err();
        assert!(matches!(&error, Error::Call { code: 7001, log, .. } if log == "entry not found"), "{error}");
    }

    #[test]
    fn modules_of_another_context_are_refused() {
        let context = mock::context();
        let other = mock::another_context();
        let module = mock::module(&other);
        let any_hit = Some(Program::new(&module, c"__anyhit__x"));
        let error = ProgramGroup::hitgroup(&context, Hitgroup { any_hit, ..Default::default() }).unwrap_err();
        assert!(matches!(error, Error::ContextMismatch(_)), "{error}");
    }
}
