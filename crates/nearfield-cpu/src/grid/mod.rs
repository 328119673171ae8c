//! The cell grid: pencils of cells over bins of similar radius.
//!
//! Space is cut along y and z into square *pencils*; the particles of a pencil lie next to each other in memory, sorted
//! along x and divided into fine *cells*. What a group of queries can reach in one pencil is therefore one run of slots,
//! found by two look-ups: the reach along x is `sqrt(r² - d²)`, with d the distance from the group to the pencil.
//!
//! - Pencil widths follow the particles, never the radius: about [`PENCIL_OCCUPANCY`] particles to a cube of that
//!   width. So memory stays proportional to N, however sparse the box.
//! - A pencil knows the bounds of its own particles and cuts its own cells, so clusters get fine cells, and far outliers
//!   on open axes only stretch the outermost pencils.
//! - Periodic images are searched by moving the group, not by wrapping cells: each pencil is visited at most once for
//!   an image, which also holds in boxes only a few pencils wide.
//! - Particles of similar radius form a *class* with pencils of its own. The pair range is max(r_i, r_j), so a group
//!   searches each class as far as the larger of its own radius and the largest of that class: a few large particles
//!   do not widen the search among the small ones.

mod classes;
mod images;
mod layout;
mod order;
mod pencils;
mod sort;
mod survey;
mod vicinity;

use crate::{GroupBox, Input, InputRadii, Run, Slots, Structure};
use layout::{Layout, Pencil};
pub(crate) use pencils::NearPencil;
use std::ops::Range;
use survey::{Bounds, Bulk};
pub use vicinity::Vicinity;

/// Particles to a cube as wide as a pencil.
const PENCIL_OCCUPANCY: f64 = 8.0;

/// Particles to a cell, along x in its pencil.
const CELL_OCCUPANCY: usize = 2;

/// Most particles in a group, unless asked for otherwise. Against 8, lists of 10⁵ points take 0.9 of the time with 8
/// neighbours each and as long with 32, counts 0.6 and 0.8: candidates are gathered for fewer groups. With 12 or 24 all take
/// as long as with 16. What is proposed to each particle grows by 1.2 to 1.4, but a consumer that tests candidates against
/// the group's box first hardly notices.
const GROUP_SIZE: usize = 16;

/// A cell grid over N particles.
///
/// Buffers are kept from one [`Grid::build`] to the next. The order of slots depends on the input alone, not on the
/// number of threads.
#[derive(Debug)]
pub struct Grid {
    slots: Slots,
    layouts: Vec<Layout>,
    /// Pencils of all classes, one after the other, and a sentinel.
    pencils: Vec<Pencil>,
    /// First slot of each cell of all pencils, and a sentinel.
    cells: Vec<u32>,
    /// First slot of each group, and a sentinel.
    groups: Vec<u32>,
    /// Most particles in a group.
    group_size: usize,
    bounds: Bounds,
    bulk: Bulk,
    /// Largest magnitude of a coordinate, images included: what rounding errors scale with.
    extent: f32,
    /// Period of each axis, zero where it has none.
    period: [f32; 3],
    scratch: sort::Scratch,
}

impl Grid {
    /// An empty grid.
    pub fn new() -> Self {
        Self::with_group_size(GROUP_SIZE)
    }

    /// An empty grid whose groups hold up to `group_size` particles. Small groups are proposed fewer candidates, large
    /// ones need fewer searches.
    pub fn with_group_size(group_size: usize) -> Self {
        Self {
            slots: Slots::default(),
            layouts: Vec::new(),
            pencils: Vec::new(),
            cells: Vec::new(),
            groups: Vec::new(),
            group_size: group_size.max(1),
            bounds: Bounds::default(),
            bulk: Bulk::default(),
            extent: 0.0,
            period: [0.0; 3],
            scratch: sort::Scratch::default(),
        }
    }

    /// Sorts the particles of `input` into cells.
    pub fn build(&mut self, input: &Input) {
        let lengths = input.sim_box.lengths();
        self.period = std::array::from_fn(|axis| if input.sim_box.is_periodic(axis) { lengths[axis] } else { 0.0 });
        self.bounds = Bounds::of(input);
        self.extent = largest(self.bounds.lo).max(largest(self.bounds.hi)) + largest(self.period);
        self.bulk = Bulk::of(input, &self.bounds);
        let classes = match input.radii {
            InputRadii::Uniform(_) => classes::single(input.len()),
            InputRadii::PerParticle(radii) => classes::divide(radii, &self.bulk),
        };
        layout::plan(&classes, &self.bulk, &mut self.layouts);
        self.sort(input);
    }

    /// Neighbours of a particle within `radius`, as the density that it sees lets expect.
    pub(crate) fn expected_neighbors(&self, radius: f32) -> f64 {
        self.bulk.n as f64 * self.bulk.share_within(f64::from(radius))
    }

    /// The particles in the order of slots: by pencil, and along x in each.
    pub(crate) fn order(&self) -> &[u32] {
        &self.slots.particle[..self.slots.len()]
    }

    /// Bytes held, buffers of the build included.
    pub fn bytes(&self) -> usize {
        self.slots.bytes()
            + self.layouts.capacity() * size_of::<Layout>()
            + self.pencils.capacity() * size_of::<Pencil>()
            + 4 * (self.cells.capacity() + self.groups.capacity())
            + self.scratch.bytes()
    }
}

impl Default for Grid {
    fn default() -> Self {
        Self::new()
    }
}

/// The largest magnitude.
fn largest(values: [f32; 3]) -> f32 {
    values.iter().fold(0.0f32, |m, v| m.max(v.abs()))
}

impl Structure for Grid {
    fn slots(&self) -> &Slots {
        &self.slots
    }

    fn n_groups(&self) -> usize {
        self.groups.len().saturating_sub(1)
    }

    fn group(&self, g: usize) -> Range<usize> {
        self.groups[g] as usize..self.groups[g + 1] as usize
    }

    fn runs(&self, group: &GroupBox, vicinity: &mut Vicinity, out: &mut Vec<Run>) {
        self.find_runs_from(group, 0, vicinity, out);
    }
}

#[cfg(test)]
mod tests;
