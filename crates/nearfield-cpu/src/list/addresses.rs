//! Where the row of each particle is, among the rows of all tasks.

use super::rows::Rows;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering::Relaxed};

/// Bits of an address that hold a place among the rows of a task.
const PLACE_BITS: u32 = 40;

/// The row of a particle: task and first entry, and number of entries. Next to each other, as they are written together
/// in no order.
#[derive(Debug, Default)]
struct Address {
    place: AtomicU64,
    length: AtomicU32,
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
            address.place.store((task as u64) << PLACE_BITS | extent.start as u64, Relaxed);
            address.length.store(extent.len() as u32, Relaxed);
        }
    }

    /// Task and first entry of the row of particle `i`.
    #[inline(always)]
    pub fn of(&self, i: usize) -> (usize, usize) {
        let place = self.0[i].place.load(Relaxed);
        ((place >> PLACE_BITS) as usize, (place & ((1 << PLACE_BITS) - 1)) as usize)
    }

    /// Number of entries of each row.
    pub fn lengths(&self) -> impl Iterator<Item = u32> {
        self.0.iter().map(|address| address.length.load(Relaxed))
    }
}
