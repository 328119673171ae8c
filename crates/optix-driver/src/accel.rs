//! Acceleration structures: sizes, build, update, compaction.

use std::ffi::c_void;
use std::ptr;

use crate::build_input::BuildInput;
use crate::context::DeviceContext;
use crate::device_span::DeviceSpan;
use crate::error::{Error, Result, to_u32};
use crate::sys;

/// How an acceleration structure is built. The same options go to sizes, build and updates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AccelOptions {
    /// Allows [`update`](DeviceContext::accel_update).
    pub allow_update: bool,
    /// Allows [`compaction`](DeviceContext::accel_compact).
    pub allow_compaction: bool,
    /// What to spend time on.
    pub preference: Preference,
}

/// What to spend time on: building or tracing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preference {
    /// The driver's choice.
    #[default]
    None,
    /// A hierarchy that rays pass faster.
    FastTrace,
    /// A hierarchy that is built in about half the time.
    FastBuild,
}

impl AccelOptions {
    pub(crate) fn flags(self) -> u32 {
        let flag = |set: bool, flag: u32| if set { flag } else { 0 };
        flag(self.allow_update, sys::BUILD_ALLOW_UPDATE)
            | flag(self.allow_compaction, sys::BUILD_ALLOW_COMPACTION)
            | flag(self.preference == Preference::FastTrace, sys::BUILD_FAST_TRACE)
            | flag(self.preference == Preference::FastBuild, sys::BUILD_FAST_BUILD)
    }

    fn lower(self, operation: u32) -> sys::AccelOptions {
        sys::AccelOptions { flags: self.flags(), operation, motion: [0; 3] }
    }
}

/// Device memory that an acceleration structure needs, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccelSizes {
    /// For the structure.
    pub output: usize,
    /// Scratch during a build.
    pub temp: usize,
    /// Scratch during an update.
    pub temp_update: usize,
}

/// What rays are traced against: goes into launch parameters and instances. Zero stands for no geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(transparent)]
pub struct TraversableHandle(
    /// The driver's handle.
    pub u64,
);

impl DeviceContext {
    /// Memory for a structure over `inputs`; looks at counts and formats only, not at device memory.
    ///
    /// # Errors
    /// [`Error::Call`]; [`Error::TooLarge`] for more than 2³² inputs.
    pub fn accel_sizes(&self, options: AccelOptions, inputs: &[BuildInput]) -> Result<AccelSizes> {
        let lowered = lower_all(inputs);
        let count = to_u32("build inputs", lowered.len())?;
        let mut sizes = sys::AccelSizes::default();
        let options = options.lower(sys::OPERATION_BUILD);
        let function = self.table().accel_compute_memory_usage;
        // SAFETY: the context is alive; options and inputs live during the call.
        let code = unsafe { function(self.handle, &options, lowered.as_ptr(), count, &mut sizes) };
        self.table().check("optixAccelComputeMemoryUsage", code)?;
        Ok(AccelSizes { output: sizes.output, temp: sizes.temp, temp_update: sizes.temp_update })
    }

    /// Builds a structure over `inputs` into `output`.
    ///
    /// With `compacted_size`, the device address of a `u64`, the size after compaction is written there.
    ///
    /// # Errors
    /// [`Error::Call`], for too little memory also; [`Error::CompactionNotAllowed`] if a compacted size is asked for
    /// without [`allow_compaction`](AccelOptions::allow_compaction).
    ///
    /// # Safety
    /// - `stream` is a `CUstream` of this CUDA context and does not capture a graph.
    /// - The memory of `inputs`, `temp`, `output` and `compacted_size` is valid until the stream has done this work,
    ///   and nothing else writes to it meanwhile.
    /// - `temp` and `output` are 128-byte aligned, do not overlap and are as large as
    ///   [`accel_sizes`](Self::accel_sizes) says.
    /// - `output` keeps the structure: it stays valid and untouched while the handle is used.
    pub unsafe fn accel_build(
        &self,
        stream: *mut c_void,
        options: AccelOptions,
        inputs: &[BuildInput],
        temp: DeviceSpan,
        output: DeviceSpan,
        compacted_size: Option<u64>,
    ) -> Result<TraversableHandle> {
        if compacted_size.is_some() && !options.allow_compaction {
            return Err(Error::CompactionNotAllowed);
        }
        let emit = compacted_size.map(|result| sys::Emit { result, kind: sys::EMIT_COMPACTED_SIZE });
        // SAFETY: the caller promises it.
        unsafe { self.accel_work(stream, options.lower(sys::OPERATION_BUILD), inputs, temp, output, emit) }
    }

