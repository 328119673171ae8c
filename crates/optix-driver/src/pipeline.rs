//! Pipelines: program groups linked into something that can be launched.

use std::sync::Arc;

use crate::call::LogBuffer;
use crate::context::DeviceContext;
use crate::error::{Error, Result, to_u32};
use crate::options::PipelineOptions;
use crate::program_group::ProgramGroup;
use crate::sys;

/// Rays are traced from the ray generation program only, never from a hit or miss program.
const MAX_TRACE_DEPTH: u32 = 1;

/// Linked programs, with stacks as large as they need and no larger.
#[derive(Debug)]
pub struct Pipeline {
    pub(crate) handle: sys::PipelineHandle,
    pub(crate) context: Arc<DeviceContext>,
    log: String,
    _groups: Vec<Arc<ProgramGroup>>,
}

// SAFETY: a pipeline is not changed after its creation and is destroyed by its only owner. Launches of one pipeline
// must not run at the same time, which is part of the contract of the unsafe `launch`.
unsafe impl Send for Pipeline {}
// SAFETY: as above.
unsafe impl Sync for Pipeline {}

impl Pipeline {
    /// Links `groups`, whose modules were made with equal `options`, for rays traced from ray generation only.
    ///
    /// # Errors
    /// [`Error::Call`] with the linker's log; [`Error::ContextMismatch`] if a group was made from another context.
    pub fn new(
        context: &Arc<DeviceContext>,
        options: &PipelineOptions,
        groups: &[Arc<ProgramGroup>],
    ) -> Result<Arc<Self>> {
        if groups.iter().any(|group| !Arc::ptr_eq(&group.context, context)) {
            return Err(Error::ContextMismatch("a program group of the pipeline"));
        }
        let handles: Vec<_> = groups.iter().map(|group| group.handle).collect();
        let count = to_u32("program groups", handles.len())?;
        let link = sys::LinkOptions { max_trace_depth: MAX_TRACE_DEPTH };
        let mut handle = sys::PipelineHandle::NULL;
        let mut log = LogBuffer::new();
        let (log_text, log_size) = log.arguments();
        let table = context.table();
        // SAFETY: context and groups are alive and belong together; all arguments live during the call.
        let code = unsafe {
            (table.pipeline_create)(
                context.handle,
                &options.lower(),
                &link,
                handles.as_ptr(),
                count,
                log_text,
                log_size,
                &mut handle,
            )
        };
        let log = table.check_logged("optixPipelineCreate", code, log)?;
        let pipeline = Self { handle, context: Arc::clone(context), log, _groups: groups.to_vec() };
        pipeline.set_stack_sizes(groups, options.graph.depth())?;
        Ok(Arc::new(pipeline))
    }

    /// What the linker had to say about a pipeline that it accepted; often nothing.
    pub fn log(&self) -> &str {
        &self.log
    }

    fn set_stack_sizes(&self, groups: &[Arc<ProgramGroup>], graph_depth: u32) -> Result<()> {
        let table = self.context.table();
        let mut largest = sys::StackSizes::default();
        for group in groups {
            let mut sizes = sys::StackSizes::default();
            // SAFETY: group and pipeline are alive, and the group is part of the pipeline.
            let code = unsafe { (table.program_group_get_stack_size)(group.handle, &mut sizes, self.handle) };
            table.check("optixProgramGroupGetStackSize", code)?;
            largest = maximum(largest, sizes);
        }
        // SAFETY: the pipeline is alive, and no launch of it can have been asked for yet.
        let code =
            unsafe { (table.pipeline_set_stack_size)(self.handle, 0, 0, continuation_stack(largest), graph_depth) };
        table.check("optixPipelineSetStackSize", code)
    }
}

impl Drop for Pipeline {
    fn drop(&mut self) {
        // SAFETY: the only owner of a live handle.
        unsafe { (self.context.table().pipeline_destroy)(self.handle) };
    }
}

fn maximum(a: sys::StackSizes, b: sys::StackSizes) -> sys::StackSizes {
    sys::StackSizes {
        raygen: a.raygen.max(b.raygen),
        miss: a.miss.max(b.miss),
        closest_hit: a.closest_hit.max(b.closest_hit),
        any_hit: a.any_hit.max(b.any_hit),
        intersection: a.intersection.max(b.intersection),
        continuation_callable: a.continuation_callable.max(b.continuation_callable),
        direct_callable: a.direct_callable.max(b.direct_callable),
    }
}

