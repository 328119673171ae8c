//! The build: particles are sorted by pencil, and those of a pencil along x (`order.rs`).
//!
//! Particles mostly come in nearly this order, for they were put into it some steps ago. So consecutive particles of one
//! pencil are counted and copied as wholes. Particles in no order go to their pencils one by one, as records, so that there
//! is but one place to write to. The order of slots does not depend on the number of threads: particles of a pencil
//! come to it by index, and stay so where their x is the same.

use super::layout::{Layout, Pencil, numbers};
use super::order::{Record, Sorting, range};
use super::{CELL_OCCUPANCY, Grid, classes};
use crate::lanes::{Isa, Kernel, Lanes};
use crate::parallel::Scattered;
use crate::{Input, LANES, Slots};
use rayon::prelude::*;
use std::ops::Range;

/// Fewest particles worth a task of their own.
const TASK: usize = 4096;

/// Tasks for each thread.
const TASKS_PER_THREAD: usize = 4;

/// Particles to a stretch from which on they are in some order.
const ORDERED: usize = 4;

/// Consecutive particles of one pencil, up to `end`.
#[derive(Clone, Copy, Debug, Default)]
struct Stretch {
    pencil: u32,
    end: u32,
}

/// Buffers of the build.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// The stretches of each task.
    stretches: Vec<Vec<Stretch>>,
    /// For each task, where its next particle of each pencil goes.
    places: Vec<u32>,
    /// Particles in pencils; empty where they are copied to their slots at once.
    records: Vec<Record>,
}

impl Scratch {
    pub fn bytes(&self) -> usize {
        let stretches = self.stretches.iter().map(Vec::capacity).sum::<usize>();
        let records = size_of::<Record>() * self.records.capacity();
        4 * self.places.capacity() + size_of::<Stretch>() * stretches + records
    }
}

impl Grid {
    /// Fills slots, pencils, cells and groups by the layouts.
    pub(super) fn sort(&mut self, input: &Input) {
        let n_pencils = self.layouts.iter().map(Layout::len).sum::<usize>();
        // Histograms of all tasks together stay below the particles, where there are more than one.
        let most = TASKS_PER_THREAD * rayon::current_num_threads();
        let n_tasks = most.min(input.len() / TASK.max(n_pencils)).max(1);
        self.count(input, n_pencils, n_tasks);
        self.place_pencils(n_pencils, input.len());
        self.scatter(input, n_pencils);
        self.sort_pencils(input);
    }

    fn count(&mut self, input: &Input, n_pencils: usize, n_tasks: usize) {
        let Scratch { stretches, places, .. } = &mut self.scratch;
        stretches.resize_with(n_tasks, Vec::new);
        places.clear();
        places.resize(n_pencils * n_tasks, 0);
        let layouts = &self.layouts[..];
        let limits: &[f32] = &layouts.iter().map(|layout| layout.limit).collect::<Vec<_>>();
        let tasks = stretches.par_iter_mut().zip(places.par_chunks_mut(n_pencils)).with_max_len(1).enumerate();
        tasks.for_each(|(task, (stretches, counts))| {
            let particles = input.len() * task / n_tasks..input.len() * (task + 1) / n_tasks;
            Isa::detect().run(Count { input, layouts, limits, particles, counts, stretches });
        });
    }

    /// Turns counts into places, and gives each pencil its first slot and cell.
    fn place_pencils(&mut self, n_pencils: usize, n: usize) {
        self.pencils.clear();
        let (mut slot, mut cell) = (0, 0);
        for p in 0..n_pencils {
            self.pencils.push(Pencil { slots: slot, cells: cell, ..Pencil::default() });
            for place in self.scratch.places[p..].iter_mut().step_by(n_pencils) {
                (slot, *place) = (slot + *place, slot);
            }
            cell += (slot - self.pencils[p].slots).div_ceil(CELL_OCCUPANCY as u32);
        }
        self.pencils.push(Pencil { slots: slot, cells: cell, ..Pencil::default() });
        self.cells.resize(cell as usize + 1, 0);
        self.cells[cell as usize] = n as u32;
    }

