//! Properties of the box and the predicate for random boxes, positions and shifts. proptest prints a failing case and
//! its seed.

use nearfield_core::{Boundary, SimBox, predicate};
use proptest::prelude::*;

/// Finite coordinates of many magnitudes, zero and negative ones included.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![-10.0f32..10.0, -1e6f32..1e6, -1e-3f32..1e-3, Just(0.0f32), Just(-0.0f32)]
}

fn vector() -> impl Strategy<Value = [f32; 3]> {
    [coordinate(), coordinate(), coordinate()]
}

/// A periodic box anywhere, from small to large.
fn periodic_box() -> impl Strategy<Value = SimBox> {
    ([-1e4f32..1e4, -1e4f32..1e4, -1e4f32..1e4], [0.5f32..1e3, 0.5f32..1e3, 0.5f32..1e3]).prop_map(|(lo, length)| {
        let hi = std::array::from_fn(|a| lo[a] + length[a]);
        SimBox::new(lo, hi, [Boundary::Periodic; 3]).unwrap()
    })
}

/// A point inside the box from fractions, faces included.
fn inside(sim_box: &SimBox, fraction: [f32; 3]) -> [f32; 3] {
    let (lo, lengths) = (sim_box.lo(), sim_box.lengths());
    sim_box.wrap(std::array::from_fn(|a| lo[a] + fraction[a] * lengths[a])).0
}

