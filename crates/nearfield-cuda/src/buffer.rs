//! Typed arrays in device memory.

use crate::{Gpu, gpu::Queue};
use nearfield_core::Result;
use nearfield_kernels::{Layout, Ptr};
use std::{marker::PhantomData, sync::Arc};

/// An array of `T` in device memory, freed when dropped.
pub struct Buffer<T> {
    gpu: Arc<dyn Gpu>,
    what: &'static str,
    address: u64,
    len: usize,
    capacity: usize,
    element: PhantomData<T>,
}

impl<T: Layout> Buffer<T> {
    /// An empty array; `what` names it in messages.
    pub fn new(gpu: &Arc<dyn Gpu>, what: &'static str) -> Self {
        Self { gpu: gpu.clone(), what, address: 0, len: 0, capacity: 0, element: PhantomData }
    }

    /// Sets the length. The content is arbitrary where the array grows beyond what it has held before.
    ///
    /// # Errors
    /// As [`Gpu::allocate`].
    pub fn resize(&mut self, len: usize) -> Result<()> {
        if len > self.capacity {
            self.release();
            self.address = self.gpu.allocate(self.what, len * size_of::<T>())?;
            self.capacity = len;
        }
        self.len = len;
        Ok(())
    }

    /// As [`Buffer::resize`], with an eighth to spare where the array must grow, for lengths that creep upwards.
    ///
    /// # Errors
    /// As [`Gpu::allocate`].
    pub fn resize_with_room(&mut self, len: usize) -> Result<()> {
        if len > self.capacity {
            self.resize(len + len / 8)?;
        }
        self.resize(len)
    }

    /// Lengthens it to what there is room for; the content of what it has not held before is arbitrary.
    pub fn fill_room(&mut self) {
        self.len = self.capacity;
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Address for kernels; null when empty.
    pub fn ptr(&self) -> Ptr<T> {
        Ptr::new(if self.len == 0 { 0 } else { self.address })
    }

    /// Bytes held.
    pub fn bytes(&self) -> u64 {
        (self.capacity * size_of::<T>()) as u64
    }

    /// Sets every bit to zero.
    ///
    /// # Errors
    /// As [`Queue::fill`].
    pub fn zero(&mut self) -> Result<()> {
        self.fill(0)
    }

    /// The same as work of a queue.
    ///
    /// # Errors
    /// As [`Queue::fill`].
    pub fn zero_by(&mut self, queue: &dyn Queue) -> Result<()> {
        self.fill_by(queue, 0)
    }

    /// Sets every byte to `value`.
    ///
    /// # Errors
    /// As [`Queue::fill`].
    pub fn fill(&mut self, value: u8) -> Result<()> {
        self.fill_by(&*self.gpu, value)
    }

    fn fill_by(&self, queue: &dyn Queue, value: u8) -> Result<()> {
        if self.len == 0 {
            return Ok(());
        }
        // SAFETY: the array is that long.
        unsafe { queue.fill(self.address, value, self.len * size_of::<T>()) }
    }

    /// Resizes to the data and copies it.
    ///
    /// # Errors
    /// As [`Gpu::allocate`] and [`Gpu::upload`].
    pub fn upload(&mut self, data: &[T]) -> Result<()> {
        self.resize(data.len())?;
        if data.is_empty() {
            return Ok(());
        }
        // SAFETY: the array has been made that long.
        unsafe { self.gpu.upload(bytemuck::cast_slice(data), self.address) }
    }

    /// The content; waits for the work enqueued before.
    ///
    /// # Errors
    /// As [`Gpu::download`].
    pub fn download(&self) -> Result<Vec<T>> {
        self.download_range(0, self.len)
    }

    /// `len` elements from `start` on; waits for the work enqueued before.
    ///
    /// # Panics
    /// When the range lies outside of the array.
    ///
    /// # Errors
    /// As [`Gpu::download`].
    pub fn download_range(&self, start: usize, len: usize) -> Result<Vec<T>> {
        assert!(start + len <= self.len, "{} of {} elements has no {start}..{}", self.what, self.len, start + len);
        let mut data = vec![T::zeroed(); len];
        if len > 0 {
            let from = self.address + (start * size_of::<T>()) as u64;
            // SAFETY: the range was checked.
            unsafe { self.gpu.download(from, bytemuck::cast_slice_mut(&mut data))? };
        }
        Ok(data)
    }

    /// Becomes a copy of another array of the device.
    ///
    /// # Errors
    /// As [`Gpu::allocate`] and [`Gpu::copy`].
    pub fn copy_from(&mut self, other: &Self) -> Result<()> {
        self.resize(other.len)?;
        if other.len == 0 {
            return Ok(());
        }
        // SAFETY: both are that long; two buffers do not overlap.
        unsafe { self.gpu.copy(other.address, self.address, other.len * size_of::<T>()) }
    }
}

impl<T> Buffer<T> {
    fn release(&mut self) {
        if self.capacity > 0 {
            // SAFETY: the address is this buffer's own and is forgotten here.
            unsafe { self.gpu.release(self.address) };
        }
        (self.address, self.len, self.capacity) = (0, 0, 0);
    }
}

impl<T> Drop for Buffer<T> {
    fn drop(&mut self) {
        self.release();
    }
}
