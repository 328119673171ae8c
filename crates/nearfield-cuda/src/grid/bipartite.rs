//! Neighbours of one set of points in another.

use super::{Grid, query::number_slots};
use crate::{
    DeviceList, Gpu,
    gpu::{Queue, launch},
};
use nearfield_core::Result;
use nearfield_kernels::{
    Kernel, Ptr,
    kernels::{self, CLUSTER},
    layouts::{Box3, Law, ListArgs, QueryArgs},
};

/// What is looked for among points.
#[derive(Clone, Copy)]
pub struct PointQuery<'a> {
    /// The points, in cells of one class that were chosen for the largest radius of the queries.
    pub points: &'a Grid,
    /// Input index of each of their places.
    pub id: Ptr<u32>,
    /// Queries, in whichever cells keep near ones together, with radii in w.
    pub queries: &'a Grid,
    /// The box.
    pub space: Box3,
}

/// Counts the points within the radius of each query: a row for each of these.
///
/// # Safety
/// `id` is the address of as many indices as there are points, all below that number.
///
/// # Errors
/// As [`Gpu::allocate`] and [`Queue::launch`].
pub unsafe fn count(gpu: &dyn Gpu, query: &PointQuery, list: &mut DeviceList) -> Result<()> {
    list.start(query.queries.n)?;
    // SAFETY: the caller's promise.
    unsafe { number_slots(gpu, query.points, query.id, list)? };
    enqueue(gpu, kernels::QUERY_COUNT, query, list)
}

/// Lists them, with their periodic images where that is asked for; waits for the device once, to know how many there are.
///
/// # Safety
/// As [`count`].
///
/// # Errors
/// As [`count`].
pub unsafe fn list(gpu: &dyn Gpu, query: &PointQuery, images: bool, list: &mut DeviceList) -> Result<()> {
    // SAFETY: the caller's promise.
    unsafe { count(gpu, query, list)? };
    let entries = list.place_rows()?;
    list.make_room(entries, images)?;
    enqueue(gpu, kernels::QUERY_FILL, query, list)
}

fn enqueue(queue: &dyn Queue, kernel: Kernel<QueryArgs>, query: &PointQuery, list: &DeviceList) -> Result<()> {
    let PointQuery { points, queries, space, .. } = *query;
    let arguments = QueryArgs {
        list: ListArgs {
            law: Law { variable: 1, ..Law::default() },
            space,
            grid: points.layout(),
            id: list.number.ptr(),
            count: list.count.ptr(),
            offset: list.offset.ptr(),
            index: list.index.ptr(),
            image: list.image.ptr(),
            n: queries.n as u32,
            half: 0,
            slack: points.slack().max(queries.slack()),
            unused: 0,
        },
        query: queries.slots(),
        row: queries.order().ptr(),
    };
    // Without points there is nothing in the cells.
    let clusters = if points.n == 0 { 0 } else { queries.n.div_ceil(CLUSTER) };
    // SAFETY: rows are those of the queries, and have room for as many points as were counted.
    unsafe { launch(queue, kernel, 32 * clusters as u64, &arguments) }
}