    /// Puts particles into their pencils: into slots where they come in some order, else into records.
    fn scatter(&mut self, input: &Input, n_pencils: usize) {
        let n = input.len();
        self.slots.resize(n, input);
        let Slots { x, y, z, particle, .. } = &mut self.slots;
        let (position, particle) = ([x, y, z].map(|axis| Scattered::new(axis)), Scattered::new(particle));
        let Scratch { stretches, places, records } = &mut self.scratch;
        let n_tasks = stretches.len();
        let is_ordered = n >= ORDERED * stretches.iter().map(Vec::len).sum::<usize>();
        records.resize(if is_ordered { 0 } else { n }, Record::default());
        let records = Scattered::new(records);
        let tasks = stretches.par_iter().zip(places.par_chunks_mut(n_pencils)).with_max_len(1).enumerate();
        tasks.for_each(|(task, (stretches, places))| {
            let mut begin = n * task / n_tasks;
            for stretch in stretches {
                let place = &mut places[stretch.pencil as usize];
                let from = begin..stretch.end as usize;
                let to = *place as usize..*place as usize + from.len();
                // SAFETY: each task has places of its own for the particles of each pencil, as many as it has counted.
                unsafe {
                    if is_ordered {
                        for (to_axis, axis) in position.iter().zip(input.position) {
                            to_axis.range(to.clone()).copy_from_slice(&axis[from.clone()]);
                        }
                        for (particle, i) in particle.range(to.clone()).iter_mut().zip(from.clone()) {
                            *particle = i as u32;
                        }
                    } else {
                        for (record, i) in records.range(to.clone()).iter_mut().zip(from.clone()) {
                            *record = Record { position: input.at(i), particle: i as u32 };
                        }
                    }
                }
                *place = to.end as u32;
                begin = from.end;
            }
        });
    }

    fn sort_pencils(&mut self, input: &Input) {
        let n = input.len();
        let n_tasks = (TASKS_PER_THREAD * rayon::current_num_threads()).min(n / TASK).max(1);
        let mut rest = Block::new(&mut self.slots, &mut self.pencils, &mut self.cells, &self.scratch.records);
        let mut blocks = Vec::with_capacity(n_tasks);
        for task in 1..n_tasks {
            let block;
            (block, rest) = rest.split_before_slot((n * task / n_tasks) as u32);
            blocks.push(block);
        }
        blocks.push(rest);
        let (layouts, group_size) = (&self.layouts[..], self.group_size);
        blocks.par_iter_mut().with_max_len(1).for_each(|block| {
            Isa::detect().run(Sort { block, input, layouts, group_size });
        });
        self.groups.clear();
        for block in &blocks {
            self.groups.extend_from_slice(&block.groups);
        }
        self.groups.push(n as u32);
    }
}

/// Finds the stretches of some particles, and counts the particles of each pencil.
struct Count<'a> {
    input: &'a Input<'a>,
    layouts: &'a [Layout],
    limits: &'a [f32],
    particles: Range<usize>,
    counts: &'a mut [u32],
    stretches: &'a mut Vec<Stretch>,
}

impl Kernel for Count<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { input, layouts, limits, particles, counts, stretches } = self;
        let [_, y, z] = input.position.map(|axis| &axis[particles.clone()]);
        let (mut len, mut begin, mut current) = (0, 0, u32::MAX);
        for at in (0..y.len()).step_by(LANES) {
            let n = LANES.min(y.len() - at);
            let mut pencils = [current; LANES];
            if let ([layout], Some(y), Some(z)) = (layouts, y[at..].first_chunk(), z[at..].first_chunk()) {
                pencils = layout.pencils_of(lanes, y, z);
            } else {
                for k in 0..n {
                    let i = particles.start + at + k;
                    let class = if limits.len() == 1 { 0 } else { classes::class_of(limits, input.radius(i)) };
                    pencils[k] = layouts[class].pencil_of(y[at + k], z[at + k]) as u32;
                }
            }
            if lanes.ne_u(lanes.load_u(&pencils), lanes.splat_u(current)) == 0 {
                continue;
            }
            if stretches.len() < len + LANES + 1 {
                stretches.resize((2 * len).max(4 * LANES), Stretch::default());
            }
            for (k, &pencil) in pencils[..n].iter().enumerate() {
                if pencil != current {
                    if at + k > 0 {
                        stretches[len] = Stretch { pencil: current, end: (particles.start + at + k) as u32 };
                        counts[current as usize] += (at + k - begin) as u32;
                        len += 1;
                    }
                    (begin, current) = (at + k, pencil);
                }
            }
        }
        stretches.truncate(len);
        if current != u32::MAX {
            stretches.push(Stretch { pencil: current, end: particles.end as u32 });
            counts[current as usize] += (y.len() - begin) as u32;
        }
    }
}

