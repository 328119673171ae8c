//! The list consumer: each particle sums the forces of the neighbours in its row of a stored list.

use super::{
    Finish, Query,
    accumulate::{Accumulator, Exact},
    block::{Candidates, evaluate},
    select::with_law,
};
use crate::{Input, InputRadii, LANES, physics::Physics};
use nearfield_core::interaction::{Coefficients, PairLaw};
use pulp::{Arch, NullaryFnOnce};
use rayon::prelude::*;
use std::ops::Range;

/// Rows of candidates for some particles: entries may have left the range since the list was built.
#[derive(Clone, Copy)]
pub(crate) struct Rows<'a> {
    /// The particle of each row; `None` when row k is that of particle k.
    pub particles: Option<&'a [u32]>,
    /// Row starts.
    pub offsets: &'a [u64],
    /// Candidates.
    pub indices: &'a [u32],
    /// Their images when the list was built; empty when nothing is periodic.
    pub images: &'a [[i8; 3]],
    /// Box crossings of each particle since the list was built; empty when nothing is periodic.
    pub crossings: &'a [[i8; 3]],
}

/// Rows one task handles.
const ROWS_PER_TASK: usize = 512;

/// Gathers forces and energies of the particles from their rows. Sums do not depend on order.
pub(crate) fn gather_rows(physics: &Physics, input: &Input, rows: Rows, finish: Finish) {
    let n_rows = rows.offsets.len().saturating_sub(1);
    with_law!(physics, law, coefficients => {
        (0..n_rows.div_ceil(ROWS_PER_TASK)).into_par_iter().for_each(|c| {
            let range = c * ROWS_PER_TASK..((c + 1) * ROWS_PER_TASK).min(n_rows);
            Arch::new().dispatch(Kernel { input, rows, range, physics, law, coefficients, finish });
        });
    });
}

struct Kernel<'a, L, C> {
    input: &'a Input<'a>,
    rows: Rows<'a>,
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
        for row in self.range.clone() {
            let particle = self.rows.particles.map_or(row as u32, |particles| particles[row]);
            let i = particle as usize;
            let query = Query {
                position: self.input.at(i),
                radius: self.input.radius(i),
                kind: self.input.kind.get(i).copied().unwrap_or(0),
            };
            let mut sums = Exact::new(self.physics.grain);
            let mut neighbors = 0;
            let entries = self.rows.offsets[row] as usize..self.rows.offsets[row + 1] as usize;
            for start in entries.clone().step_by(LANES) {
                neighbors += self.block(&query, i, start..entries.end, &mut sums);
            }
            (self.finish)(particle, &sums.finish(neighbors));
        }
    }
}

impl<L: PairLaw, C: Coefficients> Kernel<'_, L, C> {
    /// Evaluates up to `LANES` entries; lanes past the end repeat the last entry and are masked.
    #[inline(always)]
    fn block(&self, query: &Query, i: usize, entries: Range<usize>, sums: &mut Exact) -> u32 {
        let last = entries.end - 1;
        let mut position = [[0.0; LANES]; 3];
        let (mut radius, mut kind) = ([0.0; LANES], [0; LANES]);
        let mut shift = [[0.0; LANES]; 3];
        let lengths = self.physics.sim_box.lengths();
        for l in 0..LANES {
            let entry = (entries.start + l).min(last);
            let j = self.rows.indices[entry] as usize;
            for axis in 0..3 {
                position[axis][l] = self.input.position[axis][j];
            }
            if let InputRadii::PerParticle(radii) = self.input.radii {
                radius[l] = radii[j];
            }
            if !self.input.kind.is_empty() {
                kind[l] = self.input.kind[j];
            }
            if !self.rows.images.is_empty() {
                let (image, of_i, of_j) = (self.rows.images[entry], self.rows.crossings[i], self.rows.crossings[j]);
                for axis in 0..3 {
                    shift[axis][l] = f32::from(image[axis] + of_j[axis] - of_i[axis]) * lengths[axis];
                }
            }
        }
        let candidates = Candidates {
            position: [&position[0], &position[1], &position[2]],
            radius: matches!(self.input.radii, InputRadii::PerParticle(_)).then_some(&radius),
            kind: (!self.input.kind.is_empty()).then_some(&kind),
            shift: [&shift[0], &shift[1], &shift[2]],
            valid: (entries.end - entries.start) as u32,
            own: u32::MAX,
        };
        let (contribution, inside) =
            evaluate::<L, C, true>(self.law, self.coefficients, self.physics.cap, query, &candidates);
        sums.add::<true>(&contribution);
        inside.iter().map(|&b| u32::from(b)).sum()
    }
}
