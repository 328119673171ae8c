//! Every potential: force against the numerical derivative of its energy, truncation at the cutoff, known values, and
//! f32 against f64.

use nearfield_core::{
    Truncation,
    interaction::{PairCoefficients, PairLaw, Truncated},
    potentials::{Gaussian, LennardJones, Morse, PairPotential, Potential, Table, TableError, Wca, Yukawa},
    with_potential,
};
use std::sync::Arc;

const EPSILONS: [f64; 3] = [0.25, 1.0, 3.5];
const SIGMAS: [f64; 3] = [0.5, 1.0, 1.75];
const TRUNCATIONS: [Truncation; 3] = [Truncation::Cut, Truncation::Energy, Truncation::Force];
/// The cutoff in units of sigma.
const CUTOFF: f64 = 2.5;

/// Rows of (r, U, F) of Lennard-Jones between two distances.
fn lennard_jones_rows(from: f64, to: f64, n: usize) -> Vec<[f64; 3]> {
    (0..n)
        .map(|k| {
            let r = from + (to - from) * k as f64 / (n - 1) as f64;
            [r, LennardJones.energy(r * r, 1.0, 1.0), LennardJones.f_over_r(r * r, 1.0, 1.0) * r]
        })
        .collect()
}

fn every_potential() -> [Potential; 6] {
    [
        Potential::LennardJones(LennardJones),
        Potential::Wca(Wca),
        Potential::Yukawa(Yukawa { kappa: 1.5 }),
        Potential::Morse(Morse { alpha: 2.0 }),
        Potential::Gaussian(Gaussian),
        Potential::Table(Arc::new(Table::new(&lennard_jones_rows(0.7, 2.5, 400)).unwrap())),
    ]
}

/// Calls `check` with each potential's law at each truncation, epsilon and sigma. The law is called as
/// `law(r) -> (U, F)`.
fn for_every_law(check: impl Fn(&str, f64, f64, &dyn Fn(f64) -> (f64, f64))) {
    for potential in every_potential() {
        for truncation in TRUNCATIONS {
            for epsilon in EPSILONS {
                for sigma in SIGMAS {
                    with_potential!(&potential, p => {
                        let c = PairCoefficients::new(p, truncation, epsilon, sigma, CUTOFF * sigma);
                        let law = Truncated::<_, true>(p);
                        let name = format!("{} {truncation:?} epsilon {epsilon} sigma {sigma}", potential.name());
                        check(&name, epsilon, sigma, &|r| (law.energy(r * r, &c), law.f_over_r(r * r, &c) * r));
                    });
                }
            }
        }
    }
}

#[test]
fn the_force_is_the_negative_derivative_of_the_energy() {
    for_every_law(|name, epsilon, sigma, law| {
        for k in 0..400 {
            let r = sigma * (0.75 + (CUTOFF - 0.76) * f64::from(k) / 400.0);
            // The second derivative of WCA jumps where it ends; a difference across that says nothing.
            if name.starts_with("wca") && (r / sigma - 2f64.powf(1.0 / 6.0)).abs() < 1e-4 {
                continue;
            }
            let h = 1e-6 * sigma;
            let numerical = (law(r - h).0 - law(r + h).0) / (2.0 * h);
            let force = law(r).1;
            // Rounding of U over h, and the cubic term; a table's third derivative jumps at its nodes.
            let tolerance = 1e-7 * (force.abs() + 100.0 * epsilon / sigma);
            assert!((force - numerical).abs() < tolerance, "{name} at r = {r}: {force} against {numerical}");
        }
    });
}

#[test]
fn energy_and_force_reach_zero_at_the_cutoff_as_the_truncation_promises() {
    for_every_law(|name, epsilon, sigma, law| {
        let (u, f) = law(CUTOFF * sigma * (1.0 - 1e-12));
        if !name.contains("Cut") {
            assert!(u.abs() < 1e-9 * epsilon, "{name}: U = {u} at the cutoff");
        }
        if name.contains("Force") {
            assert!(f.abs() < 1e-9 * epsilon / sigma, "{name}: F = {f} at the cutoff");
        }
    });
}

#[test]
fn energy_truncation_leaves_the_force_alone() {
    for potential in every_potential() {
        with_potential!(&potential, p => {
            let coefficients = |truncation| PairCoefficients::new(p, truncation, 1.0, 1.0, CUTOFF);
            let (cut, energy) = (coefficients(Truncation::Cut), coefficients(Truncation::Energy));
            let law = Truncated::<_, true>(p);
            for r2 in [0.8, 1.0, 1.5, 4.0, 6.0] {
                assert_eq!(law.f_over_r(r2, &cut), law.f_over_r(r2, &energy), "{}", potential.name());
                assert_eq!(law.f_over_r(r2, &cut), Truncated::<_, false>(p).f_over_r(r2, &cut), "{}", potential.name());
            }
        });
    }
}