    /// Fits the structure in `output` to changed coordinates (a refit): same number and kind of primitives, same
    /// topology. Far cheaper than a build; rays get slower as primitives move away from where they were built.
    ///
    /// An instance structure above it is to be updated or built again.
    ///
    /// # Errors
    /// [`Error::Call`]; [`Error::UpdateNotAllowed`] without [`allow_update`](AccelOptions::allow_update).
    ///
    /// # Safety
    /// As for [`accel_build`](Self::accel_build), with [`temp_update`](AccelSizes::temp_update) bytes of `temp`; and
    /// - `output` holds a structure that was built with the same options and the same counts, formats and strides.
    pub unsafe fn accel_update(
        &self,
        stream: *mut c_void,
        options: AccelOptions,
        inputs: &[BuildInput],
        temp: DeviceSpan,
        output: DeviceSpan,
    ) -> Result<TraversableHandle> {
        if !options.allow_update {
            return Err(Error::UpdateNotAllowed);
        }
        // SAFETY: the caller promises it.
        unsafe { self.accel_work(stream, options.lower(sys::OPERATION_UPDATE), inputs, temp, output, None) }
    }

    /// Copies a structure without its gaps into `output`; the old memory is free for other use after that.
    ///
    /// # Errors
    /// [`Error::Call`].
    ///
    /// # Safety
    /// - `stream` is a `CUstream` of this CUDA context and does not capture a graph.
    /// - `handle` is a structure of this context that was built with
    ///   [`allow_compaction`](AccelOptions::allow_compaction); it stays valid until the stream has done this work.
    /// - `output` is 128-byte aligned, does not overlap the structure and is as large as the compacted size that its
    ///   build wrote. It stays valid and untouched while the new handle is used.
    pub unsafe fn accel_compact(
        &self,
        stream: *mut c_void,
        handle: TraversableHandle,
        output: DeviceSpan,
    ) -> Result<TraversableHandle> {
        let mut compacted = TraversableHandle(0);
        let function = self.table().accel_compact;
        // SAFETY: the context is alive; the caller promises the rest.
        let code = unsafe { function(self.handle, stream, handle.0, output.address, output.bytes, &mut compacted.0) };
        self.table().check("optixAccelCompact", code)?;
        Ok(compacted)
    }

    /// # Safety
    /// As for [`accel_build`](Self::accel_build).
    unsafe fn accel_work(
        &self,
        stream: *mut c_void,
        options: sys::AccelOptions,
        inputs: &[BuildInput],
        temp: DeviceSpan,
        output: DeviceSpan,
        emit: Option<sys::Emit>,
    ) -> Result<TraversableHandle> {
        let lowered = lower_all(inputs);
        let count = to_u32("build inputs", lowered.len())?;
        let mut handle = TraversableHandle(0);
        let function = self.table().accel_build;
        // SAFETY: the context is alive; options, inputs and emit live during the call, with the counts named; the
        // caller promises the rest.
        let code = unsafe {
            function(
                self.handle,
                stream,
                &options,
                lowered.as_ptr(),
                count,
                temp.address,
                temp.bytes,
                output.address,
                output.bytes,
                &mut handle.0,
                emit.as_ref().map_or(ptr::null(), ptr::from_ref),
                u32::from(emit.is_some()),
            )
        };
        self.table().check("optixAccelBuild", code)?;
        Ok(handle)
    }
}

