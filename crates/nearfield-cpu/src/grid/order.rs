//! The order of the particles of one pencil: along x, those at the same x as they come.

use crate::LANES;
use crate::lanes::Lanes;
use std::cmp::Ordering;

/// Descents to a particle that a pencil may have for its order to be repaired rather than made anew.
const DESCENTS: f32 = 0.125;

/// Moves for each particle after which insertion gives up.
const MOVES: usize = 8;

/// A particle on its way to its pencil.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
pub(super) struct Record {
    pub position: [f32; 3],
    pub particle: u32,
}

/// Cells to a particle by which a pencil is sorted: with one, twice as many particles share theirs with another.
const FINE: usize = 2;

/// Buffers for one pencil after the other.
#[derive(Default)]
pub(super) struct Sorting {
    position: [Vec<f32>; 3],
    particle: Vec<u32>,
    cell: Vec<u32>,
    /// Where cells begin, and where their next particle goes.
    places: Vec<u32>,
    order: Vec<u32>,
}

impl Sorting {
    /// Sorts particles along x.
    #[inline(always)]
    pub fn sort<L: Lanes>(&mut self, lanes: L, mut position: [&mut [f32]; 3], particle: &mut [u32]) {
        let x = &*position[0];
        let mut descents = 0u32;
        for (x, next) in x.iter().zip(&x[1..]) {
            descents += u32::from(next < x);
        }
        if descents == 0 || descents as f32 <= DESCENTS * x.len() as f32 && repair(&mut position, particle) {
            return;
        }
        for (copy, axis) in self.position.iter_mut().zip(&position) {
            copy.clear();
            copy.extend_from_slice(axis);
        }
        self.particle.clear();
        self.particle.extend_from_slice(particle);
        self.sort_copies(lanes, position, particle);
    }

    /// Writes the particles of records where they belong, sorted along x.
    #[inline(always)]
    pub fn sort_records<L: Lanes>(
        &mut self,
        lanes: L,
        records: &[Record],
        position: [&mut [f32]; 3],
        particle: &mut [u32],
    ) {
        let x = &mut self.position[0];
        x.resize(records.len(), 0.0);
        for (x, record) in x.iter_mut().zip(records) {
            *x = record.position[0];
        }
        self.find_order(lanes, records.len());
        let [x, y, z] = position;
        let places = x.iter_mut().zip(y).zip(z).zip(particle);
        for ((((x, y), z), particle), &k) in places.zip(&self.order) {
            let record = records[k as usize];
            [*x, *y, *z] = record.position;
            *particle = record.particle;
        }
    }

    /// Writes the copies in order.
    #[inline(always)]
    fn sort_copies<L: Lanes>(&mut self, lanes: L, position: [&mut [f32]; 3], particle: &mut [u32]) {
        self.find_order(lanes, particle.len());
        for (axis, copy) in position.into_iter().zip(&self.position) {
            for (to, &k) in axis.iter_mut().zip(&self.order) {
                *to = copy[k as usize];
            }
        }
        for (to, &k) in particle.iter_mut().zip(&self.order) {
            *to = self.particle[k as usize];
        }
    }

    /// Finds the order of the `n` copies along x: by cells, and sorted within them.
    #[inline(always)]
    fn find_order<L: Lanes>(&mut self, lanes: L, n: usize) {
        let x = &self.position[0][..n];
        let [lo, hi] = range(lanes, x);
        let n_cells = (FINE * n).min(u32::MAX as usize);
        let per_length = n_cells as f32 / (hi - lo);
        let per_length = if per_length.is_finite() { per_length } else { 0.0 };
        self.cell.resize(n, 0);
        // As whole numbers: of many particles the last cell is none of those that f32 has.
        let last = (n_cells - 1) as u32;
        for (cell, x) in self.cell.iter_mut().zip(x) {
            *cell = (((x - lo) * per_length) as u32).min(last);
        }
        self.places.clear();
        self.places.resize(n_cells + 1, 0);
        for &cell in &self.cell {
            self.places[cell as usize + 1] += 1;
        }
        let mut place = 0;
        for places in &mut self.places {
            place += *places;
            *places = place;
        }
        self.order.resize(n, 0);
        for (k, &cell) in self.cell.iter().enumerate() {
            let place = &mut self.places[cell as usize];
            self.order[*place as usize] = k as u32;
            *place += 1;
        }
        sort_along(x, &mut self.order[..n]);
    }
}

/// Least and largest.
#[inline(always)]
pub(super) fn range<L: Lanes>(lanes: L, values: &[f32]) -> [f32; 2] {
    let (chunks, rest) = values.as_chunks::<LANES>();
    let mut last = [rest.first().copied().unwrap_or(f32::MAX); LANES];
    last[..rest.len()].copy_from_slice(rest);
    let last = (!rest.is_empty()).then_some(&last);
    let (mut lo, mut hi) = (lanes.splat(f32::MAX), lanes.splat(f32::MIN));
    for chunk in chunks.iter().chain(last) {
        let values = lanes.load(chunk);
        (lo, hi) = (lanes.min(lo, values), lanes.max(hi, values));
    }
    let (mut least, mut largest) = ([0.0; LANES], [0.0; LANES]);
    lanes.compress(u16::MAX, lo, &mut least);
    lanes.compress(u16::MAX, hi, &mut largest);
    let mut range = [least[0], largest[0]];
    for k in 1..LANES {
        // Not `min` and `max`, whose treatment of NaN takes twice as long.
        range[0] = if least[k] < range[0] { least[k] } else { range[0] };
        range[1] = if largest[k] > range[1] { largest[k] } else { range[1] };
    }
    range
}