#[test]
fn lennard_jones_has_depth_epsilon_at_its_minimum_and_crosses_zero_at_sigma() {
    let (epsilon, sigma) = (1.7, 1.3);
    let r2 = 2f64.powf(1.0 / 3.0) * sigma * sigma;
    assert!((LennardJones.energy(r2, epsilon, sigma) + epsilon).abs() < 1e-14);
    assert!(LennardJones.f_over_r(r2, epsilon, sigma).abs() < 1e-13);
    assert_eq!(LennardJones.energy(sigma * sigma, epsilon, sigma), 0.0);
    // The force at sigma is 24 epsilon / sigma: paper A's eq. (4), which lacks a factor 2, would give zero.
    assert!((LennardJones.f_over_r(sigma * sigma, epsilon, sigma) * sigma - 24.0 * epsilon / sigma).abs() < 1e-13);
}

#[test]
fn wca_is_zero_from_the_minimum_of_lennard_jones_on() {
    let minimum = 2f64.powf(1.0 / 6.0);
    assert!(Wca.energy((minimum * (1.0 - 1e-9)).powi(2), 1.0, 1.0).abs() < 1e-14);
    for r in [minimum * (1.0 + 1e-9), 1.2, 2.0, 1e6] {
        assert_eq!((Wca.energy(r * r, 1.0, 1.0), Wca.f_over_r(r * r, 1.0, 1.0)), (0.0, 0.0), "r = {r}");
    }
    assert_eq!(Wca.energy(1.0, 2.0, 1.0), 2.0);
    assert_eq!(Wca.f_over_r(1.0, 2.0, 1.0), 48.0);
}

#[test]
fn morse_has_depth_epsilon_at_sigma() {
    let morse = Morse { alpha: 2.5 };
    assert_eq!(morse.energy(1.44, 3.0, 1.2), -3.0);
    assert_eq!(morse.f_over_r(1.44, 3.0, 1.2), 0.0);
    assert!(morse.f_over_r(1.0, 3.0, 1.2) > 0.0 && morse.f_over_r(2.0, 3.0, 1.2) < 0.0);
}

#[test]
fn yukawa_and_gaussian_have_their_closed_forms() {
    let yukawa = Yukawa { kappa: 0.5 };
    assert!((yukawa.energy(4.0, 3.0, 1.0) - 1.5 * (-1f64).exp()).abs() < 1e-15);
    assert_eq!(Yukawa { kappa: 0.0 }.energy(4.0, 3.0, 1.0), 1.5);
    assert!((Gaussian.energy(4.0, 3.0, 2.0) - 3.0 * (-0.5f64).exp()).abs() < 1e-15);
    assert_eq!(Gaussian.energy(0.0, 3.0, 2.0), 3.0);
}

#[test]
fn potentials_that_are_finite_at_zero_distance_push_nowhere_there_under_every_truncation() {
    for potential in every_potential().iter().filter(|p| !p.diverges_at_zero()) {
        for truncation in TRUNCATIONS {
            with_potential!(potential, p => {
                let c = PairCoefficients::<f32>::new(p, truncation, 1.0, 1.0, 2.5);
                let law = Truncated::<_, true>(p);
                assert_eq!(law.f_over_r(0.0, &c) * 0.0, 0.0, "{} {truncation:?}", potential.name());
                assert!(law.energy(0.0, &c).is_finite(), "{} {truncation:?}", potential.name());
            });
        }
    }
}

#[test]
fn extreme_distances_overflow_to_infinity_or_vanish_but_never_become_nan() {
    for potential in every_potential() {
        with_potential!(&potential, p => {
            for r2 in [f32::from_bits(1), 1e-38, 1e-20, 1e-10, 1e10, 1e30, f32::MAX] {
                let (f, u) = (p.f_over_r(r2, 1.0, 1.0), p.energy(r2, 1.0, 1.0));
                assert!(!f.is_nan() && !u.is_nan(), "{} at r2 = {r2}: f/r {f}, U {u}", potential.name());
                assert!(r2 < 1.0 || (f.abs() < 1e-9 && u.abs() < 1e-9), "{} at r2 = {r2}: {f}, {u}", potential.name());
            }
        });
    }
}

