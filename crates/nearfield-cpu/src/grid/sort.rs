//! The build: a stable two-level counting sort, first by pencil, then by cell within each pencil.
//!
//! Stability makes the order of slots independent of the number of threads.

use super::layout::{Layout, Pencil};
use super::{CELL_OCCUPANCY, Grid, classes};
use crate::{Input, LANES, Slots};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Fewest particles worth a task of their own.
const TASK: usize = 4096;

/// Position bits and index of a particle, in pencil order. Atomic because threads write to interleaved places.
type Record = [AtomicU32; 4];

/// Buffers of the build.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// Pencil of each particle.
    keys: Vec<u32>,
    /// For each task, where its next particle of each pencil goes.
    places: Vec<u32>,
    records: Vec<Record>,
}

impl Scratch {
    pub fn bytes(&self) -> usize {
        4 * (self.keys.capacity() + self.places.capacity()) + size_of::<Record>() * self.records.capacity()
    }
}

impl Grid {
    /// Fills slots, pencils, cells and groups by the layouts.
    pub(super) fn sort(&mut self, input: &Input) {
        let n_pencils = self.layouts.iter().map(Layout::len).sum::<usize>();
        // Histograms of all tasks together stay below the particles, where there are more than one.
        let n_tasks = rayon::current_num_threads().min(input.len() / TASK.max(n_pencils)).max(1);
        let per_task = input.len().div_ceil(n_tasks).max(1);
        self.count(input, n_pencils, per_task);
        self.place_pencils(n_pencils, input.len());
        self.scatter(input, n_pencils, per_task);
        self.sort_pencils(input);
    }

