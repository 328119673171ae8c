//! Lists from pairs that were found once, from either side: each is given to the row of its other particle too.

use super::csr::resize;
use super::rows::Rows;
use nearfield_core::{ListKind, ListRequest, NeighborList};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering::Relaxed};

/// Calls `visit` with each pair as the rows it belongs to see it: (row, neighbour, image, r2).
fn for_each_entry(tasks: &[Rows], kind: ListKind, visit: impl Fn(u32, u32, [i8; 3], f32) + Sync) {
    tasks.par_iter().for_each(|rows| {
        for row in rows.iter() {
            for (k, &j) in row.neighbors.iter().enumerate() {
                let i = row.particle;
                let image = row.images.get(k).copied().unwrap_or_default();
                let r2 = row.r2.get(k).copied().unwrap_or_default();
                if kind == ListKind::Full || i < j {
                    visit(i, j, image, r2);
                }
                if kind == ListKind::Full || j < i {
                    visit(j, i, image.map(|s| -s), r2);
                }
            }
        }
    });
}

/// Counts the neighbours of `n` particles, and gives the number of pairs.
pub(super) fn count(tasks: &[Rows], n: usize, neighbors: &mut Vec<u32>) -> u64 {
    let counts: Vec<AtomicU32> = (0..n).map(|_| AtomicU32::new(0)).collect();
    for_each_entry(tasks, ListKind::Full, |i, _, _, _| {
        counts[i as usize].fetch_add(1, Relaxed);
    });
    neighbors.extend(counts.into_iter().map(AtomicU32::into_inner));
    tasks.iter().map(|rows| rows.n_entries() as u64).sum()
}

/// Replaces `list` by the pairs of all tasks. The order within rows depends on the threads.
pub(super) fn assemble(tasks: &[Rows], n: usize, request: ListRequest, list: &mut NeighborList) {
    let counts: Vec<AtomicU32> = (0..n).map(|_| AtomicU32::new(0)).collect();
    for_each_entry(tasks, request.kind, |i, _, _, _| {
        counts[i as usize].fetch_add(1, Relaxed);
    });
    resize(list, request, counts.iter().map(|count| count.load(Relaxed)));

    let cursors: Vec<AtomicU64> = list.offsets[..n].iter().map(|&offset| AtomicU64::new(offset)).collect();
    let column = |wanted: bool| -> Vec<AtomicU32> {
        let len = if wanted { list.n_entries() } else { 0 };
        (0..len).map(|_| AtomicU32::new(0)).collect()
    };
    let (indices, shifts, distances) = (column(true), column(request.shifts), column(request.distances));
    for_each_entry(tasks, request.kind, |i, j, image, r2| {
        let at = cursors[i as usize].fetch_add(1, Relaxed) as usize;
        indices[at].store(j, Relaxed);
        if let Some(shift) = shifts.get(at) {
            let [x, y, z] = image.map(i8::cast_unsigned);
            shift.store(u32::from_le_bytes([x, y, z, 0]), Relaxed);
        }
        if let Some(distance) = distances.get(at) {
            distance.store(r2.sqrt().to_bits(), Relaxed);
        }
    });
    list.indices = indices.into_iter().map(AtomicU32::into_inner).collect();
    let shift = |packed: AtomicU32| {
        let [x, y, z, _] = packed.into_inner().to_le_bytes();
        [x, y, z].map(u8::cast_signed)
    };
    list.shifts = request.shifts.then(|| shifts.into_iter().map(shift).collect());
    let distance = |bits: AtomicU32| f32::from_bits(bits.into_inner());
    list.distances = request.distances.then(|| distances.into_iter().map(distance).collect());
}