/// Puts the few particles that are out of order along x into their places. False, with particles nearer to their places,
/// where that takes too many moves.
#[inline(always)]
fn repair(position: &mut [&mut [f32]; 3], particle: &mut [u32]) -> bool {
    let mut moves = MOVES * particle.len();
    for k in 1..particle.len() {
        let x = &*position[0];
        let here = x[k];
        if x[k - 1] <= here {
            continue;
        }
        let mut at = k - 1;
        while at > 0 && x[at - 1] > here {
            at -= 1;
        }
        for axis in position.iter_mut() {
            insert(axis, k, at);
        }
        insert(particle, k, at);
        moves = moves.saturating_sub(k - at);
        if moves == 0 {
            return false;
        }
    }
    true
}

/// Moves value `k` to place `at` before it, and those from there on by one.
#[inline(always)]
fn insert<T: Copy>(values: &mut [T], k: usize, at: usize) {
    if k - at == 1 {
        values.swap(k, at);
    } else {
        let value = values[k];
        values.copy_within(at..k, at + 1);
        values[at] = value;
    }
}

/// Sorts `order`, nearly sorted as it is, by `x`.
fn sort_along(x: &[f32], order: &mut [u32]) {
    let mut moves = MOVES * order.len();
    for k in 1..order.len() {
        let (place, here) = (order[k], x[order[k] as usize]);
        let mut at = k;
        while at > 0 && x[order[at - 1] as usize] > here {
            order[at] = order[at - 1];
            at -= 1;
        }
        order[at] = place;
        moves = moves.saturating_sub(k - at);
        if moves == 0 {
            let by_x = |a: u32, b: u32| x[a as usize].partial_cmp(&x[b as usize]).unwrap_or(Ordering::Equal);
            order.sort_unstable_by(|&a, &b| by_x(a, b).then(a.cmp(&b)));
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::Portable;

    fn sorted(x: &[f32]) -> Vec<u32> {
        let mut axes = [x.to_vec(), x.iter().map(|x| 2.0 * x).collect(), x.iter().map(|x| 3.0 * x).collect()];
        let mut particle: Vec<u32> = (0..x.len() as u32).collect();
        let records: Vec<Record> = (0..x.len())
            .map(|k| Record { position: axes.each_ref().map(|axis| axis[k]), particle: particle[k] })
            .collect();
        let (mut from_records, mut particle_from_records) = (axes.clone(), particle.clone());
        let [a, b, c] = &mut axes;
        Sorting::default().sort(Portable, [a, b, c], &mut particle);
        let [a, b, c] = &mut from_records;
        Sorting::default().sort_records(Portable, &records, [a, b, c], &mut particle_from_records);
        assert_eq!((&axes, &particle), (&from_records, &particle_from_records));
        for (k, &i) in particle.iter().enumerate() {
            let x = x[i as usize];
            assert_eq!(axes.each_ref().map(|axis| axis[k]), [x, 2.0 * x, 3.0 * x]);
        }
        particle
    }

    #[test]
    fn any_order_becomes_that_of_x_and_then_of_arrival() {
        let n = 300;
        let random = |k: usize| (k * 7919 % 311) as f32;
        let cases: [Vec<f32>; 6] = [
            (0..n).map(|k| k as f32).collect(),
            (0..n).map(|k| -(k as f32)).collect(),
            (0..n).map(random).collect(),
            (0..n).map(|k| if k % 50 == 49 { random(k) } else { k as f32 }).collect(),
            (0..n).map(|k| if k == 17 { 1e30 } else { random(k) }).collect(),
            vec![5.0; n],
        ];
        for x in cases {
            let mut expected: Vec<u32> = (0..n as u32).collect();
            expected.sort_by(|&a, &b| x[a as usize].total_cmp(&x[b as usize]));
            assert_eq!(sorted(&x), expected, "{x:?}");
        }
    }

    #[test]
    fn a_pencil_of_more_cells_than_f32_can_tell_apart_is_sorted() {
        let n = (1 << 23) + 4;
        assert_eq!((FINE * n - 1) as f32 as usize, FINE * n, "the last cell, rounded, is one too many");
        let x = (0..n).rev().map(|k| k as f32).collect();
        let mut sorting = Sorting { position: [x, Vec::new(), Vec::new()], ..Sorting::default() };
        sorting.find_order(Portable, n);
        assert!(sorting.order.iter().rev().copied().eq(0..n as u32));
    }
}
