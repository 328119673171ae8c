//! One contiguous list out of the rows of many tasks.

use super::addresses::{Addresses, Place};
use super::copy::copy_over;
use super::rows::{Contents, Queries, Rows};
use super::{Rule, mirror};
use crate::prefetch::prefetch;
use crate::{Input, Structure};
use nearfield_core::{ListKind, ListRequest, NeighborList, SimBox};
use rayon::prelude::*;
use std::ops::Range;

/// Tasks for each thread, so that uneven ones even out.
const TASKS_PER_THREAD: usize = 8;

/// Fewest groups worth a task of their own.
const LEAST_GROUPS: usize = 64;

/// Fewest rows worth a task when rows are copied.
const LEAST_ROWS: usize = 2048;

/// Rows are fetched so many rows before they are copied: they lie anywhere in memory.
const AHEAD: usize = 12;

/// Entries of a row that are fetched: the processor sees by itself that what follows is read, too.
const FETCHED: usize = 32;

/// Builds neighbour lists, keeping its buffers from one to the next: first use of a page of memory costs more than
/// filling it.
#[derive(Debug, Default)]
pub struct ListBuilder {
    tasks: Vec<Rows>,
    addresses: Addresses,
}

/// The neighbour list of the particles of `input`, from a structure built from it.
///
/// ```
/// use nearfield_core::{Boundary, ListKind, ListRequest, SimBox};
/// use nearfield_cpu::{Grid, Input, InputRadii, neighbor_list};
/// let sim_box = SimBox::cubic(10.0, Boundary::Periodic)?;
/// let (x, y) = ([0.5, 9.5, 5.0], [1.0; 3]);
/// let input = Input { sim_box: &sim_box, position: [&x, &y, &y], radii: InputRadii::Uniform(1.5), kind: &[] };
/// let mut grid = Grid::new();
/// grid.build(&input);
/// let list = neighbor_list(&grid, &input, ListRequest { shifts: true, ..ListRequest::new(ListKind::Half) });
/// assert_eq!(list.row(0), [1]);
/// assert_eq!(list.shifts, Some(vec![[-1, 0, 0]]));
/// # Ok::<(), nearfield_core::Error>(())
/// ```
pub fn neighbor_list(structure: &dyn Structure, input: &Input, request: ListRequest) -> NeighborList {
    let mut list = empty(request);
    ListBuilder::default().build(structure, input, request, &mut list);
    list
}

/// A list of nothing, to be built into.
pub(crate) fn empty(request: ListRequest) -> NeighborList {
    NeighborList { kind: request.kind, offsets: vec![0], indices: Vec::new(), shifts: None, distances: None }
}

impl ListBuilder {
    /// Replaces `list` by the neighbour list of the particles of `input`, from a structure built from it.
    pub fn build(&mut self, structure: &dyn Structure, input: &Input, request: ListRequest, list: &mut NeighborList) {
        let queries = Queries::new(structure, input);
        let rule = Rule::for_list(structure, request.kind);
        if rule == Rule::Acting {
            let contents = Contents::Rows { images: request.shifts, distances: request.distances };
            self.collect(structure, input.sim_box, queries, None, rule, contents);
            mirror::assemble(&self.tasks, input.len(), request, list);
            sort_rows(list);
        } else {
            self.list(structure, input.sim_box, queries, input.len(), rule, request, list);
        }
    }

    /// Lists the rows of `n_rows` queries in their input order.
    #[expect(clippy::too_many_arguments, reason = "queries and points may be different sets")]
    pub(crate) fn list(
        &mut self,
        structure: &dyn Structure,
        sim_box: &SimBox,
        queries: Queries,
        n_rows: usize,
        rule: Rule,
        request: ListRequest,
        list: &mut NeighborList,
    ) {
        let contents = Contents::Rows { images: request.shifts, distances: request.distances };
        self.collect(structure, sim_box, queries, Some(n_rows), rule, contents);
        let Self { tasks, addresses } = self;
        resize(list, request, addresses.lengths());
        Columns::of(list).for_each_block(&|columns: Columns, rows: Range<usize>| {
            columns.fill(
                rows,
                #[inline(always)]
                |i| {
                    let Place { task, stream, first } = addresses.of(i);
                    (&tasks[task], stream, first)
                },
            );
        });
        if request.sorted {
            sort_rows(list);
        }
    }

