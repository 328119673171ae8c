//! CUDA graphs of sequences that come again.
//!
//! Launching a kernel costs the host 4 us, a graph of twenty not much more.

use crate::sequence::{Part, Sequence};
use cudarc::driver::{CudaContext, DriverError, result::graph, sys};
use std::{ffi::c_void, mem::MaybeUninit, ptr, sync::Arc};

/// Most sequences that are remembered.
const REMEMBERED: usize = 32;

/// Sequences that were enqueued lately, the latest last.
#[derive(Default)]
pub(super) struct Graphs(Vec<Remembered>);

struct Remembered {
    sequence: Sequence,
    graph: Option<Graph>,
    /// Whether a graph of it was refused.
    refused: bool,
}

/// A graph that can be launched.
pub(super) struct Graph {
    exec: sys::CUgraphExec,
    /// Where it lives, which must not go before.
    context: Arc<CudaContext>,
}

// SAFETY: a handle of the driver that belongs to no thread; calls with it take turns behind the device's lock.
unsafe impl Send for Graph {}

impl Graphs {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.iter().filter(|remembered| remembered.graph.is_some()).count()
    }

    /// The graph of a sequence, by `make` where it comes for the second time; none the first time or where the driver
    /// refuses: the sequence is then to be enqueued part by part.
    pub fn of(&mut self, sequence: &Sequence, make: impl FnOnce(&[Part]) -> Option<Graph>) -> Option<&Graph> {
        let Some(at) = self.0.iter().rposition(|remembered| remembered.sequence == *sequence) else {
            if self.0.len() == REMEMBERED {
                self.0.remove(0);
            }
            self.0.push(Remembered { sequence: sequence.clone(), graph: None, refused: false });
            return None;
        };
        self.0[at..].rotate_left(1);
        let remembered = self.0.last_mut()?;
        if remembered.graph.is_none() && !remembered.refused {
            remembered.graph = make(&sequence.parts());
            remembered.refused = remembered.graph.is_none();
        }
        remembered.graph.as_ref()
    }
}

impl Graph {
    /// A graph of the parts, one after another, in the present context; `kernel` finds functions.
    ///
    /// # Safety
    /// As for [`Graph::launch`], at each launch.
    pub unsafe fn new(
        parts: &[Part],
        context: &Arc<CudaContext>,
        mut kernel: impl FnMut(&'static str, &'static str) -> Option<sys::CUfunction>,
    ) -> Result<Self, DriverError> {
        let mut made = MaybeUninit::uninit();
        // SAFETY: the call writes the handle where it succeeds.
        let made = unsafe {
            sys::cuGraphCreate(made.as_mut_ptr(), 0).result()?;
            made.assume_init()
        };
        let mut last = None;
        let mut add = |part: &Part| {
            // SAFETY: the graph is valid, and so is the node before.
            last = Some(unsafe { add(made, last, part, context.cu_ctx(), &mut kernel)? });
            Ok(())
        };
        // SAFETY: the graph is valid until it is destroyed; what is instantiated does not need it.
        unsafe {
            let outcome = parts.iter().try_for_each(&mut add);
            let outcome = outcome.and_then(|()| graph::instantiate(made, sys::CUgraphInstantiate_flags(0)));
            graph::destroy(made)?;
            outcome.map(|exec| Self { exec, context: context.clone() })
        }
    }

    /// Enqueues it.
    ///
    /// # Safety
    /// As for each part; the stream is of the graph's context.
    pub unsafe fn launch(&self, stream: sys::CUstream) -> Result<(), DriverError> {
        // SAFETY: the caller's promise.
        unsafe { graph::launch(self.exec, stream) }
    }
}

impl Drop for Graph {
    fn drop(&mut self) {
        // A device that fails here has failed before.
        if self.context.bind_to_thread().is_ok() {
            // SAFETY: the graph is valid and used by nobody else; the driver frees it once it does not run any more.
            let _ = unsafe { graph::exec_destroy(self.exec) };
        }
    }
}

/// Adds a node for a part after another node.
///
/// # Safety
/// The graph is valid and has the node.
unsafe fn add(
    graph: sys::CUgraph,
    after: Option<sys::CUgraphNode>,
    part: &Part,
    context: sys::CUcontext,
    kernel: &mut impl FnMut(&'static str, &'static str) -> Option<sys::CUfunction>,
) -> Result<sys::CUgraphNode, DriverError> {
    let mut node = MaybeUninit::uninit();
    let (before, n_before) = (after.as_ref().map_or(ptr::null(), ptr::from_ref), usize::from(after.is_some()));
    let outcome = match part {
        Part::Launch { module, name, blocks, threads, arguments } => {
            let func = kernel(module, name).ok_or(DriverError(sys::CUresult::CUDA_ERROR_NOT_FOUND))?;
            let mut arguments = [arguments.as_ptr().cast_mut().cast::<c_void>()];
            let parameters = sys::CUDA_KERNEL_NODE_PARAMS {
                func,
                gridDimX: *blocks,
                gridDimY: 1,
                gridDimZ: 1,
                blockDimX: *threads,
                blockDimY: 1,
                blockDimZ: 1,
                sharedMemBytes: 0,
                kernelParams: arguments.as_mut_ptr(),
                extra: ptr::null_mut(),
                kern: ptr::null_mut(),
                ctx: ptr::null_mut(),
            };
            // SAFETY: the driver copies the one structure that the kernel takes during the call.
            unsafe { sys::cuGraphAddKernelNode_v2(node.as_mut_ptr(), graph, before, n_before, &raw const parameters) }
        }
        Part::Fill { to, value, bytes } => {
            // Words where they fit: the driver may take elements as they are.
            let size = if bytes % 4 == 0 { 4 } else { 1 };
            let value = if size == 4 { u32::from_ne_bytes([*value; 4]) } else { u32::from(*value) };
            let parameters = sys::CUDA_MEMSET_NODE_PARAMS {
                dst: *to,
                pitch: 0,
                value,
                elementSize: size,
                width: bytes / size as usize,
                height: 1,
            };
            // SAFETY: parameters are copied during the call.
            unsafe {
                sys::cuGraphAddMemsetNode(node.as_mut_ptr(), graph, before, n_before, &raw const parameters, context)
            }
        }
    };
    outcome.result()?;
    // SAFETY: the call that succeeded has written it.
    Ok(unsafe { node.assume_init() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Queue;

    fn fill(value: u8) -> Sequence {
        let sequence = Sequence::default();
        // SAFETY: it is never enqueued.
        unsafe { sequence.fill(256, value, 8) }.expect("a sequence takes all work");
        sequence
    }

    #[test]
    fn a_graph_is_made_the_second_time_and_not_again_where_it_was_refused() {
        let mut graphs = Graphs::default();
        let mut asked = Vec::new();
        for value in [1, 2, 1, 1, 3, 2, 2, 1] {
            let graph = graphs.of(&fill(value), |_| {
                asked.push(value);
                None
            });
            assert!(graph.is_none());
        }
        assert_eq!(asked, [1, 2]);
        assert_eq!(graphs.count(), 0);
    }

    #[test]
    fn the_sequence_that_has_not_come_for_longest_is_forgotten() {
        let mut graphs = Graphs::default();
        let mut see = |value: u8| {
            let mut known = false;
            graphs.of(&fill(value), |_| {
                known = true;
                None
            });
            known
        };
        (0..REMEMBERED as u8).for_each(|value| assert!(!see(value)));
        assert!(see(0));
        assert!(!see(100), "a new one, for which 1 goes");
        assert!(!see(1), "for which 2 goes");
        assert!(see(3));
    }
}