    fn count(&mut self, input: &Input, n_pencils: usize, per_task: usize) {
        let Scratch { keys, places, records } = &mut self.scratch;
        let n = input.len();
        keys.resize(n, 0);
        records.resize_with(n, Record::default);
        places.clear();
        places.resize(n_pencils * n.div_ceil(per_task).max(1), 0);
        let layouts = &self.layouts;
        let limits: Vec<f32> = layouts.iter().map(|layout| layout.limit).collect();
        let tasks = keys.par_chunks_mut(per_task).zip(places.par_chunks_mut(n_pencils));
        tasks.enumerate().for_each(|(task, (keys, counts))| {
            let [_, y, z] = input.position;
            for (k, key) in keys.iter_mut().enumerate() {
                let i = task * per_task + k;
                let class = if limits.len() == 1 { 0 } else { classes::class_of(&limits, input.radius(i)) };
                let pencil = layouts[class].pencil_of(y[i], z[i]);
                *key = pencil as u32;
                counts[pencil] += 1;
            }
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
        self.cells.clear();
        self.cells.resize(cell as usize + 1, n as u32);
    }

    fn scatter(&mut self, input: &Input, n_pencils: usize, per_task: usize) {
        let Scratch { keys, places, records } = &mut self.scratch;
        let records = &records[..];
        let tasks = keys.par_chunks(per_task).zip(places.par_chunks_mut(n_pencils));
        tasks.enumerate().for_each(|(task, (keys, places))| {
            for (k, &key) in keys.iter().enumerate() {
                let i = task * per_task + k;
                let place = &mut places[key as usize];
                let [x, y, z] = input.at(i).map(f32::to_bits);
                for (field, value) in records[*place as usize].iter().zip([x, y, z, i as u32]) {
                    field.store(value, Relaxed);
                }
                *place += 1;
            }
        });
    }

    fn sort_pencils(&mut self, input: &Input) {
        let n = input.len();
        self.slots.resize(n, input);
        let n_tasks = (4 * rayon::current_num_threads()).min(n / TASK).max(1);
        let mut rest = Block::new(&mut self.slots, &mut self.pencils, &mut self.cells, &mut self.scratch.records);
        let mut blocks = Vec::with_capacity(n_tasks);
        for task in 1..n_tasks {
            let block;
            (block, rest) = rest.split_before_slot((n * task / n_tasks) as u32);
            blocks.push(block);
        }
        blocks.push(rest);
        let (layouts, group_size) = (&self.layouts, self.group_size);
        blocks.par_iter_mut().for_each(|block| block.sort(input, layouts, group_size));
        self.groups.clear();
        for block in &blocks {
            self.groups.extend_from_slice(&block.groups);
        }
        self.groups.push(n as u32);
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
    records: &'a mut [Record],
    position: [&'a mut [f32]; 3],
    particle: &'a mut [u32],
    radius: &'a mut [f32],
    kind: &'a mut [u32],
    groups: Vec<u32>,
}

impl<'a> Block<'a> {
    fn new(
        slots: &'a mut Slots,
        pencils: &'a mut [Pencil],
        cells: &'a mut [u32],
        records: &'a mut [Record],
    ) -> Block<'a> {
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
        let (records, later_records) = self.records.split_at_mut(n);
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

    fn sort(&mut self, input: &Input, layouts: &[Layout], group_size: usize) {
        let Some(&begin) = self.pencils.first() else { return };
        let mut cell_of = Vec::new();
        for p in 0..self.pencils.len() {
            let start = self.pencils[p];
            let end = self.pencils.get(p + 1).map_or(self.end, |next| *next);
            if start.slots == end.slots {
                continue;
            }
            let slots = (start.slots - begin.slots) as usize..(end.slots - begin.slots) as usize;
            let records = &mut self.records[slots.clone()];
            let pencil = measure(start, end, records);
            self.pencils[p] = pencil;

            let cells = &mut self.cells[(start.cells - begin.cells) as usize..(end.cells - begin.cells) as usize];
            cells.fill(0);
            let last = cells.len() - 1;
            cell_of.clear();
            cell_of.extend(records.iter_mut().map(|record| {
                let x = f32::from_bits(*record[0].get_mut());
                let cell = pencil.cell_of(x).min(last);
                cells[cell] += 1;
                cell as u32
            }));
            let mut running = start.slots;
            for cell in cells.iter_mut() {
                running += *cell;
                *cell = running;
            }
            // Each cell now holds its end. Filled from behind, it comes to hold its start.
            for (record, &cell) in records.iter_mut().zip(&cell_of).rev() {
                let cell = &mut cells[cell as usize];
                *cell -= 1;
                let slot = (*cell - begin.slots) as usize;
                let [x, y, z, particle] = record.each_mut().map(|field| *field.get_mut());
                self.position[0][slot] = f32::from_bits(x);
                self.position[1][slot] = f32::from_bits(y);
                self.position[2][slot] = f32::from_bits(z);
                self.particle[slot] = particle;
            }
            for slot in slots.clone() {
                let i = self.particle[slot] as usize;
                if !self.radius.is_empty() {
                    self.radius[slot] = input.radius(i);
                }
                if !self.kind.is_empty() {
                    self.kind[slot] = input.kind[i];
                }
            }
            let class = layouts.partition_point(|layout| layout.first <= self.first_pencil + p) - 1;
            let x = &self.position[0][slots];
            divide_groups(x, start.slots, group_size, layouts[class].group_length, &mut self.groups);
        }
    }
}

/// A pencil with the bounds of its particles and its division into cells.
fn measure(start: Pencil, end: Pencil, records: &mut [Record]) -> Pencil {
    let mut lo = [f32::MAX; 3];
    let mut hi = [f32::MIN; 3];
    for record in records {
        for axis in 0..3 {
            let value = f32::from_bits(*record[axis].get_mut());
            lo[axis] = lo[axis].min(value);
            hi[axis] = hi[axis].max(value);
        }
    }
    let per_length = (end.cells - start.cells) as f32 / (hi[0] - lo[0]);
    let cells_per_length = if per_length.is_finite() { per_length } else { 0.0 };
    Pencil { x0: lo[0], cells_per_length, y: [lo[1], hi[1]], z: [lo[2], hi[2]], ..start }
}

/// Appends the first slots of the groups of one pencil: even in size, and short along x.
fn divide_groups(x: &[f32], first_slot: u32, most: usize, longest: f32, groups: &mut Vec<u32>) {
    let size = x.len().div_ceil(x.len().div_ceil(most));
    let mut begin = 0;
    let (mut lo, mut hi) = (f32::MAX, f32::MIN);
    for (k, &x) in x.iter().enumerate() {
        let (new_lo, new_hi) = (lo.min(x), hi.max(x));
        if k == 0 || k - begin == size || new_hi - new_lo > longest {
            groups.push(first_slot + k as u32);
            begin = k;
            (lo, hi) = (x, x);
        } else {
            (lo, hi) = (new_lo, new_hi);
        }
    }
}
