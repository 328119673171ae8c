//! The list consumer: each particle sums the forces of the neighbours in its row of a stored list.

use super::{
    Finish, Query,
    accumulate::{Exact, Summing},
    block::{Candidates, evaluate},
    select::with_law,
};
use crate::{Input, InputRadii, LANES, Rows, physics::Physics};
use nearfield_core::{
    NeighborList,
    interaction::{Coefficients, PairLaw},
};
use pulp::{Arch, NullaryFnOnce};
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
            Arch::new().dispatch(Kernel { input, rows, range, physics, law, coefficients, finish });
        });
    });
}

struct Kernel<'a, L, C> {
    input: &'a Input<'a>,
    rows: RowSource<'a>,
    range: Range<usize>,
    physics: &'a Physics,
    law: &'a L,
    coefficients: &'a C,
    finish: Finish<'a>,
}

impl<L: PairLaw, C: Coefficients> NullaryFnOnce for Kernel<'_, L, C> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for k in self.range.clone() {
            let (particle, indices, images) = self.rows.row(k);
            let i = particle as usize;
            let query = Query {
                position: self.input.at(i),
                radius: self.input.radius(i),
                kind: self.input.kind.get(i).copied().unwrap_or(0),
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

impl<L: PairLaw, C: Coefficients> Kernel<'_, L, C> {
    /// Evaluates the first `LANES` entries; lanes past the end repeat the last entry and are masked.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "lanes and axes of several arrays")]
    fn block(&self, query: &Query, i: usize, indices: &[u32], images: &[[i8; 3]], sums: &mut Exact) {
        let mut position = [[0.0; LANES]; 3];
        let (mut radius, mut kind) = ([0.0; LANES], [0; LANES]);
        let mut shift = [[0.0; LANES]; 3];
        let lengths = self.physics.sim_box.lengths();
        for l in 0..LANES {
            let entry = l.min(indices.len() - 1);
            let j = indices[entry] as usize;
            for axis in 0..3 {
                position[axis][l] = self.input.position[axis][j];
            }
            if let InputRadii::PerParticle(radii) = self.input.radii {
                radius[l] = radii[j];
            }
            if !self.input.kind.is_empty() {
                kind[l] = self.input.kind[j];
            }
            if !images.is_empty() {
                let (image, of_i, of_j) = (images[entry], self.rows.crossings(i), self.rows.crossings(j));
                for axis in 0..3 {
                    shift[axis][l] = f32::from(image[axis] + of_j[axis] - of_i[axis]) * lengths[axis];
                }
            }
        }
        let candidates = Candidates {
            x: &position[0],
            y: &position[1],
            z: &position[2],
            radius: &radius,
            kind: &kind,
            shift: &shift,
            valid: indices.len().min(LANES) as u32,
            own: u32::MAX,
        };
        evaluate::<L, C, _, true>(self.law, self.coefficients, self.physics.cap, query, &candidates, sums);
    }
}