    /// Number of neighbours of each particle of `input`, and of pairs.
    pub(crate) fn count(&mut self, structure: &dyn Structure, input: &Input, neighbors: &mut Vec<u32>) -> u64 {
        let rule = Rule::for_list(structure, ListKind::Full);
        let queries = Queries::new(structure, input);
        neighbors.clear();
        if rule == Rule::Acting {
            let contents = Contents::Rows { images: false, distances: false };
            self.collect(structure, input.sim_box, queries, None, rule, contents);
            mirror::count(&self.tasks, input.len(), neighbors)
        } else {
            self.collect(structure, input.sim_box, queries, Some(input.len()), rule, Contents::Count);
            neighbors.extend(self.addresses.lengths());
            neighbors.par_iter().map(|&n| u64::from(n)).sum::<u64>() / 2
        }
    }

    /// Fills the rows of all tasks, and notes where they are if there are to be no more than `n_rows` of them.
    fn collect(
        &mut self,
        structure: &dyn Structure,
        sim_box: &SimBox,
        queries: Queries,
        n_rows: Option<usize>,
        rule: Rule,
        contents: Contents,
    ) {
        let n_groups = queries.structure.n_groups();
        let n_tasks = (TASKS_PER_THREAD * rayon::current_num_threads()).min(n_groups / LEAST_GROUPS).max(1);
        let Self { tasks, addresses } = self;
        tasks.resize_with(n_tasks, Rows::default);
        addresses.resize(n_rows.unwrap_or(0));
        let addresses = &*addresses;
        tasks.par_iter_mut().enumerate().for_each(|(task, rows)| {
            let groups = n_groups * task / n_tasks..n_groups * (task + 1) / n_tasks;
            rows.collect(structure, sim_box, queries, groups, rule, contents);
            if n_rows.is_some() {
                addresses.note(task, rows);
            }
        });
    }
}

/// Gives `list` the columns of `request` and rows of these lengths.
pub(super) fn resize(list: &mut NeighborList, request: ListRequest, lengths: impl Iterator<Item = u32>) {
    list.kind = request.kind;
    list.offsets.clear();
    list.offsets.push(0);
    let mut end = 0;
    list.offsets.extend(lengths.map(|length| {
        end += u64::from(length);
        end
    }));
    let end = end as usize;
    resize_column(&mut list.indices, end);
    match request.shifts {
        true => resize_column(list.shifts.get_or_insert_default(), end),
        false => list.shifts = None,
    }
    match request.distances {
        true => resize_column(list.distances.get_or_insert_default(), end),
        false => list.distances = None,
    }
}

/// Resizes a column that will be overwritten. Zeros of a new one come from the operating system, page by page as
/// they are used.
fn resize_column<T: Copy + Default>(column: &mut Vec<T>, len: usize) {
    if column.capacity() < len {
        *column = vec![T::default(); len];
    } else {
        column.resize(len, T::default());
    }
}

/// The columns of some consecutive rows of a list.
struct Columns<'a> {
    /// Of the rows, and the end of the last.
    offsets: &'a [u64],
    first_row: usize,
    indices: &'a mut [u32],
    shifts: Option<&'a mut [[i8; 3]]>,
    distances: Option<&'a mut [f32]>,
}

impl<'a> Columns<'a> {
    fn of(list: &'a mut NeighborList) -> Self {
        Self {
            offsets: &list.offsets,
            first_row: 0,
            indices: &mut list.indices,
            shifts: list.shifts.as_deref_mut(),
            distances: list.distances.as_deref_mut(),
        }
    }

