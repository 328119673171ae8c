//! Neighbour lists of short rows, each found once.

use super::{Grid, query};
use crate::{
    DeviceList,
    gpu::{Queue, launch},
    grid::{Candidates, ListQuery},
};
use nearfield_core::{ListKind, Result};
use nearfield_kernels::{
    kernels::{CELL_LIST_STAGE, COPY_ROWS, ROW_LANES, STAGED_ROW},
    layouts::{CopyRowsArgs, StageArgs},
};

/// Most bytes of rows that are kept a second time.
const MOST_BYTES: f64 = (2u64 << 30) as f64;

/// Expected neighbours, as a part of the entries there is room for, up to which no row is likely to be longer: seven
/// standard deviations of random points.
const LIKELY: f64 = 0.5;

/// Entries there is room for over those expected.
const ROOM: f64 = 1.5;

/// Lists the neighbours of all particles, by input index, where they are expected to be few, and gives whether they
/// were. Waits for the device.
///
/// # Safety
/// As [`super::list`].
///
/// # Errors
/// As [`super::list`].
pub(super) unsafe fn list(queue: &dyn Queue, grid: &Grid, query: &ListQuery, list: &mut DeviceList) -> Result<bool> {
    let Some(capacity) = room(grid, query, list) else { return Ok(false) };
    // Each row has one warp that writes its count.
    list.count.resize(grid.n)?;
    list.staging.staged.resize(capacity)?;
    list.staging.start.resize(grid.n)?;
    list.staging.control.resize(1)?;
    list.staging.control.zero()?;
    // SAFETY: the caller's promise.
    unsafe { query::number_slots(queue, grid, query.id, list)? };
    let candidates = Candidates::Cells(grid);
    let stage = StageArgs {
        list: query::arguments(candidates, query, list),
        staged: list.staging.staged.ptr(),
        start: list.staging.start.ptr(),
        control: list.staging.control.ptr(),
        capacity: capacity as u64,
    };
    // SAFETY: the caller's promise; a count and a start for each row, entries as said.
    unsafe { launch(queue, CELL_LIST_STAGE, candidates.threads(), &stage)? };
    list.scan_rows()?;
    // Before the host knows how many entries there are, which then need not be waited for: a list has had room for as many
    // before.
    list.index.fill_room();
    let room = list.index.len() as u64;
    copy_rows(queue, grid.n, list)?;
    let Some(control) = list.staging.control.download()?.pop() else { return Ok(false) };
    list.staging.overflowed = control.overflow != 0;
    if list.staging.overflowed {
        list.staging.staged.resize(0)?;
        return Ok(false);
    }
    list.make_room(control.entries, false)?;
    if control.entries > room {
        copy_rows(queue, grid.n, list)?;
    }
    Ok(true)
}

/// Enqueues the copy of staged rows to their places, where there is room for them.
fn copy_rows(queue: &dyn Queue, n: usize, list: &DeviceList) -> Result<()> {
    let copy = CopyRowsArgs {
        offset: list.offset.ptr(),
        start: list.staging.start.ptr(),
        staged: list.staging.staged.ptr(),
        index: list.index.ptr(),
        control: list.staging.control.ptr(),
        room: list.index.len() as u64,
        n: n as u32,
        unused: 0,
    };
    // SAFETY: rows are as many as were staged, and nothing is copied where there is no room.
    unsafe { launch(queue, COPY_ROWS, (ROW_LANES * n) as u64, &copy) }
}

/// Entries to make room for, where this is expected to do.
fn room(grid: &Grid, query: &ListQuery, list: &DeviceList) -> Option<usize> {
    let neighbors = grid.plan.neighbors;
    let uniform = query.law.variable == 0 && !grid.has_classes();
    let few = neighbors <= LIKELY * STAGED_ROW as f64;
    if list.staging.overflowed || !uniform || query.images || !few {
        return None;
    }
    let sides = if query.kind == ListKind::Half { 0.5 } else { 1.0 };
    // A few for each, since expectations are rough.
    let entries = (ROOM * sides * neighbors + 2.0) * grid.n as f64;
    (entries * size_of::<u32>() as f64 <= MOST_BYTES).then_some(entries as usize)
}