#[test]
fn f32_agrees_with_f64_within_sixty_four_roundings() {
    for potential in every_potential() {
        with_potential!(&potential, p => {
            for k in 0..1000u16 {
                let r2 = 0.64 + 5.6 * f32::from(k) / 1000.0;
                let (epsilon, sigma) = (1.5f32, 1.0f32);
                let wide = f64::from(r2);
                let (f, u) = (p.f_over_r(r2, epsilon, sigma), p.energy(r2, epsilon, sigma));
                let exact = (p.f_over_r(wide, 1.5, 1.0), p.energy(wide, 1.5, 1.0));
                // Terms of opposite sign cancel, so the error scales with the terms: for all potentials here they are
                // below the magnitude of Lennard-Jones' repulsive and attractive parts plus epsilon.
                let s6 = wide.powi(-3);
                let scale = 1.5 * (48.0 * s6 * (s6 + 0.5) + 10.0);
                let tolerance = 64.0 * f64::from(f32::EPSILON) * scale;
                let name = potential.name();
                assert!((f64::from(f) - exact.0).abs() < tolerance, "{name} at r2 = {r2}: f/r {f} for {}", exact.0);
                assert!((f64::from(u) - exact.1).abs() < tolerance, "{name} at r2 = {r2}: U {u} for {}", exact.1);
            }
        });
    }
}

#[test]
fn a_table_of_lennard_jones_reproduces_it_within_the_interpolation_error() {
    let table = Table::new(&lennard_jones_rows(0.8, 2.5, 1000)).unwrap();
    for k in 0..5000 {
        let r = 0.8 + 1.7 * (f64::from(k) + 0.5) / 5000.0;
        let r2 = r * r;
        // Hermite: |error| <= h^4 / 384 max |U''''|; U'''' of r^-12 is 4 * 12 * 13 * 14 * 15 r^-16. Two passes.
        let h: f64 = 1.7 / 999.0;
        let bound = 2.0 * h.powi(4) / 384.0 * 131_040.0 * (r - h).powi(-16);
        let (u, exact) = (table.energy(r2, 1.0, 1.0), LennardJones.energy(r2, 1.0, 1.0));
        assert!((u - exact).abs() <= bound + 1e-12, "r = {r}: {u} for {exact}");
        let (f, exact) = (table.f_over_r(r2, 1.0, 1.0), LennardJones.f_over_r(r2, 1.0, 1.0));
        assert!((f - exact).abs() <= 20.0 * bound / h + 1e-12, "r = {r}: {f} for {exact}");
    }
}

#[test]
fn a_table_continues_its_first_force_below_and_is_zero_beyond_its_end() {
    let table = Table::new(&[[1.0, 5.0, 2.0], [2.0, 3.0, 2.0], [3.0, 1.0, 2.0]]).unwrap();
    assert_eq!(table.end(), 3.0);
    assert!((table.energy(0.25f64, 1.0, 1.0) - 6.0).abs() < 1e-12);
    assert!((table.f_over_r(0.25f64, 1.0, 1.0) * 0.5 - 2.0).abs() < 1e-12);
    // A straight line is reproduced everywhere, in units of epsilon and sigma.
    assert!((table.energy(25f64, 10.0, 2.0) - 20.0).abs() < 1e-10);
    assert!((table.f_over_r(25f64, 10.0, 2.0) * 5.0 - 10.0).abs() < 1e-10);
    assert_eq!((table.energy(9.01f64, 1.0, 1.0), table.f_over_r(9.01f64, 1.0, 1.0)), (0.0, 0.0));
}

#[test]
fn a_table_cut_at_its_end_takes_its_shifts_from_the_last_row() {
    let table = Table::new(&[[1.0, 5.0, 2.0], [3.0, 1.0, 2.0]]).unwrap();
    let c = PairCoefficients::<f64>::new(&table, Truncation::Force, 1.0, 1.0, 3.0);
    assert!((c.energy_shift - 1.0).abs() < 1e-12 && (c.force_shift - 2.0).abs() < 1e-12, "{c:?}");
}

#[test]
fn bad_tables_are_refused_naming_the_row() {
    let row = |r: f64| [r, 0.0, 0.0];
    assert_eq!(Table::new(&[]), Err(TableError::TooShort(0)));
    assert_eq!(Table::new(&[row(1.0)]), Err(TableError::TooShort(1)));
    assert_eq!(Table::new(&[row(1.0), row(2.0), row(2.0)]), Err(TableError::NotAscending { row: 3, r: 2.0 }));
    assert_eq!(Table::new(&[row(1.0), row(0.5)]), Err(TableError::NotAscending { row: 2, r: 0.5 }));
    assert_eq!(Table::new(&[row(-1.0), row(0.5)]), Err(TableError::NotAscending { row: 1, r: -1.0 }));
    for bad in [f64::NAN, f64::INFINITY] {
        for column in 0..3 {
            let mut rows = [row(1.0), row(2.0), row(3.0)];
            rows[1][column] = bad;
            let error = Table::new(&rows).unwrap_err();
            assert_eq!(error, TableError::NotFinite { row: 2 });
            assert!(error.to_string().contains("row 2"), "{error}");
        }
    }
}
