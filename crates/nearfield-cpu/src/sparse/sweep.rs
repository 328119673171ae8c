//! Finding pairs: each pencil against itself, and against the later ones near it.

use super::Pair;
use crate::{
    Grid, GroupBox, LANES, Run, Slots, Structure,
    candidates::Candidates,
    grid::NearPencil,
    lanes::{self, Lanes},
};
use nearfield_core::{SimBox, predicate};
use std::ops::Range;

/// Tests that a pair counts as.
const TESTS_PER_PAIR: usize = 8;

/// The pairs of some pencils, and buffers.
#[derive(Default)]
pub(super) struct Task {
    pub pairs: Vec<Pair>,
    near: Vec<NearPencil>,
    /// The particles of two pencils that are near the other.
    faces: [Candidates; 2],
}

impl Task {
    pub fn bytes(&self) -> usize {
        let faces = self.faces.iter().map(|face| 24 * face.x.capacity()).sum::<usize>();
        faces + self.pairs.capacity() * size_of::<Pair>() + self.near.capacity() * size_of::<NearPencil>()
    }
}

/// Finds the pairs of the particles of some pencils with each other and with those of later pencils. Gives whether there
/// were few enough candidates.
pub(super) struct Sweep<'a> {
    pub grid: &'a Grid,
    pub sim_box: &'a SimBox,
    pub radius: f32,
    /// For each particle.
    pub most_tests: usize,
    pub pencils: Range<usize>,
    pub task: &'a mut Task,
}

impl lanes::Kernel for Sweep<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> bool {
        let Self { grid, sim_box, radius, most_tests, pencils, task } = self;
        let Task { pairs, near, faces } = task;
        let slots = grid.slots();
        let n = grid.pencil_slots(pencils.end - 1).end - grid.pencil_slots(pencils.start).start;
        let mut left = most_tests.saturating_mul(n + LANES);
        pairs.clear();
        for p in pencils {
            let Some(here) = grid.pencil_box(p, radius) else { continue };
            let own = grid.pencil_slots(p);
            sweep_within(lanes, slots, own.clone(), radius, pairs, &mut left);
            near.clear();
            grid.find_pencils(&here, p, near);
            for &NearPencil { pencil, image } in &*near {
                // Of two opposite images of a pencil to itself one is enough.
                let Some(there) = grid.pencil_box(pencil, radius).filter(|_| pencil > p || image > [0; 3]) else {
                    continue;
                };
                let between = Between { structure: (slots, sim_box), radius, image };
                between.sweep(
                    lanes,
                    [(own.clone(), here), (grid.pencil_slots(pencil), there)],
                    faces,
                    pairs,
                    &mut left,
                );
            }
            if left == 0 {
                return false;
            }
        }
        true
    }
}

/// Appends the pairs of particles that are sorted along x. Stops when there are no tests `left`.
#[inline(always)]
fn sweep_within<L: Lanes>(
    lanes: L,
    slots: &Slots,
    pencil: Range<usize>,
    radius: f32,
    pairs: &mut Vec<Pair>,
    left: &mut usize,
) {
    let (range, range2) = (lanes.splat(radius), lanes.splat(radius * radius));
    for first in pencil.clone().step_by(LANES) {
        let [x, y, z] = load(lanes, slots, first);
        let mut second = first + 1;
        while second < pencil.end {
            let present = if pencil.end - second < LANES { (1 << (pencil.end - second)) - 1 } else { u16::MAX };
            let [xj, yj, zj] = load(lanes, slots, second);
            let dx = lanes.sub(xj, x);
            // A displacement of the range or more along x makes no pair, rounded as it is, nor do larger ones.
            let near = lanes.lt(dx, range) & present;
            if near == 0 {
                break;
            }
            let (dy, dz) = (lanes.sub(yj, y), lanes.sub(zj, z));
            let r2 = lanes.mul_add(dx, dx, lanes.mul_add(dy, dy, lanes.mul(dz, dz)));
            let mut inside = lanes.lt(r2, range2) & near;
            *left = left.saturating_sub(1 + TESTS_PER_PAIR * inside.count_ones() as usize);
            if *left == 0 {
                return;
            }
            while inside != 0 {
                let lane = inside.trailing_zeros() as usize;
                let (i, j) = (slots.particle[first + lane], slots.particle[second + lane]);
                pairs.push(Pair { i, j, image: [0; 3] });
                inside &= inside - 1;
            }
            second += 1;
        }
    }
}

#[inline(always)]
fn load<L: Lanes>(lanes: L, slots: &Slots, at: usize) -> [L::F; 3] {
    let chunk = |axis: &'_ [f32]| -> [f32; LANES] { *axis[at..].first_chunk().expect("slots are padded") };
    [lanes.load(&chunk(&slots.x)), lanes.load(&chunk(&slots.y)), lanes.load(&chunk(&slots.z))]
}

/// Two pencils, the second seen in an image.
struct Between<'a> {
    structure: (&'a Slots, &'a SimBox),
    radius: f32,
    image: [i8; 3],
}

impl Between<'_> {
    /// Appends the pairs of particles of one pencil with those of the other.
    #[inline(always)]
    fn sweep<L: Lanes>(
        &self,
        lanes: L,
        [(first, here), (second, there)]: [(Range<usize>, GroupBox); 2],
        [near_first, near_second]: &mut [Candidates; 2],
        pairs: &mut Vec<Pair>,
        left: &mut usize,
    ) {
        let run = |slots: Range<usize>, image| [Run { start: slots.start as u32, end: slots.end as u32, image }];
        near_first.gather(lanes, self.structure, &there, &run(first, self.image.map(|i| -i)), false, false);
        if near_first.len() == 0 {
            return;
        }
        near_second.gather(lanes, self.structure, &here, &run(second, self.image), false, false);
        if near_second.len() == 0 {
            return;
        }
        let (first, second) = (Face::of(near_first), Face::of(near_second));
        let shift = self.structure.1.shift(self.image);
        let range2 = self.radius * self.radius;
        let mut begin = 0;
        for i in 0..first.x.len() {
            // Padding follows the last in both.
            if first.x[i] >= Slots::FAR {
                break;
            }
            let dx = |j: usize| (second.x[j] - first.x[i]) + shift[0];
            while dx(begin) <= -self.radius {
                begin += 1;
            }
            let mut j = begin;
            while dx(j) < self.radius {
                let dr = predicate::displacement(first.at(i), second.at(j), shift);
                let inside = predicate::squared_length(dr) < range2 && first.particle[i] != second.particle[j];
                *left = left.saturating_sub(1 + TESTS_PER_PAIR * usize::from(inside));
                if *left == 0 {
                    return;
                }
                if inside {
                    pairs.push(Pair { i: first.particle[i], j: second.particle[j], image: self.image });
                }
                j += 1;
            }
        }
    }
}

/// The particles of a pencil that are near another, sorted along x and followed by padding.
struct Face<'a> {
    x: &'a [f32],
    y: &'a [f32],
    z: &'a [f32],
    particle: &'a [u32],
}

impl<'a> Face<'a> {
    #[inline(always)]
    fn of(candidates: &'a Candidates) -> Self {
        let Candidates { x, y, z, particle, .. } = candidates;
        Self { x, y, z, particle }
    }

    #[inline(always)]
    fn at(&self, k: usize) -> [f32; 3] {
        [self.x[k], self.y[k], self.z[k]]
    }
}
