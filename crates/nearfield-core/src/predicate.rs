//! The one definition of "neighbour" that every method on every device obeys, bit for bit.
//!
//! A structure may propose any superset of the pairs; this predicate decides. It is antisymmetric in the two
//! particles, so both sides of a pair always agree, and every operation is a correctly rounded f32 one, so a GPU
//! gives the same answer.

/// `(x_j - x_i) + shift`: the displacement from i to the image of j. The shift is added after the subtraction:
/// shifting a position first would round differently.
#[inline(always)]
pub fn displacement(xi: [f32; 3], xj: [f32; 3], shift: [f32; 3]) -> [f32; 3] {
    [(xj[0] - xi[0]) + shift[0], (xj[1] - xi[1]) + shift[1], (xj[2] - xi[2]) + shift[2]]
}

/// Squared length, with the fused operations in the order of the definition.
#[inline(always)]
pub fn squared_length(dr: [f32; 3]) -> f32 {
    dr[0].mul_add(dr[0], dr[1].mul_add(dr[1], dr[2] * dr[2]))
}

/// Whether a pair at squared distance `r2` is within `range`; `range` = max(r_i, r_j).
#[inline(always)]
pub fn is_neighbor(r2: f32, range: f32) -> bool {
    r2 < range * range
}

/// A search radius that is never smaller than `range` after the roundings between a structure's own arithmetic and
/// the predicate's: coordinates up to `extent` in magnitude, one shift and one subtraction each rounded to nearest.
///
/// Boxes and cells use it to stay conservative: |rounded - exact| is at most a few ulp of the coordinate, plus the
/// relative error of the squared distance.
#[inline]
pub fn conservative_range(range: f32, extent: f32) -> f32 {
    range * (1.0 + 8.0 * f32::EPSILON) + 4.0 * f32::EPSILON * extent
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_predicate_is_symmetric_under_exchange() {
        let (a, b, shift) = ([0.1, 9.97, 3.3], [9.9, 0.02, 3.1], [-10.0, 10.0, 0.0]);
        let forward = squared_length(displacement(a, b, shift));
        let backward = squared_length(displacement(b, a, shift.map(|s: f32| -s)));
        assert_eq!(forward.to_bits(), backward.to_bits());
    }

    #[test]
    fn a_pair_at_exactly_the_range_is_excluded() {
        assert!(!is_neighbor(9.0, 3.0));
        assert!(is_neighbor(9.0f32.next_down(), 3.0));
    }
}
