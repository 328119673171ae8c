//! Work that is put together first and enqueued as a whole.

use crate::gpu::{Launch, Queue};
use nearfield_core::Result;
use std::cell::RefCell;

/// Kernels and fills, one after another, that have not been enqueued yet: for [`crate::Gpu::run`].
///
/// Memory is not part of it: what is allocated while a sequence is put together is there before it runs, and what is
/// released is gone before, so its buffers must have their size.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sequence {
    parts: RefCell<Vec<Part>>,
}

/// A part of a sequence.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Part {
    /// A kernel.
    Launch {
        module: &'static str,
        name: &'static str,
        blocks: u32,
        threads: u32,
        /// The structure it takes, aligned as those are.
        arguments: Vec<u64>,
    },
    /// Bytes set to a value.
    Fill { to: u64, value: u8, bytes: usize },
}

impl Sequence {
    /// Enqueues the parts one by one.
    ///
    /// # Safety
    /// As for each part.
    ///
    /// # Errors
    /// As for each part.
    pub unsafe fn enqueue(&self, queue: &dyn Queue) -> Result<()> {
        for part in &*self.parts.borrow() {
            // SAFETY: the caller's promise.
            unsafe {
                match part {
                    Part::Launch { module, name, blocks, threads, arguments } => queue.launch(Launch {
                        module,
                        name,
                        blocks: *blocks,
                        threads: *threads,
                        arguments: bytemuck::cast_slice(arguments),
                    })?,
                    Part::Fill { to, value, bytes } => queue.fill(*to, *value, *bytes)?,
                }
            }
        }
        Ok(())
    }

    /// The parts.
    pub(crate) fn parts(&self) -> std::cell::Ref<'_, [Part]> {
        std::cell::Ref::map(self.parts.borrow(), Vec::as_slice)
    }
}

impl Queue for Sequence {
    unsafe fn launch(&self, launch: Launch) -> Result<()> {
        let Launch { module, name, blocks, threads, arguments } = launch;
        let mut words = vec![0; arguments.len().div_ceil(size_of::<u64>())];
        bytemuck::cast_slice_mut(&mut words)[..arguments.len()].copy_from_slice(arguments);
        let arguments = words;
        self.parts.borrow_mut().push(Part::Launch { module, name, blocks, threads, arguments });
        Ok(())
    }

    unsafe fn fill(&self, to: u64, value: u8, bytes: usize) -> Result<()> {
        self.parts.borrow_mut().push(Part::Fill { to, value, bytes });
        Ok(())
    }
}
