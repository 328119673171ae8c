//! One query against one block of [`LANES`] candidates: the predicate and the pair law.
//!
//! The loop over lanes is one flat loop, without closures or inner loops, and sums within it: anything else keeps the
//! compiler from turning it into vector instructions, which costs a factor of ten.

use super::{Query, accumulate::Accumulator, select::Law};
use crate::LANES;
use nearfield_core::{interaction::Coefficients, predicate};

/// Lanes of one quantity.
pub(super) type Lanes<T> = [T; LANES];

/// Candidates of a block; padding lanes are at [`crate::Slots::FAR`]. Arrays are read whatever the predicate says, so
/// they must hold finite numbers.
pub(super) struct Block<'a> {
    pub x: &'a Lanes<f32>,
    pub y: &'a Lanes<f32>,
    pub z: &'a Lanes<f32>,
    /// Anything when radii are uniform.
    pub radius: &'a Lanes<f32>,
    /// Anything when there is one type.
    pub kind: &'a Lanes<u32>,
    pub particle: &'a Lanes<u32>,
    /// `image * box length`, added to each displacement; a lane each where images differ.
    pub shift: &'a [Lanes<f32>; 3],
}

/// Adds what the block's neighbours contribute to the query. Without `SHIFTED`, shifts are zero and not read.
#[inline(always)]
#[expect(clippy::needless_range_loop, reason = "flat loops over lanes, see above")]
pub(super) fn evaluate<L: Law, C: Coefficients, A: Accumulator, const ENERGY: bool, const SHIFTED: bool>(
    law: &L,
    coefficients: C,
    cap: f32,
    query: &Query,
    c: &Block,
    sums: &mut A,
) {
    if L::VECTORISES {
        for l in 0..LANES {
            let pair = test::<C, SHIFTED>(query, c, l);
            add_pair::<L, C, A, ENERGY>(law, coefficients, cap, query, c, l, pair, sums);
        }
    } else {
        let mut pairs = [Tested::default(); LANES];
        for l in 0..LANES {
            pairs[l] = test::<C, SHIFTED>(query, c, l);
        }
        for l in 0..LANES {
            if pairs[l].inside {
                add_pair::<L, C, A, ENERGY>(law, coefficients, cap, query, c, l, pairs[l], sums);
            }
        }
    }
}

/// A candidate after the predicate.
#[derive(Clone, Copy, Default)]
struct Tested {
    dr: [f32; 3],
    r2: f32,
    range: f32,
    inside: bool,
}

#[inline(always)]
fn test<C: Coefficients, const SHIFTED: bool>(query: &Query, c: &Block, l: usize) -> Tested {
    let shift = if SHIFTED { [c.shift[0][l], c.shift[1][l], c.shift[2][l]] } else { [0.0; 3] };
    let dr = predicate::displacement(query.position, [c.x[l], c.y[l], c.z[l]], shift);
    let r2 = predicate::squared_length(dr);
    let range = if C::VARIABLE_RANGE { query.radius.max(c.radius[l]) } else { query.radius };
    let inside = predicate::is_neighbor(r2, range) & (c.particle[l] != query.particle);
    Tested { dr, r2, range, inside }
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "an inlined piece of the loop, not an interface")]
fn add_pair<L: Law, C: Coefficients, A: Accumulator, const ENERGY: bool>(
    law: &L,
    coefficients: C,
    cap: f32,
    query: &Query,
    c: &Block,
    l: usize,
    pair: Tested,
    sums: &mut A,
) {
    let Tested { dr, r2, range, inside } = pair;
    let kind = if C::TYPED { c.kind[l] } else { 0 };
    let of_pair = coefficients.get(query.kind, kind, range);
    let f = law.f_over_r(r2, &of_pair);
    // Not `min`, which costs three instructions for NaN: that becomes the cap here, and NaN again times dr = 0.
    let f = if f < cap { f } else { cap };
    let f = if inside { f } else { 0.0 };
    sums.add_force(l, -(f * dr[0]), -(f * dr[1]), -(f * dr[2]));
    if ENERGY {
        let u = law.energy(r2, &of_pair);
        let u = if u < cap { u } else { cap };
        let u = if inside { u } else { 0.0 };
        // Padding is infinitely far: zero times its squared distance would not be zero.
        let w = if inside { f * r2 } else { 0.0 };
        sums.add_energy(l, u, w, u32::from(inside));
    }
}