/// Bytes of continuation stack for trace depth 1: ray generation waits while a miss, a closest hit, or an any-hit
/// within an intersection runs. Takes the largest of each kind of program; without callables.
fn continuation_stack(largest: sys::StackSizes) -> u32 {
    let traversal = largest.intersection.saturating_add(largest.any_hit);
    largest.raygen.saturating_add(largest.miss.max(largest.closest_hit).max(traversal))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock;
    use crate::options::TraversableGraph;
    use crate::program_group::{Hitgroup, Program};

    fn groups(context: &Arc<DeviceContext>) -> Vec<Arc<ProgramGroup>> {
        let module = mock::module(context);
        vec![
            ProgramGroup::raygen(Program::new(&module, c"__raygen__a")).unwrap(),
            ProgramGroup::empty_miss(context).unwrap(),
            ProgramGroup::hitgroup(context, Hitgroup::default()).unwrap(),
        ]
    }

    #[test]
    fn the_continuation_stack_holds_the_deepest_chain_of_programs() {
        let sizes = |raygen, miss, closest_hit, any_hit, intersection| {
            let sizes = sys::StackSizes { raygen, miss, closest_hit, any_hit, intersection, ..Default::default() };
            continuation_stack(sizes)
        };
        assert_eq!(sizes(100, 0, 0, 0, 0), 100);
        assert_eq!(sizes(100, 32, 16, 8, 8), 132);
        assert_eq!(sizes(100, 16, 32, 8, 8), 132);
        assert_eq!(sizes(100, 16, 16, 24, 40), 164);
        assert_eq!(sizes(u32::MAX, 1, 0, 0, 0), u32::MAX);
    }

    #[test]
    fn a_pipeline_is_linked_for_depth_one_and_gets_the_stack_it_needs() {
        let context = mock::context();
        let groups = groups(&context);
        mock::take_calls();
        // The mock's n-th handle has raygen 10n, any-hit 2n and intersection 3n: the largest is group 5.
        drop(Pipeline::new(&context, &PipelineOptions::default(), &groups).unwrap());
        assert_eq!(
            mock::calls(),
            [
                "optixPipelineCreate 1 depth=1 graph=1 groups=[3, 4, 5]",
                "optixProgramGroupGetStackSize 3 pipeline=6",
                "optixProgramGroupGetStackSize 4 pipeline=6",
                "optixProgramGroupGetStackSize 5 pipeline=6",
                "optixPipelineSetStackSize 6 direct=0,0 continuation=75 depth=1",
                "optixPipelineDestroy 6",
            ]
        );
    }

    #[test]
    fn instancing_makes_the_traversable_graph_one_deeper() {
        let context = mock::context();
        let options = PipelineOptions { graph: TraversableGraph::Both, ..Default::default() };
        let _pipeline = Pipeline::new(&context, &options, &groups(&context)).unwrap();
        assert!(mock::calls().last().unwrap().ends_with("depth=2"));
    }

    #[test]
    fn a_failure_after_linking_destroys_the_pipeline() {
        let context = mock::context();
        let groups = groups(&context);
        mock::fail("optixPipelineSetStackSize", 7001, "");
        let error = Pipeline::new(&context, &PipelineOptions::default(), &groups).unwrap_err();
        assert!(matches!(error, Error::Call { function: "optixPipelineSetStackSize", .. }), "{error}");
        assert_eq!(mock::calls().last().unwrap(), "optixPipelineDestroy 6");
    }

    #[test]
    fn the_linkers_log_is_in_the_error() {
        let context = mock::context();
        mock::fail("optixPipelineCreate", 7251, "link error");
        let error = Pipeline::new(&context, &PipelineOptions::default(), &groups(&context)).unwrap_err();
        assert!(matches!(&error, Error::Call { log, .. } if log == "link error"), "{error}");
    }

    #[test]
    fn groups_of_another_context_are_refused() {
        let context = mock::context();
        let other = mock::another_context();
        let error = Pipeline::new(&context, &PipelineOptions::default(), &groups(&other)).unwrap_err();
        assert!(matches!(error, Error::ContextMismatch(_)), "{error}");
    }

    #[test]
    fn what_a_pipeline_was_made_from_outlives_it_and_is_destroyed_after_it() {
        let context = mock::context();
        let groups = groups(&context);
        let pipeline = Pipeline::new(&context, &PipelineOptions::default(), &groups).unwrap();
        mock::take_calls();
        drop(context);
        drop(groups);
        assert!(mock::calls().is_empty());
        drop(pipeline);
        assert_eq!(
            mock::calls(),
            [
                "optixPipelineDestroy 6",
                "optixProgramGroupDestroy 3",
                "optixModuleDestroy 2",
                "optixProgramGroupDestroy 4",
                "optixProgramGroupDestroy 5",
                "optixDeviceContextDestroy 1",
            ]
        );
    }
}