impl Slots {
    /// Makes room for `n` slots with what `input` has, and writes the padding.
    fn resize(&mut self, n: usize, input: &Input) {
        for axis in [&mut self.x, &mut self.y, &mut self.z] {
            axis.resize(n + LANES, 0.0);
            axis[n..].fill(Slots::FAR);
        }
        self.particle.resize(n + LANES, 0);
        self.particle[n..].fill(u32::MAX);
        let per_particle = matches!(input.radii, crate::InputRadii::PerParticle(_));
        self.radius.resize(if per_particle { n + LANES } else { 0 }, 0.0);
        self.kind.resize(if input.kind.is_empty() { 0 } else { n + LANES }, 0);
    }
}

/// Consecutive pencils and what belongs to them: the work of one task.
struct Block<'a> {
    first_pencil: usize,
    /// Its pencils; the one after the last, which ends them, is the next block's or the sentinel.
    pencils: &'a mut [Pencil],
    end: Pencil,
    cells: &'a mut [u32],
    /// Its particles, where they are not in slots yet.
    records: &'a [Record],
    position: [&'a mut [f32]; 3],
    particle: &'a mut [u32],
    radius: &'a mut [f32],
    kind: &'a mut [u32],
    groups: Vec<u32>,
}

impl<'a> Block<'a> {
    fn new(slots: &'a mut Slots, pencils: &'a mut [Pencil], cells: &'a mut [u32], records: &'a [Record]) -> Block<'a> {
        let (end, pencils) = pencils.split_last_mut().expect("there is a sentinel");
        Block {
            first_pencil: 0,
            pencils,
            end: *end,
            cells,
            records,
            position: [&mut slots.x, &mut slots.y, &mut slots.z],
            particle: &mut slots.particle,
            radius: &mut slots.radius,
            kind: &mut slots.kind,
            groups: Vec::new(),
        }
    }

    /// The pencils that begin before `slot`, and the others.
    fn split_before_slot(self, slot: u32) -> (Block<'a>, Block<'a>) {
        let begin = self.pencils.first().map_or(self.end, |p| *p);
        let at = self.pencils.partition_point(|p| p.slots < slot);
        let (pencils, later) = self.pencils.split_at_mut(at);
        let end = later.first().map_or(self.end, |p| *p);
        let n = (end.slots - begin.slots) as usize;
        let (cells, later_cells) = self.cells.split_at_mut((end.cells - begin.cells) as usize);
        let (records, later_records) = self.records.split_at(n.min(self.records.len()));
        let [x, y, z] = self.position.map(|axis| axis.split_at_mut(n));
        let (particle, later_particle) = self.particle.split_at_mut(n);
        let (radius, later_radius) = self.radius.split_at_mut(n.min(self.radius.len()));
        let (kind, later_kind) = self.kind.split_at_mut(n.min(self.kind.len()));
        let first = Block {
            first_pencil: self.first_pencil,
            pencils,
            end,
            cells,
            records,
            position: [x.0, y.0, z.0],
            particle,
            radius,
            kind,
            groups: Vec::new(),
        };
        let second = Block {
            first_pencil: self.first_pencil + at,
            pencils: later,
            end: self.end,
            cells: later_cells,
            records: later_records,
            position: [x.1, y.1, z.1],
            particle: later_particle,
            radius: later_radius,
            kind: later_kind,
            groups: Vec::new(),
        };
        (first, second)
    }
}

/// Sorts the particles of each pencil of a block and divides them into cells and groups.
struct Sort<'a, 'b> {
    block: &'a mut Block<'b>,
    input: &'a Input<'a>,
    layouts: &'a [Layout],
    group_size: usize,
}

