//! Launches: one thread of the ray generation program for each index.

use std::ffi::c_void;

use crate::device_span::DeviceSpan;
use crate::error::Result;
use crate::pipeline::Pipeline;
use crate::sbt::ShaderBindingTable;

impl Pipeline {
    /// Runs the ray generation program for every index of a `width` x `height` x `depth` grid, of at most 2³⁰ indices.
    ///
    /// `params` are the launch parameters in device memory; they are copied, in stream order, before the programs run.
    /// Costs about 20 µs of processor time. **Cannot be captured into a CUDA graph**: see the crate's documentation.
    ///
    /// # Errors
    /// [`Error::Call`](crate::Error::Call); parameters larger than the `__constant__` variable are among the reasons.
    ///
    /// # Safety
    /// - `stream` is a `CUstream` of this CUDA context and does not capture a graph.
    /// - `sbt` was uploaded to where it says, from groups of this pipeline.
    /// - `params`, the table, and every address that programs reach through them are valid until the stream has done
    ///   this work, and nothing else writes to what the programs read meanwhile.
    /// - No other launch of this pipeline runs at the same time, on another stream or from another thread: launches of
    ///   one pipeline share its copy of the parameters. Concurrent launches need a pipeline each.
    pub unsafe fn launch(
        &self,
        stream: *mut c_void,
        params: DeviceSpan,
        sbt: &ShaderBindingTable,
        [width, height, depth]: [u32; 3],
    ) -> Result<()> {
        let table = self.context.table();
        // SAFETY: the pipeline is alive, the table's description lives during the call; the caller promises the rest.
        let code =
            unsafe { (table.launch)(self.handle, stream, params.address, params.bytes, &sbt.0, width, height, depth) };
        table.check("optixLaunch", code)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::error::Error;
    use crate::mock;
    use crate::options::PipelineOptions;
    use crate::program_group::{Program, ProgramGroup};
    use crate::sbt::{SbtImage, SbtRecord};

    fn launch() -> (Arc<Pipeline>, ShaderBindingTable) {
        let context = mock::context();
        let module = mock::module(&context);
        let raygen = ProgramGroup::raygen(Program::new(&module, c"__raygen__a")).unwrap();
        let miss = ProgramGroup::empty_miss(&context).unwrap();
        let image = SbtImage::new(SbtRecord::new(&raygen), &[SbtRecord::new(&miss)], &[]).unwrap();
        let pipeline = Pipeline::new(&context, &PipelineOptions::default(), &[raygen, miss]).unwrap();
        mock::take_calls();
        (pipeline, image.at(0x7000).unwrap())
    }

    const PARAMS: DeviceSpan = DeviceSpan { address: 0x9000, bytes: 72 };

    #[test]
    fn a_launch_passes_stream_parameters_table_and_size() {
        let (pipeline, sbt) = launch();
        let stream = std::ptr::without_provenance_mut(0x57);
        // SAFETY: the mock touches no device memory.
        unsafe { pipeline.launch(stream, PARAMS, &sbt, [1000, 2, 1]) }.unwrap();
        assert_eq!(
            mock::calls(),
            ["optixLaunch 5 stream=0x57 params=0x9000+72 raygen=0x7000 miss=0x7020/32x1 hit=0x0/0x0 1000x2x1"]
        );
    }

    #[test]
    fn a_failed_launch_is_an_error() {
        let (pipeline, sbt) = launch();
        mock::fail("optixLaunch", 7900, "");
        // SAFETY: the mock touches no device memory.
        let result = unsafe { pipeline.launch(std::ptr::null_mut(), PARAMS, &sbt, [1; 3]) };
        assert!(matches!(result, Err(Error::Call { function: "optixLaunch", code: 7900, .. })), "{result:?}");
    }
}
