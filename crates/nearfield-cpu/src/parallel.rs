//! Splitting work over threads.

use rayon::prelude::*;
use std::{cell::UnsafeCell, ops::Range};

/// Calls `work` for consecutive ranges that cover `0..n`, with buffers that are reused within a thread.
pub(crate) fn for_each_chunk<B: Default>(n: usize, chunk: usize, work: impl Fn(Range<usize>, &mut B) + Sync) {
    (0..n.div_ceil(chunk))
        .into_par_iter()
        .for_each_init(B::default, |buffers, c| work(c * chunk..((c + 1) * chunk).min(n), buffers));
}

/// A slice that several threads write to at indices that never meet.
pub(crate) struct Scattered<'a, T>(&'a [UnsafeCell<T>]);

// SAFETY: the only access is `write`, whose contract forbids two threads the same index.
unsafe impl<T: Send> Sync for Scattered<'_, T> {}

impl<'a, T: Copy> Scattered<'a, T> {
    pub fn new(slice: &'a mut [T]) -> Self {
        let pointer = std::ptr::from_mut(slice) as *const [UnsafeCell<T>];
        // SAFETY: UnsafeCell<T> has the layout of T, and the exclusive borrow lasts as long as the result.
        Self(unsafe { &*pointer })
    }

    /// Replaces element `i`.
    ///
    /// # Safety
    /// No other thread reads or writes element `i` while this value lives.
    #[inline(always)]
    pub unsafe fn write(&self, i: usize, value: T) {
        // SAFETY: exclusive access to element i is the caller's promise; the index is bounds-checked.
        unsafe { *self.0[i].get() = value };
    }

    /// The `N` elements from `start` on.
    ///
    /// # Safety
    /// As for [`Scattered::range`].
    #[expect(clippy::mut_from_ref, reason = "as for `range`")]
    #[inline(always)]
    pub unsafe fn chunk<const N: usize>(&self, start: usize) -> &mut [T; N] {
        let cells = &self.0[start..start + N];
        // SAFETY: as below, and there are N of them.
        unsafe { &mut *UnsafeCell::raw_get(cells.as_ptr()).cast() }
    }

    /// Elements `range`.
    ///
    /// # Safety
    /// No other thread reads or writes these elements, nor does this one by another reference, while the result lives.
    #[expect(clippy::mut_from_ref, reason = "the purpose of this type; see above")]
    #[inline(always)]
    pub unsafe fn range(&self, range: Range<usize>) -> &mut [T] {
        let cells = &self.0[range];
        // SAFETY: UnsafeCell<T> has the layout of T, and exclusive access is the caller's promise.
        unsafe { std::slice::from_raw_parts_mut(UnsafeCell::raw_get(cells.as_ptr()), cells.len()) }
    }
}
