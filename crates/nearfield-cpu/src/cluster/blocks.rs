//! Particles in blocks of eight, sorted in space.

use super::{BLOCK, Keeping, Moving, motion::Motion, padding};
use crate::{Grid, parallel::Scattered, physics::Physics};
use rayon::prelude::*;
use std::ops::Range;

/// Blocks that a task of a pass over particles handles.
pub(super) const PAGE: usize = 64;

/// Budget of padding, which does not move: more than it needs, with a finite square.
pub(super) const UNMOVED: f32 = 1e18;

/// Eight vectors, an array for each component.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Octet(pub [[f32; BLOCK]; 3]);

/// Where the particles of a block are expected halfway through the life of an inner list, and how far from there each may
/// be before the list must be pruned.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Outlook {
    pub midway: Octet,
    pub budget: [f32; BLOCK],
}

impl Default for Outlook {
    fn default() -> Self {
        Self { midway: Octet::default(), budget: [UNMOVED; BLOCK] }
    }
}

/// Blocks of eight particles. Those of a pencil are sorted along x, the last block of each pencil is padded.
#[derive(Default)]
pub(super) struct Blocks {
    /// Wrapped positions, padding far away.
    pub position: Vec<Octet>,
    /// Types; empty when there is only one.
    pub kind: Vec<[u32; BLOCK]>,
    /// Periods crossed by each particle since the list was built, as small whole numbers.
    pub crossings: Vec<Octet>,
    /// Whether any particle of a block has crossed, or had when the inner list was made.
    pub crossed: Vec<bool>,
    /// First particle of each block, and a sentinel.
    pub first: Vec<u32>,
    /// Block of each particle.
    pub block_of: Vec<u32>,
    /// Lengths of periodic axes, zero elsewhere.
    pub period: [f32; 3],
    pub cutoff: f32,
    /// Largest magnitude of a coordinate, images included: what rounding errors scale with.
    pub extent: f32,
    /// Where particles were expected to be halfway through the life of the outer list.
    pub midway: Vec<Octet>,
    /// What is expected of them while the inner list serves.
    pub outlook: Vec<Outlook>,
    /// Farthest that `midway` is from where a particle was when the outer list was built.
    pub lead: f32,
    pub motion: Motion,
}

impl Blocks {
    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Particles of block `b`.
    pub fn particles(&self, b: usize) -> Range<usize> {
        self.first[b] as usize..self.first[b + 1] as usize
    }

    /// Number of passes' tasks.
    pub fn n_pages(&self) -> usize {
        self.len().div_ceil(PAGE)
    }

    /// Blocks of page `page`.
    pub fn page(&self, page: usize) -> Range<usize> {
        page * PAGE..((page + 1) * PAGE).min(self.len())
    }

    /// Fills the blocks with particles in the order of the grid's slots.
    pub fn fill(&mut self, grid: &Grid, physics: &Physics, moving: Moving, keeping: Keeping) {
        let lengths = physics.sim_box.lengths();
        self.period = std::array::from_fn(|a| if physics.sim_box.is_periodic(a) { lengths[a] } else { 0.0 });
        self.cutoff = physics.cutoff();
        self.first.clear();
        self.block_of.clear();
        for p in 0..grid.n_pencils() {
            let pencil = grid.pencil_slots(p);
            for first in pencil.clone().step_by(BLOCK) {
                let n = BLOCK.min(pencil.end - first);
                self.block_of.extend(std::iter::repeat_n(self.first.len() as u32, n));
                self.first.push(first as u32);
            }
        }
        self.first.push(self.block_of.len() as u32);
        let n = self.first.len() - 1;
        for vectors in [&mut self.position, &mut self.crossings, &mut self.midway] {
            vectors.resize(n, Octet::default());
        }
        self.outlook.resize(n, Outlook::default());
        self.crossed.resize(n, false);
        self.kind.clear();
        if !moving.kind.is_empty() {
            self.kind.extend(self.first.windows(2).map(|pair| {
                let kinds = &moving.kind[pair[0] as usize..pair[1] as usize];
                std::array::from_fn(|lane| kinds.get(lane).copied().unwrap_or(0))
            }));
        }
        let first = &self.first;
        let extent = self.position.par_chunks_mut(PAGE).enumerate().map(|(page, positions)| {
            let mut extent = 0.0f32;
            for (k, position) in positions.iter_mut().enumerate() {
                let b = page * PAGE + k;
                let particles = first[b] as usize..first[b + 1] as usize;
                for axis in 0..3 {
                    let from = &moving.position[axis][particles.clone()];
                    position.0[axis][..from.len()].copy_from_slice(from);
                    for lane in from.len()..BLOCK {
                        position.0[axis][lane] = padding(b, lane);
                    }
                    extent = from.iter().fold(extent, |m, x| m.max(x.abs()));
                }
            }
            extent
        });
        let extent = extent.reduce(|| 0.0, f32::max);
        self.extent = self.period.into_iter().fold(extent, f32::max) + extent + keeping.reach(self.cutoff);
        self.crossings.par_iter_mut().with_min_len(4096).for_each(|c| *c = Octet::default());
        self.crossed.fill(false);
        self.begin_motion(moving, keeping);
    }

    /// Copies where particles are, in their order.
    pub fn copy_positions(&self, to: [&mut [f32]; 3]) {
        let to = to.map(Scattered::new);
        self.position.par_iter().with_min_len(PAGE).enumerate().for_each(|(b, position)| {
            let particles = self.particles(b);
            for (to, from) in to.iter().zip(&position.0) {
                // SAFETY: no two blocks have a particle in common.
                unsafe { to.range(particles.clone()) }.copy_from_slice(&from[..particles.len()]);
            }
        });
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let octets = self.position.capacity() + self.crossings.capacity();
        (octets + self.midway.capacity()) * size_of::<Octet>()
            + self.outlook.capacity() * size_of::<Outlook>()
            + self.kind.capacity() * 4 * BLOCK
            + 4 * (self.first.capacity() + self.block_of.capacity())
            + self.crossed.capacity()
    }
}