fn fractions() -> impl Strategy<Value = [f32; 3]> {
    let fraction = || prop_oneof![0.0f32..1.0, 0.0f32..0.01, 0.99f32..1.0, Just(0.0f32), Just(0.5f32)];
    [fraction(), fraction(), fraction()]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_displacement_is_antisymmetric_bit_for_bit(a in vector(), b in vector(), shift in vector()) {
        let forward = predicate::displacement(a, b, shift);
        let backward = predicate::displacement(b, a, shift.map(|s| -s));
        for axis in 0..3 {
            // Equal as numbers: only the sign of a zero may differ, and squaring removes it.
            prop_assert_eq!(forward[axis], -backward[axis]);
        }
        let (r2, other) = (predicate::squared_length(forward), predicate::squared_length(backward));
        prop_assert_eq!(r2.to_bits(), other.to_bits());
    }

    #[test]
    fn the_squared_length_is_within_two_roundings_of_the_exact_one(dr in vector()) {
        let exact: f64 = dr.iter().map(|&d| f64::from(d).powi(2)).sum();
        let found = f64::from(predicate::squared_length(dr));
        prop_assert!((found - exact).abs() <= 2.0 * f64::from(f32::EPSILON) * exact + 1e-44, "{} for {}", found, exact);
    }

    #[test]
    fn wrapping_lands_inside_counts_the_crossings_and_is_idempotent(
        sim_box in periodic_box(), position in vector()
    ) {
        let (wrapped, crossings) = sim_box.wrap(position);
        prop_assert_eq!(sim_box.wrap(wrapped), (wrapped, [0; 3]));
        for axis in 0..3 {
            let (lo, hi) = (f64::from(sim_box.lo()[axis]), f64::from(sim_box.hi()[axis]));
            let value = f64::from(wrapped[axis]);
            prop_assert!(lo <= value && value < hi, "{} in [{}, {})", value, lo, hi);
            let unwrapped = value + f64::from(crossings[axis]) * (hi - lo);
            // One rounding to f32 of a value inside the box.
            let tolerance = f64::from(f32::EPSILON) * lo.abs().max(hi.abs());
            let error = (unwrapped - f64::from(position[axis])).abs();
            prop_assert!(error <= tolerance, "axis {}: {} came back as {}", axis, position[axis], unwrapped);
        }
    }

    #[test]
    fn positions_inside_and_axes_that_are_not_periodic_are_left_alone(
        sim_box in periodic_box(), fraction in fractions(), position in vector()
    ) {
        let point = inside(&sim_box, fraction);
        prop_assert_eq!(sim_box.wrap(point), (point, [0; 3]));
        let open = SimBox::new(sim_box.lo(), sim_box.hi(), [Boundary::Open, Boundary::Wall, Boundary::Open]).unwrap();
        prop_assert_eq!(open.wrap(position), (position, [0; 3]));
    }

    #[test]
    fn the_conservative_range_covers_every_neighbour_however_the_distance_is_computed(
        sim_box in periodic_box(), fi in fractions(), fj in fractions(), scale in 0.01f32..0.5
    ) {
        let (xi, xj) = (inside(&sim_box, fi), inside(&sim_box, fj));
        let extent = (0..3).map(|a| sim_box.lo()[a].abs().max(sim_box.hi()[a].abs())).fold(0.0, f32::max);
        for image in sim_box.images() {
            let shift = sim_box.shift(image);
            let dr = predicate::displacement(xi, xj, shift);
            let r2 = predicate::squared_length(dr);
            // A range that just admits this pair is the hardest case; the box sets the other.
            let just = f32::from_bits((r2.sqrt().to_bits() + 2).max(1));
            for range in [just, scale * sim_box.lengths().into_iter().fold(f32::MAX, f32::min)] {
                if !predicate::is_neighbor(r2, range) {
                    continue;
                }
                let wide = predicate::conservative_range(range, extent);
                let ways: [[f32; 3]; 3] = [
                    std::array::from_fn(|a| (xj[a] + shift[a]) - xi[a]),
                    std::array::from_fn(|a| xj[a] - (xi[a] - shift[a])),
                    dr,
                ];
                for way in ways {
                    prop_assert!(way.iter().all(|d| d.abs() <= wide), "{:?} beyond {}", way, wide);
                    prop_assert!(predicate::squared_length(way) <= wide * wide, "{:?} beyond {}", way, wide);
                    prop_assert!(way.iter().map(|d| d * d).sum::<f32>() <= wide * wide, "{:?} beyond {}", way, wide);
                }
                for a in 0..3 {
                    let (image_j, exact) = (xj[a] + shift[a], f64::from(xj[a]) + f64::from(shift[a]));
                    prop_assert!(image_j - wide <= xi[a] && xi[a] <= image_j + wide, "outside the box of j's image");
                    prop_assert!((exact - f64::from(xi[a])).abs() <= f64::from(wide), "beyond {} exactly", wide);
                }
            }
        }
    }

    #[test]
    fn at_most_one_image_of_a_pair_is_in_range_below_half_the_box(
        sim_box in periodic_box(), fi in fractions(), fj in fractions()
    ) {
        let (xi, xj) = (inside(&sim_box, fi), inside(&sim_box, fj));
        let range = 0.499 * sim_box.lengths().into_iter().fold(f32::MAX, f32::min);
        prop_assert!(sim_box.check_range(range, None).is_ok());
        let found = sim_box.images().into_iter().filter(|&image| {
            let dr = predicate::displacement(xi, xj, sim_box.shift(image));
            predicate::is_neighbor(predicate::squared_length(dr), range)
        });
        prop_assert!(found.count() <= 1);
    }
}

#[test]
fn wrapping_does_not_hide_a_position_that_is_not_finite() {
    let sim_box = SimBox::cubic(10.0, Boundary::Periodic).unwrap();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let ([x, y, _], _) = sim_box.wrap([bad, 3.0, 3.0]);
        assert!(!x.is_finite(), "{bad} wrapped to {x}");
        assert_eq!(y, 3.0);
    }
}

#[test]
fn a_range_of_half_a_periodic_length_is_allowed_and_the_next_number_is_not() {
    let sim_box = SimBox::new([0.0; 3], [10.0, 12.0, 1.0], [Boundary::Periodic, Boundary::Periodic, Boundary::Open]);
    let sim_box = sim_box.unwrap();
    assert!(sim_box.check_range(5.0, None).is_ok());
    let error = sim_box.check_range(5.0f32.next_up(), Some(3)).unwrap_err().to_string();
    assert!(error.contains("particle 3") && error.contains("axis x"), "{error}");
}