/// For the driver; points into `inputs`.
fn lower_all(inputs: &[BuildInput]) -> Vec<sys::BuildInput> {
    inputs.iter().map(BuildInput::lower).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build_input::{Aabbs, AnyHit};
    use crate::mock;

    const TEMP: DeviceSpan = DeviceSpan { address: 0x8000, bytes: 48 };
    const OUTPUT: DeviceSpan = DeviceSpan { address: 0x10000, bytes: 80 };
    const STREAM: *mut c_void = ptr::without_provenance_mut(0x57);
    const UPDATABLE: AccelOptions =
        AccelOptions { allow_update: true, allow_compaction: false, preference: Preference::FastTrace };

    fn boxes() -> [BuildInput; 1] {
        [BuildInput::Aabbs(Aabbs { buffer: 0x1000, count: 5, stride: 24, any_hit: AnyHit::Always })]
    }

    #[test]
    fn options_are_the_drivers_flags() {
        let compact = AccelOptions { allow_compaction: true, preference: Preference::FastBuild, ..Default::default() };
        assert_eq!([AccelOptions::default(), UPDATABLE, compact].map(AccelOptions::flags), [0, 1 | 4, 2 | 8]);
    }

    #[test]
    fn sizes_come_from_the_driver() {
        let sizes = mock::context().accel_sizes(UPDATABLE, &boxes()).unwrap();
        assert_eq!(sizes, AccelSizes { output: 400, temp: 240, temp_update: 120 });
        assert_eq!(
            mock::calls(),
            [
                "optixAccelComputeMemoryUsage 1 flags=5 operation=0x2161 \
                 [custom 0x1000 n=5 stride=24 flags=0 records=1]",
                "optixDeviceContextDestroy 1"
            ]
        );
    }

    #[test]
    fn a_build_passes_memory_inputs_and_stream() {
        let context = mock::context();
        // SAFETY: the mock touches no device memory.
        let handle = unsafe { context.accel_build(STREAM, UPDATABLE, &boxes(), TEMP, OUTPUT, None) };
        assert_eq!(handle, Ok(TraversableHandle(OUTPUT.address + 1)));
        assert_eq!(
            mock::calls(),
            ["optixAccelBuild 1 stream=0x57 flags=5 operation=0x2161 \
              [custom 0x1000 n=5 stride=24 flags=0 records=1] temp=0x8000+48 output=0x10000+80 emit=[]"]
        );
    }

    #[test]
    fn an_update_is_a_build_with_another_operation() {
        let context = mock::context();
        // SAFETY: the mock touches no device memory.
        unsafe { context.accel_update(STREAM, UPDATABLE, &boxes(), TEMP, OUTPUT) }.unwrap();
        assert!(mock::calls()[0].contains(" flags=5 operation=0x2162 "), "{:?}", mock::calls());
    }

    #[test]
    fn an_update_that_was_not_allowed_never_reaches_the_driver() {
        let context = mock::context();
        // SAFETY: the mock touches no device memory.
        let result = unsafe { context.accel_update(STREAM, AccelOptions::default(), &boxes(), TEMP, OUTPUT) };
        assert_eq!(result, Err(Error::UpdateNotAllowed));
        assert!(mock::calls().is_empty());
    }

    #[test]
    fn a_compacted_size_is_asked_for_where_it_is_allowed() {
        let context = mock::context();
        let options = AccelOptions { allow_compaction: true, ..Default::default() };
        let build = |options| {
            // SAFETY: the mock touches no device memory.
            unsafe { context.accel_build(STREAM, options, &boxes(), TEMP, OUTPUT, Some(0x4000)) }
        };
        build(options).unwrap();
        assert!(mock::calls()[0].ends_with("emit=[0x4000:0x2181]"), "{:?}", mock::calls());
        assert_eq!(build(UPDATABLE), Err(Error::CompactionNotAllowed));
    }

    #[test]
    fn compaction_copies_a_structure_to_other_memory() {
        let context = mock::context();
        // SAFETY: the mock touches no device memory.
        let compacted = unsafe { context.accel_compact(STREAM, TraversableHandle(0x77), OUTPUT) };
        assert_eq!(compacted, Ok(TraversableHandle(OUTPUT.address + 1)));
        assert_eq!(mock::calls(), ["optixAccelCompact 1 stream=0x57 handle=0x77 output=0x10000+80"]);
    }

    #[test]
    fn a_failed_build_is_an_error() {
        let context = mock::context();
        mock::fail("optixAccelBuild", 7900, "");
        // SAFETY: the mock touches no device memory.
        let result = unsafe { context.accel_build(STREAM, UPDATABLE, &boxes(), TEMP, OUTPUT, None) };
        assert!(matches!(result, Err(Error::Call { function: "optixAccelBuild", code: 7900, .. })), "{result:?}");
    }
}
