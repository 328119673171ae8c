//! Emulated device memory: host memory at its own addresses, with guards that show writes beyond a buffer.

use nearfield_core::{Error, Result};
use nearfield_cuda::gpu::Memory;
use std::{
    alloc::{self, Layout},
    collections::{BTreeMap, VecDeque},
    ptr::NonNull,
    slice,
};

/// Alignment of buffers, and bytes of guard before and after each.
const ALIGNMENT: usize = 256;
/// What guards hold. As an index or a float it is far off.
const GUARD: u8 = 0xC7;
/// What new memory holds, and released memory.
const UNWRITTEN: u8 = 0xA5;
/// Bytes of released buffers that are kept, so that those who still read one see the pattern instead of their data.
const KEPT: usize = 16 << 20;

/// All buffers of a device.
pub struct Heap {
    buffers: BTreeMap<u64, Buffer>,
    released: VecDeque<Buffer>,
    limit: u64,
    used: u64,
    /// What was found wrong where nothing could be returned.
    found: Option<String>,
}

struct Buffer {
    what: &'static str,
    bytes: usize,
    /// The guard before the data.
    start: NonNull<u8>,
}

// SAFETY: a buffer owns its memory; the pointer is to nothing of a thread.
unsafe impl Send for Buffer {}

impl Heap {
    /// An empty heap of `limit` bytes.
    pub fn new(limit: u64) -> Self {
        Self { buffers: BTreeMap::new(), released: VecDeque::new(), limit, used: 0, found: None }
    }

    pub fn memory(&self) -> Memory {
        Memory { free: self.limit - self.used, total: self.limit }
    }

    /// Takes bytes without giving them an address.
    pub fn reserve(&mut self, what: &'static str, bytes: u64) -> Result<()> {
        let available = self.limit - self.used;
        if bytes > available {
            return Err(Error::OutOfMemory { what, needed: bytes, available });
        }
        self.used += bytes;
        Ok(())
    }

    /// Gives reserved bytes back.
    pub fn unreserve(&mut self, bytes: u64) {
        self.used -= bytes;
    }

    pub fn allocate(&mut self, what: &'static str, bytes: usize) -> Result<u64> {
        self.reserve(what, bytes as u64)?;
        let buffer = Buffer::new(what, bytes).ok_or_else(|| {
            self.unreserve(bytes as u64);
            Error::OutOfMemory { what, needed: bytes as u64, available: self.limit - self.used }
        })?;
        let address = buffer.address();
        self.buffers.insert(address, buffer);
        Ok(address)
    }

    /// Ends a buffer. What is wrong is reported by the next [`Heap::check`].
    pub fn release(&mut self, address: u64) {
        let found = match self.buffers.remove(&address) {
            Some(buffer) => {
                self.unreserve(buffer.bytes as u64);
                let damage = buffer.damage();
                self.keep(buffer);
                damage
            }
            None => Some(format!("{address:#x} is released, but is no buffer's address")),
        };
        self.found = self.found.take().or(found);
    }

    fn keep(&mut self, buffer: Buffer) {
        buffer.clear();
        self.released.push_back(buffer);
        while self.released.iter().map(|buffer| buffer.bytes).sum::<usize>() > KEPT {
            self.released.pop_front();
        }
    }

    /// Whether all guards are as they were.
    pub fn check(&mut self) -> Result<()> {
        let found = self.found.take().or_else(|| self.buffers.values().find_map(Buffer::damage));
        found.map_or(Ok(()), |text| Err(Error::Device(text)))
    }

    /// The place of `bytes` bytes, which must be within one buffer.
    pub fn range(&self, action: &str, address: u64, bytes: usize) -> Result<NonNull<u8>> {
        let outside = |text: String| Err(Error::Device(format!("{action} of {bytes} bytes at {address:#x}: {text}")));
        let Some((start, buffer)) = self.buffers.range(..=address).next_back() else {
            return outside("no buffer is there".into());
        };
        let offset = (address - start) as usize;
        if offset > buffer.bytes || bytes > buffer.bytes - offset {
            return outside(format!("the buffer before, `{}`, has {} bytes at {start:#x}", buffer.what, buffer.bytes));
        }
        // SAFETY: within the buffer.
        Ok(unsafe { buffer.start.add(ALIGNMENT + offset) })
    }
}

impl Buffer {
    fn new(what: &'static str, bytes: usize) -> Option<Self> {
        let layout = Self::layout(bytes)?;
        // SAFETY: guards make the size positive.
        let start = NonNull::new(unsafe { alloc::alloc(layout) })?;
        // SAFETY: just allocated with this size.
        unsafe { start.write_bytes(GUARD, layout.size()) }
        let buffer = Self { what, bytes, start };
        buffer.clear();
        Some(buffer)
    }

    /// Makes the content arbitrary.
    fn clear(&self) {
        // SAFETY: the data is between the guards.
        unsafe { self.start.add(ALIGNMENT).write_bytes(UNWRITTEN, self.bytes) }
    }

    fn layout(bytes: usize) -> Option<Layout> {
        Layout::from_size_align(bytes.checked_add(2 * ALIGNMENT)?, ALIGNMENT).ok()
    }

    fn address(&self) -> u64 {
        self.start.as_ptr() as u64 + ALIGNMENT as u64
    }

    /// Where a guard has changed, in words.
    fn damage(&self) -> Option<String> {
        // SAFETY: the guards surround the data; nothing writes to them at this time, as launches have ended.
        let (before, after) = unsafe {
            let after = self.start.add(ALIGNMENT + self.bytes);
            (slice::from_raw_parts(self.start.as_ptr(), ALIGNMENT), slice::from_raw_parts(after.as_ptr(), ALIGNMENT))
        };
        let written = |guard: &[u8]| guard.iter().position(|&byte| byte != GUARD);
        let last_before = before.iter().rposition(|&byte| byte != GUARD);
        let distance = match (last_before, written(after)) {
            (Some(at), _) => format!("{} bytes before its start", ALIGNMENT - at),
            (None, Some(at)) => format!("{at} bytes after its end"),
            (None, None) => return None,
        };
        Some(format!("something was written outside the buffer `{}` of {} bytes, {distance}", self.what, self.bytes))
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        if let Some(layout) = Self::layout(self.bytes) {
            // SAFETY: allocated with this layout, and not used again.
            unsafe { alloc::dealloc(self.start.as_ptr(), layout) }
        }
    }
}
