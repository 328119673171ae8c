//! The list consumer: each particle sums the forces of the neighbours in its row of a stored list.

use super::{
    Finish, Query,
    accumulate::{Exact, Summing},
    block::Block,
    evaluate,
    select::{Law, with_law},
};
use crate::{
    Input, InputRadii, LANES, Rows, Slots,
    lanes::{self, Isa},
    physics::Physics,
};
use nearfield_core::{NeighborList, interaction::Coefficients};
use rayon::prelude::*;
use std::ops::Range;

/// Where rows of candidates come from: entries may have left the range since they were listed.
#[derive(Clone, Copy)]
pub(crate) enum RowSource<'a> {
    /// A stored full list, row k for particle k, and the box crossings of each particle since it was built.
    List { list: &'a NeighborList, crossings: &'a [[i8; 3]] },
    /// Rows of full lists that were made for this moment.
    Batch(&'a Rows),
}

impl<'a> RowSource<'a> {
    fn len(self) -> usize {
        match self {
            Self::List { list, .. } => list.n_particles(),
            Self::Batch(rows) => rows.len(),
        }
    }

    /// Particle, candidates and their images (empty when nothing is periodic) of row `k`.
    #[inline(always)]
    fn row(self, k: usize) -> (u32, &'a [u32], &'a [[i8; 3]]) {
        match self {
            Self::List { list, .. } => {
                let images = list.shifts.as_ref().map_or([].as_slice(), |shifts| &shifts[list.row_range(k)]);
                (k as u32, list.row(k), images)
            }
            Self::Batch(rows) => {
                let row = rows.at(k);
                (row.particle, row.neighbors, row.images)
            }
        }
    }

    /// Box crossings of particle `i` since the row was listed.
    #[inline(always)]
    fn crossings(self, i: usize) -> [i8; 3] {
        match self {
            Self::List { crossings, .. } => crossings[i],
            Self::Batch(_) => [0; 3],
        }
    }
}

/// Rows one task handles.
const ROWS_PER_TASK: usize = 512;

/// Gathers forces and energies of the particles from their rows. Sums do not depend on order.
pub(crate) fn gather_rows(physics: &Physics, input: &Input, rows: RowSource, finish: Finish) {
    let n_rows = rows.len();
    with_law!(physics, law, coefficients => {
        (0..n_rows.div_ceil(ROWS_PER_TASK)).into_par_iter().for_each(|c| {
            let range = c * ROWS_PER_TASK..((c + 1) * ROWS_PER_TASK).min(n_rows);
            Isa::detect().run(Kernel { input, rows, range, physics, law, coefficients, finish });
        });
    });
}

struct Kernel<'a, L, C> {
    input: &'a Input<'a>,
    rows: RowSource<'a>,
    range: Range<usize>,
    physics: &'a Physics,
    law: &'a L,
    coefficients: C,
    finish: Finish<'a>,
}

impl<L: Law, C: Coefficients> lanes::Kernel for Kernel<'_, L, C> {
    type Output = ();

    #[inline(always)]
    fn run<S: lanes::Lanes>(self, _: S) {
        for k in self.range.clone() {
            let (particle, indices, images) = self.rows.row(k);
            let i = particle as usize;
            let query = Query {
                position: self.input.at(i),
                radius: self.input.radius(i),
                kind: self.input.kind.get(i).copied().unwrap_or(0),
                particle,
            };
            let mut sums = Exact::new(self.physics.grain);
            for start in (0..indices.len()).step_by(LANES) {
                let rest = if images.is_empty() { images } else { &images[start..] };
                self.block(&query, i, &indices[start..], rest, &mut sums);
            }
            (self.finish)(particle, &sums.finish());
        }
    }
}

impl<L: Law, C: Coefficients> Kernel<'_, L, C> {
    /// Evaluates the first `LANES` entries; lanes past the end are padding.
    #[inline(always)]
    fn block(&self, query: &Query, i: usize, indices: &[u32], images: &[[i8; 3]], sums: &mut Exact) {
        let (mut x, mut y, mut z) = ([Slots::FAR; LANES], [0.0; LANES], [0.0; LANES]);
        let (mut radius, mut kind, mut particle) = ([0.0; LANES], [0; LANES], [u32::MAX; LANES]);
        let mut shift = [[0.0; LANES]; 3];
        let lengths = self.physics.sim_box.lengths();
        for l in 0..indices.len().min(LANES) {
            let j = indices[l] as usize;
            [x[l], y[l], z[l]] = self.input.at(j);
            particle[l] = indices[l];
            if let InputRadii::PerParticle(radii) = self.input.radii {
                radius[l] = radii[j];
            }
            if !self.input.kind.is_empty() {
                kind[l] = self.input.kind[j];
            }
            if !images.is_empty() {
                let (image, of_i, of_j) = (images[l], self.rows.crossings(i), self.rows.crossings(j));
                for axis in 0..3 {
                    shift[axis][l] = f32::from(image[axis] + of_j[axis] - of_i[axis]) * lengths[axis];
                }
            }
        }
        let (law, coefficients, cap) = (self.law, self.coefficients, self.physics.cap);
        let block = Block { x: &x, y: &y, z: &z, radius: &radius, kind: &kind, particle: &particle, shift: &shift };
        evaluate::<L, C, _, true, true>(law, coefficients, cap, query, &block, sums);
    }
}
