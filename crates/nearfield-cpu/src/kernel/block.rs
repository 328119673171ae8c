//! One query against one block of [`LANES`] candidates: the predicate and the pair law.

use super::{Query, accumulate::Contribution};
use crate::LANES;
use nearfield_core::{
    interaction::{Coefficients, PairLaw},
    predicate,
};

/// Candidates of a block. Arrays are read whatever the mask says, so they must hold finite numbers.
pub(super) struct Candidates<'a> {
    pub position: [&'a [f32; LANES]; 3],
    /// `None` when radii are uniform.
    pub radius: Option<&'a [f32; LANES]>,
    /// `None` when there is one type.
    pub kind: Option<&'a [u32; LANES]>,
    /// `image * box length`, added to each displacement; a lane each where images differ.
    pub shift: [&'a [f32; LANES]; 3],
    /// Lanes at or beyond this are not part of the run.
    pub valid: u32,
    /// The lane that is the query itself, if below `LANES`.
    pub own: u32,
}

/// Evaluates a block: what its neighbours contribute to the query, and which lanes they are.
#[inline(always)]
pub(super) fn evaluate<L: PairLaw, C: Coefficients, const ENERGY: bool>(
    law: &L,
    coefficients: &C,
    cap: f32,
    query: &Query,
    c: &Candidates,
) -> (Contribution, [bool; LANES]) {
    let mut out = Contribution { force: [[0.0; LANES]; 3], energy: [0.0; LANES], virial: [0.0; LANES] };
    let mut inside = [false; LANES];
    for l in 0..LANES {
        let candidate = [c.position[0][l], c.position[1][l], c.position[2][l]];
        let shift = [c.shift[0][l], c.shift[1][l], c.shift[2][l]];
        let dr = predicate::displacement(query.position, candidate, shift);
        let r2 = predicate::squared_length(dr);
        let range = match c.radius {
            Some(radius) => query.radius.max(radius[l]),
            None => query.radius,
        };
        let kind = match c.kind {
            Some(kind) => kind[l],
            None => 0,
        };
        let lane = l as u32;
        let is_inside = predicate::is_neighbor(r2, range) & (lane < c.valid) & (lane != c.own);
        inside[l] = is_inside;
        let pair = coefficients.get(query.kind, kind, range);
        let f = law.f_over_r(r2, &pair).min(cap);
        let f = if is_inside { f } else { 0.0 };
        for axis in 0..3 {
            out.force[axis][l] = -(f * dr[axis]);
        }
        if ENERGY {
            let u = law.energy(r2, &pair).min(cap);
            out.energy[l] = if is_inside { u } else { 0.0 };
            out.virial[l] = if is_inside { f * r2 } else { 0.0 };
        }
    }
    (out, inside)
}
