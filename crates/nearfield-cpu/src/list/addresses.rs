//! Where the row of each particle is, among the rows of all tasks.

use super::rows::{Rows, TOGETHER};
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering::Relaxed};

/// Bits of an address that hold a place in a stream.
const PLACE_BITS: u32 = 40;

/// The row of a particle: task, stream and first entry, and number of entries. Next to each other, for they are written
/// together, in no order.
#[derive(Debug, Default)]
struct Address {
    place: AtomicU64,
    length: AtomicU32,
}

/// Where a row is: one of the streams of a task, and its first entry there.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub task: usize,
    pub stream: usize,
    pub first: usize,
}

/// Addresses of rows, by particle.
#[derive(Debug, Default)]
pub(super) struct Addresses(Vec<Address>);

impl Addresses {
    /// For `n` particles.
    pub fn resize(&mut self, n: usize) {
        self.0.resize_with(n, Address::default);
    }

    /// Notes the rows of a task.
    pub fn note(&self, task: usize, rows: &Rows) {
        for k in 0..rows.len() {
            let (particle, extent) = rows.extent(k);
            let address = &self.0[particle as usize];
            let stream = TOGETHER * task + k % TOGETHER;
            address.place.store((stream as u64) << PLACE_BITS | extent.start as u64, Relaxed);
            address.length.store(extent.len() as u32, Relaxed);
        }
    }

    /// Where the row of particle `i` is.
    #[inline(always)]
    pub fn of(&self, i: usize) -> Place {
        let place = self.0[i].place.load(Relaxed);
        let stream = (place >> PLACE_BITS) as usize;
        Place { task: stream / TOGETHER, stream: stream % TOGETHER, first: (place & ((1 << PLACE_BITS) - 1)) as usize }
    }

    /// Number of entries of each row.
    pub fn lengths(&self) -> impl Iterator<Item = u32> {
        self.0.iter().map(|address| address.length.load(Relaxed))
    }
}