    fn n_rows(&self) -> usize {
        self.offsets.len() - 1
    }

    fn extent(&self, row: usize) -> Range<usize> {
        let start = |row: usize| (self.offsets[row] - self.offsets[0]) as usize;
        start(row)..start(row + 1)
    }

    fn split(self, row: usize) -> (Self, Self) {
        let at = self.extent(row).start;
        let (indices, later_indices) = self.indices.split_at_mut(at);
        let (shifts, later_shifts) = self.shifts.map(|column| column.split_at_mut(at)).unzip();
        let (distances, later_distances) = self.distances.map(|column| column.split_at_mut(at)).unzip();
        let first_row = self.first_row;
        let offsets = &self.offsets[..=row];
        let first = Self { offsets, first_row, indices, shifts, distances };
        let offsets = &self.offsets[row..];
        let second = Self {
            offsets,
            first_row: first_row + row,
            indices: later_indices,
            shifts: later_shifts,
            distances: later_distances,
        };
        (first, second)
    }

    /// Calls `work` for blocks of rows in parallel.
    fn for_each_block(self, work: &(impl Fn(Columns, Range<usize>) + Sync)) {
        if self.n_rows() < 2 * LEAST_ROWS {
            let rows = self.first_row..self.first_row + self.n_rows();
            work(self, rows);
        } else {
            let half = self.n_rows() / 2;
            let (first, second) = self.split(half);
            rayon::join(|| first.for_each_block(work), || second.for_each_block(work));
        }
    }

    /// Copies every row from its source: rows, stream and first entry.
    fn fill<'b>(mut self, rows: Range<usize>, source: impl Fn(usize) -> (&'b Rows, usize, usize)) {
        for (k, i) in rows.clone().enumerate() {
            if i + AHEAD < rows.end {
                let (from, stream, start) = source(i + AHEAD);
                if let Some(row) = from.indices(stream)[start..].first_chunk::<FETCHED>() {
                    prefetch(row);
                }
            }
            let extent = self.extent(k);
            let (from, stream, start) = source(i);
            let row = from.row(i as u32, stream, start..start + extent.len());
            copy_over(&from.indices(stream)[start..], extent.len(), &mut self.indices[extent.start..]);
            if let Some(shifts) = &mut self.shifts {
                shifts[extent.clone()].copy_from_slice(row.images);
            }
            if let Some(distances) = &mut self.distances {
                for (distance, &r2) in distances[extent].iter_mut().zip(row.r2) {
                    *distance = r2.sqrt();
                }
            }
        }
    }

    /// Sorts every row by index.
    fn sort(self) {
        let mut order: Vec<(u32, [i8; 3], f32)> = Vec::new();
        let Columns { offsets, indices, mut shifts, mut distances, .. } = self;
        for row in offsets.windows(2) {
            let extent = (row[0] - offsets[0]) as usize..(row[1] - offsets[0]) as usize;
            if shifts.is_none() && distances.is_none() {
                indices[extent].sort_unstable();
                continue;
            }
            order.clear();
            order.extend(extent.clone().map(|k| {
                let image = shifts.as_ref().map_or([0; 3], |shifts| shifts[k]);
                (indices[k], image, distances.as_ref().map_or(0.0, |distances| distances[k]))
            }));
            order.sort_unstable_by_key(|entry| (entry.0, entry.1));
            for (k, &(index, image, distance)) in extent.zip(&order) {
                indices[k] = index;
                if let Some(shifts) = &mut shifts {
                    shifts[k] = image;
                }
                if let Some(distances) = &mut distances {
                    distances[k] = distance;
                }
            }
        }
    }
}

/// Sorts every row by index.
fn sort_rows(list: &mut NeighborList) {
    Columns::of(list).for_each_block(&|columns: Columns, _| columns.sort());
}
