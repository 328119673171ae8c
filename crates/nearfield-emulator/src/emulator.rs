//! The emulated device.

use crate::{
    available,
    clock::Moment,
    launch,
    memory::Heap,
    tracing::{Acceleration, Seen, Structures},
};
use nearfield_core::{Error, Result};
use nearfield_cuda::{
    Sequence,
    gpu::{AccelerationStructure, Gpu, Launch, Mark, Memory, Queue, RayTracing, Trace},
};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Memory of a device without a stated limit, \[bytes\].
const MEMORY: u64 = 4 << 30;

/// A GPU whose kernels run on the host, in the calls that enqueue them.
pub struct Emulator {
    shared: Arc<Shared>,
}

/// What the device and its acceleration structures share; calls take turns, as in a stream.
pub struct Shared(Mutex<State>);

/// Content of the device.
pub struct State {
    pub heap: Heap,
    pub structures: Structures,
}

impl Shared {
    pub fn lock(&self) -> MutexGuard<'_, State> {
        // A call that panicked has changed nothing halfway: others may go on.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Emulator {
    /// A device with 4 GiB.
    ///
    /// # Errors
    /// [`Error::Device`] where kernels were not compiled for the host; see [`available`].
    pub fn new() -> Result<Self> {
        Self::with_memory(MEMORY)
    }

    /// A device with so many bytes, of which buffers and acceleration structures take theirs.
    ///
    /// # Errors
    /// As [`Emulator::new`].
    pub fn with_memory(bytes: u64) -> Result<Self> {
        if !available() {
            return Err(Error::Device("GPU kernels are emulated only where there is a C++ compiler".into()));
        }
        let state = State { heap: Heap::new(bytes), structures: Structures::default() };
        Ok(Self { shared: Arc::new(Shared(Mutex::new(state))) })
    }
}

impl Queue for Emulator {
    unsafe fn launch(&self, launch: Launch) -> Result<()> {
        let _turn = self.shared.lock();
        // SAFETY: the caller's promise, and other calls wait for their turn.
        unsafe { launch::launch(launch) }
    }

    unsafe fn fill(&self, to: u64, value: u8, bytes: usize) -> Result<()> {
        let state = self.shared.lock();
        let to = state.heap.range("fill", to, bytes)?;
        // SAFETY: the range is within a buffer.
        unsafe { to.as_ptr().write_bytes(value, bytes) }
        Ok(())
    }
}

impl Gpu for Emulator {
    fn name(&self) -> String {
        "emulator".into()
    }

    fn memory(&self) -> Result<Memory> {
        Ok(self.shared.lock().heap.memory())
    }

    fn allocate(&self, what: &'static str, bytes: usize) -> Result<u64> {
        self.shared.lock().heap.allocate(what, bytes)
    }

    unsafe fn release(&self, address: u64) {
        self.shared.lock().heap.release(address);
    }

    unsafe fn upload(&self, data: &[u8], to: u64) -> Result<()> {
        let state = self.shared.lock();
        let to = state.heap.range("upload", to, data.len())?;
        // SAFETY: the range is within a buffer, and host data is not in one.
        unsafe { to.as_ptr().copy_from_nonoverlapping(data.as_ptr(), data.len()) }
        Ok(())
    }

    unsafe fn download(&self, from: u64, data: &mut [u8]) -> Result<()> {
        let mut state = self.shared.lock();
        state.heap.check()?;
        let from = state.heap.range("download", from, data.len())?;
        // SAFETY: as for upload.
        unsafe { data.as_mut_ptr().copy_from_nonoverlapping(from.as_ptr(), data.len()) }
        Ok(())
    }

    unsafe fn copy(&self, from: u64, to: u64, bytes: usize) -> Result<()> {
        if from.abs_diff(to) < bytes as u64 {
            return Err(Error::Device(format!("copy of {bytes} bytes from {from:#x} to {to:#x}: they overlap")));
        }
        let state = self.shared.lock();
        let (from, to) = (state.heap.range("copy", from, bytes)?, state.heap.range("copy", to, bytes)?);
        // SAFETY: the ranges are within buffers and do not overlap.
        unsafe { to.as_ptr().copy_from_nonoverlapping(from.as_ptr(), bytes) }
        Ok(())
    }

    unsafe fn run(&self, sequence: &Sequence) -> Result<()> {
        // SAFETY: the caller's promise.
        unsafe { sequence.enqueue(self) }
    }

    fn mark(&self) -> Result<Box<dyn Mark>> {
        Ok(Box::new(Moment::now()))
    }

    fn synchronize(&self) -> Result<()> {
        self.shared.lock().heap.check()
    }

    fn ray_tracing(&self) -> std::result::Result<&dyn RayTracing, String> {
        Ok(self)
    }
}

impl RayTracing for Emulator {
    fn describe(&self) -> String {
        "a tree of boxes on the host".into()
    }

    fn structure(&self) -> Result<Box<dyn AccelerationStructure>> {
        Ok(Box::new(Acceleration::new(self.shared.clone())))
    }

    unsafe fn trace(&self, trace: Trace) -> Result<()> {
        let state = self.shared.lock();
        // SAFETY: as for launch.
        unsafe { launch::trace(trace, &Seen { structures: &state.structures, by: trace.primitive }) }
    }
}