impl Kernel for Sort<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { block, input, layouts, group_size } = self;
        let Some(&begin) = block.pencils.first() else { return };
        let mut sorting = Sorting::default();
        for p in 0..block.pencils.len() {
            let start = block.pencils[p];
            let end = block.pencils.get(p + 1).map_or(block.end, |next| *next);
            if start.slots == end.slots {
                continue;
            }
            let slots = (start.slots - begin.slots) as usize..(end.slots - begin.slots) as usize;
            let [x, y, z] = &mut block.position;
            let (x, y, z) = (&mut x[slots.clone()], &mut y[slots.clone()], &mut z[slots.clone()]);
            let (position, particle) = ([&mut *x, &mut *y, &mut *z], &mut block.particle[slots.clone()]);
            if block.records.is_empty() {
                sorting.sort(lanes, position, particle);
            } else {
                sorting.sort_records(lanes, &block.records[slots.clone()], position, particle);
            }
            let pencil = measure(lanes, start, end, [x, y, z]);
            block.pencils[p] = pencil;
            let cells = (start.cells - begin.cells) as usize..(end.cells - begin.cells) as usize;
            divide_cells(lanes, x, &pencil, &mut block.cells[cells]);
            let class = layouts.partition_point(|layout| layout.first <= block.first_pencil + p) - 1;
            divide_groups(x, start.slots, group_size, layouts[class].group_length, &mut block.groups);
            let particles = &block.particle[slots.clone()];
            if !block.radius.is_empty() {
                for (radius, &i) in block.radius[slots.clone()].iter_mut().zip(particles) {
                    *radius = input.radius(i as usize);
                }
            }
            if !block.kind.is_empty() {
                for (kind, &i) in block.kind[slots].iter_mut().zip(particles) {
                    *kind = input.kind[i as usize];
                }
            }
        }
    }
}

/// A pencil with the bounds of its particles, which are sorted along x, and its division into cells.
#[inline(always)]
fn measure<L: Lanes>(lanes: L, start: Pencil, end: Pencil, [x, y, z]: [&[f32]; 3]) -> Pencil {
    let (first, last) = (x[0], x[x.len() - 1]);
    let per_length = (end.cells - start.cells) as f32 / (last - first);
    let cells_per_length = if per_length.is_finite() { per_length } else { 0.0 };
    Pencil { x0: first, cells_per_length, y: range(lanes, y), z: range(lanes, z), ..start }
}

/// Writes the first slot of each cell of a pencil, whose particles are sorted along x.
#[inline(always)]
fn divide_cells<L: Lanes>(lanes: L, x: &[f32], pencil: &Pencil, cells: &mut [u32]) {
    let end = pencil.slots + x.len() as u32;
    let last = cells.len() - 1;
    let (x0, per_length) = (lanes.splat(pencil.x0), lanes.splat(pencil.cells_per_length));
    cells.fill(end);
    // From behind, so that the first slot of a cell is written last.
    for (c, chunk) in x.chunks(LANES).enumerate().rev() {
        let mut values = [0.0; LANES];
        values[..chunk.len()].copy_from_slice(chunk);
        let cell_of = numbers(lanes, lanes.load(&values), x0, per_length);
        for k in (0..chunk.len()).rev() {
            cells[(cell_of[k] as usize).min(last)] = pencil.slots + (c * LANES + k) as u32;
        }
    }
    let mut next = end;
    for cell in cells.iter_mut().rev() {
        next = next.min(*cell);
        *cell = next;
    }
}

/// Appends the first slots of the groups of one pencil: even in size, and short along x.
#[inline(always)]
fn divide_groups(x: &[f32], first_slot: u32, most: usize, longest: f32, groups: &mut Vec<u32>) {
    let size = x.len().div_ceil(x.len().div_ceil(most));
    let mut begin = 0;
    while begin < x.len() {
        groups.push(first_slot + begin as u32);
        let mut end = (begin + size).min(x.len());
        while x[end - 1] - x[begin] > longest {
            end -= 1;
        }
        begin = end;
    }
}
