//! Width of pencils: how many candidates a warp meets depends on how it compares to the range.

/// Particles to a cube of the width of a pencil, among which the best is chosen. Finer pencils give long clusters and
/// many rows, coarser ones many candidates in vain.
const OCCUPANCIES: [f64; 8] = [4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0, 16.0];

/// That of ranges much longer than pencils are wide, where they hardly differ.
const LONG_RANGE_OCCUPANCY: f64 = 8.0;

/// What is a long range, in pencils.
const LONG_RANGE: f64 = 6.0;

/// Extent of the particles of a cluster over the width of their pencil.
const EXTENT: f64 = 0.9;

/// What finding 32 rows costs, in candidates.
const ROWS_COST: f64 = 32.0;

/// Width for `n` particles, counted by the density they see, in a region of these lengths; huge where any will do.
pub(super) fn pencil_width(n: f64, lengths: [f64; 3], range: f64) -> f64 {
    let typical = width_of(n / LONG_RANGE_OCCUPANCY, lengths);
    if range > LONG_RANGE * typical {
        return typical;
    }
    let density = LONG_RANGE_OCCUPANCY / typical.powi(3);
    let cost = |&occupancy: &f64| candidates(density, (occupancy / density).cbrt(), range);
    let best = OCCUPANCIES.iter().min_by(|a, b| cost(a).total_cmp(&cost(b))).expect("there are some");
    width_of(n / best, lengths)
}

/// Width of cubes that hold about one of `n` particles, with some room for rounding.
pub(super) fn cube_width(n: f64, lengths: [f64; 3]) -> f64 {
    width_of(n, lengths) * (1.0 - 1e-9)
}

/// Candidates of 8 consecutive particles at this density in pencils of this width, and the cost of the rows.
fn candidates(density: f64, width: f64, range: f64) -> f64 {
    let length = 8.0 / (density * width * width);
    let reach = (range / width).ceil() as i32 + 1;
    let gap = |k: i32| if k == 0 { 0.0 } else { (f64::from(k.abs()) - 0.5 - 0.5 * EXTENT) * width };
    let (mut volume, mut rows) = (0.0, 0.0);
    for y in -reach..=reach {
        for z in -reach..=reach {
            let rest = range * range - gap(y).powi(2) - gap(z).powi(2);
            if rest > 0.0 {
                // A quarter of the width is what cells along x are too long by.
                volume += width * width * (length + 2.0 * rest.sqrt() + 0.25 * width);
                rows += 1.0;
            }
        }
    }
    density * volume + ROWS_COST * rows / 32.0
}

/// The width w for which a box of these lengths holds `cubes` cubes of w; axes shorter than w count as w.
fn width_of(cubes: f64, lengths: [f64; 3]) -> f64 {
    let mut sorted = lengths;
    sorted.sort_unstable_by(f64::total_cmp);
    let [a, b, c] = sorted;
    let (by_volume, by_area, by_length) = ((a * b * c / cubes).cbrt(), (b * c / cubes).sqrt(), c / cubes);
    let width = if by_volume < a {
        by_volume
    } else if by_area < b {
        by_area
    } else {
        by_length
    };
    if width > 0.0 && width.is_finite() { width } else { f64::MAX }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn occupancy(n: f64, length: f64, range: f64) -> f64 {
        n * (pencil_width(n, [length; 3], range) / length).powi(3)
    }

    #[test]
    fn long_ranges_have_pencils_of_eight_to_a_cube() {
        assert!((occupancy(1e6, 1000.0, 160.0) - 8.0).abs() < 1e-9);
    }

    /// Counted in a liquid at r = 2.5: 11.0 chunks of 32 at 12 to a cube, 13.8 at 8; at 33 neighbours: 7.5 at 7,
    /// 9.9 at 4 and at 12.
    #[test]
    fn short_ranges_have_pencils_just_wider_than_the_range() {
        assert!((occupancy(64_000.0, 42.3, 2.5) - 12.0).abs() < 1e-9);
        assert!((occupancy(64_000.0, 1000.0, 49.2) - 7.0).abs() < 1e-9);
    }

    #[test]
    fn any_width_will_do_where_there_is_no_extent() {
        assert_eq!(pencil_width(1e6, [0.0; 3], 1.0), f64::MAX);
        assert_eq!(pencil_width(0.0, [1.0; 3], 1.0), f64::MAX);
    }
}
