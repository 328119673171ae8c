//! Generated initial conditions: geometry, statistics, reproducibility.

use nearfield::generate::{
    self, Distribution, Error, Generate, Outside, Positions, RadiiSpec, Workload, cluster, disordered, fcc, lattice,
    sphere_surface, sphere_surface_cutoff, temperature, velocities,
};
use nearfield_core::{Boundary, Particles, Radii, SimBox, Vec3s, oracle};
use std::f64::consts::PI;

fn cube(length: f32, boundary: Boundary) -> SimBox {
    SimBox::cubic(length, boundary).unwrap()
}

fn is_inside(positions: &Vec3s, sim_box: &SimBox) -> bool {
    let (lo, hi) = (sim_box.lo(), sim_box.hi());
    positions.iter().all(|p| (0..3).all(|axis| p[axis] >= lo[axis] && p[axis] < hi[axis]))
}

/// Mean and standard deviation.
fn moments(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let values: Vec<f64> = values.collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt())
}

#[test]
fn fcc_melt_has_the_known_box_and_twelve_nearest_neighbours() {
    let melt = Generate { density: Some(0.8442), ..Generate::default() };
    let start = melt.build([Boundary::Periodic; 3], 1.0).unwrap();
    assert_eq!(start.particles.len(), 32_000);
    // Cell edge of LAMMPS' `lattice fcc 0.8442`: (4 / 0.8442)^(1/3), times 20 cells.
    assert!((start.sim_box.lengths()[0] - 33.591_92).abs() < 1e-4);
    assert!(is_inside(&start.particles.position, &start.sim_box));

    let sim_box = cube(6.0, Boundary::Periodic);
    let crystal = Particles::at(fcc(4 * 27, &sim_box).unwrap().iter());
    // Nearest neighbours at edge / sqrt(2) = 1.414, second ones at 2.
    assert_eq!(oracle::pairs(&sim_box, &crystal, &Radii::Uniform(1.6)).len(), 108 * 12 / 2);
    assert_eq!(oracle::pairs(&sim_box, &crystal, &Radii::Uniform(1.4)).len(), 0);
}

#[test]
fn fcc_starts_at_the_lower_corner() {
    let sim_box = SimBox::new([-1.0, 2.0, 5.0], [1.0, 4.0, 7.0], [Boundary::Open; 3]).unwrap();
    let crystal: Vec<_> = fcc(4, &sim_box).unwrap().iter().collect();
    assert_eq!(crystal, [[-1.0, 2.0, 5.0], [0.0, 3.0, 5.0], [0.0, 2.0, 6.0], [-1.0, 3.0, 6.0]]);
}

#[test]
fn fcc_fills_long_boxes_with_cubic_cells() {
    let sim_box = SimBox::new([0.0; 3], [4.0, 2.0, 6.0], [Boundary::Periodic; 3]).unwrap();
    // Cells of edge 2 are 2 x 1 x 3, of edge 1 4 x 2 x 6; nearest neighbours sit at edge / sqrt(2).
    assert_eq!(fcc(4 * 6, &sim_box).unwrap().len(), 24);
    let crystal = Particles::at(fcc(4 * 48, &sim_box).unwrap().iter());
    assert_eq!(oracle::pairs(&sim_box, &crystal, &Radii::Uniform(0.70)).len(), 0);
    assert_eq!(oracle::pairs(&sim_box, &crystal, &Radii::Uniform(0.72)).len(), 192 * 12 / 2);
}

#[test]
fn an_imperfect_crystal_names_the_nearest_perfect_numbers() {
    let error = |n| fcc(n, &cube(10.0, Boundary::Periodic)).unwrap_err();
    assert_eq!(error(32_001), Error::ImperfectCrystal { n: 32_001, below: 32_000, above: 37_044 });
    assert_eq!(error(1), Error::ImperfectCrystal { n: 1, below: 4, above: 32 });
    assert_eq!(
        error(1000).to_string(),
        "n = 1000 does not fill an fcc crystal in this box; the nearest numbers that do are 864 and 1372"
    );
}

#[test]
fn every_perfect_number_of_a_cube_is_accepted() {
    for m in 1..30 {
        assert_eq!(fcc(4 * m * m * m, &cube(7.3, Boundary::Periodic)).unwrap().len(), 4 * m * m * m);
    }
}

#[test]
fn a_lattice_of_any_number_is_evenly_spaced_and_inside() {
    let sim_box = cube(12.0, Boundary::Wall);
    for n in [1, 2, 8, 27, 28, 1000, 1001, 4096] {
        let grid = lattice(n, &sim_box);
        assert_eq!(grid.len(), n);
        assert!(is_inside(&grid, &sim_box));
        let per_axis = (1..).find(|m: &usize| m.pow(3) >= n).unwrap();
        let spacing = 12.0 / per_axis as f32;
        assert_eq!(grid.get(0), [spacing / 2.0; 3]);
        let close = Radii::Uniform(spacing * 0.999);
        assert!(oracle::pairs(&sim_box, &Particles::at(grid.iter()), &close).is_empty(), "n = {n}");
    }
}

#[test]
fn a_lattice_in_a_long_box_has_counts_in_proportion() {
    let sim_box = SimBox::new([0.0; 3], [10.0, 20.0, 40.0], [Boundary::Wall; 3]).unwrap();
    let grid = lattice(8 * 125, &sim_box);
    let last = grid.get(999);
    assert_eq!(last, [9.0, 19.0, 39.0]);
}

#[test]
fn disordered_positions_fill_the_box_evenly() {
    let n = 20_000;
    let sim_box = SimBox::new([-5.0, 0.0, 10.0], [5.0, 1.0, 30.0], [Boundary::Wall; 3]).unwrap();
    let points = disordered(n, &sim_box, 3);
    assert!(is_inside(&points, &sim_box));
    for axis in 0..3 {
        let (lo, length) = (f64::from(sim_box.lo()[axis]), f64::from(sim_box.lengths()[axis]));
        let (mean, deviation) = moments(points.axes()[axis].iter().map(|&x| (f64::from(x) - lo) / length));
        // Five standard errors.
        assert!((mean - 0.5).abs() < 5.0 * (1.0 / 12.0 / n as f64).sqrt(), "mean {mean}");
        assert!((deviation - (1.0f64 / 12.0).sqrt()).abs() < 0.005, "deviation {deviation}");
    }
}

#[test]
fn a_cluster_is_normal_about_its_centre() {
    let n = 20_000;
    let points = cluster(n, &cube(1000.0, Boundary::Open), Some([500.0, 400.0, 300.0]), 25.0, 1).unwrap();
    for (axis, center) in [500.0, 400.0, 300.0].into_iter().enumerate() {
        let (mean, deviation) = moments(points.axes()[axis].iter().map(|&x| f64::from(x)));
        assert!((mean - center).abs() < 5.0 * 25.0 / (n as f64).sqrt(), "mean {mean}");
        assert!((deviation - 25.0).abs() < 5.0 * 25.0 / (2.0 * n as f64).sqrt(), "deviation {deviation}");
    }
}

#[test]
fn a_cluster_at_a_face_is_wrapped_redrawn_or_kept() {
    let at_corner = |boundary| cluster(2000, &cube(100.0, boundary), Some([0.0; 3]), 5.0, 9).unwrap();
    let periodic = at_corner(Boundary::Periodic);
    assert!(is_inside(&periodic, &cube(100.0, Boundary::Periodic)));
    assert!(periodic.x.iter().any(|&x| x > 50.0), "some points wrap to the far side");
    let walls = at_corner(Boundary::Wall);
    assert!(walls.iter().flatten().all(|x| (0.0..50.0).contains(&x)));
    assert!(at_corner(Boundary::Open).x.iter().any(|&x| x < 0.0));
}

#[test]
fn a_cluster_beyond_the_walls_is_an_error() {
    let error = cluster(1, &cube(10.0, Boundary::Wall), Some([1e6; 3]), 1.0, 1).unwrap_err();
    assert_eq!(error, Error::NothingInRange { what: "cluster between walls", low: 0.0, high: 10.0 });
}

#[test]
fn random_cluster_centres_differ_by_seed() {
    let mean = |seed| {
        moments(cluster(500, &cube(1000.0, Boundary::Open), None, 25.0, seed).unwrap().x.iter().map(|&x| f64::from(x)))
            .0
    };
    let means: Vec<f64> = (0..8).map(mean).collect();
    assert!(moments(means.into_iter()).1 > 50.0);
}

#[test]
fn sphere_points_lie_on_the_surface_and_have_the_neighbours_paper_b_asks_for() {
    let sim_box = SimBox::new([-1.0; 3], [1.0; 3], [Boundary::Open; 3]).unwrap();
    let n = 4096;
    let points = sphere_surface(n, &sim_box, 5);
    for p in points.iter() {
        let radius = p.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
        assert!((radius - 1.0).abs() < 1e-6, "radius {radius}");
    }
    for axis in points.axes() {
        // Archimedes: each coordinate is uniform in [-1, 1].
        let (mean, deviation) = moments(axis.iter().map(|&x| f64::from(x)));
        assert!(mean.abs() < 5.0 * (1.0 / 3.0 / n as f64).sqrt() && (deviation - (1.0f64 / 3.0).sqrt()).abs() < 0.03);
    }
    let cutoff = sphere_surface_cutoff(n, 72.0);
    let pairs = oracle::pairs(&sim_box, &Particles::at(points.iter()), &Radii::Uniform(cutoff as f32)).len();
    let mean = 2.0 * pairs as f64 / n as f64;
    // Fraction of the sphere within a chord c: c²/4.
    let expected = (n - 1) as f64 * cutoff.powi(2) / 4.0;
    assert!((mean / expected - 1.0).abs() < 0.02, "{mean} neighbours, expected {expected}");
    assert!((expected / 72.0 - 1.0).abs() < 0.01);
}

#[test]
fn workloads_of_paper_b_have_its_numbers_of_particles_and_neighbours() {
    let mean_neighbours = |workload: &Workload| {
        let start = workload.start.build([Boundary::Open; 3], 1.0).unwrap();
        let pairs = oracle::pairs(&start.sim_box, &start.particles, &Radii::Uniform(workload.cutoff as f32));
        2.0 * pairs.len() as f64 / start.particles.len() as f64
    };
    let uniform = Workload::uniform(8, 8);
    assert_eq!((uniform.start.n, uniform.cutoff), (4096, 0.125));
    // The probability that two uniform points of the unit cube are closer than c <= 1.
    let c = uniform.cutoff;
    let within = c.powi(3) * (4.0 / 3.0 * PI - 1.5 * PI * c + 1.6 * c.powi(2) - c.powi(3) / 6.0);
    let expected = 4095.0 * within;
    assert!((mean_neighbours(&uniform) / expected - 1.0).abs() < 0.02, "expected {expected}");

    let sphere = Workload::sphere_surface(16, 2);
    assert_eq!(sphere.start.n, 8192);
    let mean = mean_neighbours(&sphere);
    assert!((mean / 18.0 - 1.0).abs() < 0.03, "{mean} neighbours on the sphere, 18 expected");
}

/// E[max(r_i, r_j)³] over the pairs of a sample, by sorting.
fn mean_cubed_range(radii: &[f32]) -> f64 {
    let mut sorted: Vec<f64> = radii.iter().map(|&r| f64::from(r)).collect();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    sorted.iter().enumerate().map(|(k, r)| r.powi(3) * 2.0 * k as f64).sum::<f64>() / (n * (n - 1.0))
}

#[test]
fn radius_distributions_of_paper_a_give_the_known_mean_neighbour_counts() {
    // Uniform positions, periodic box of 1000³: (n - 1) 4 pi / 3 E[max(r_i, r_j)³] / V at n = 1M.
    let neighbours = |spec: &RadiiSpec| {
        let mean_cubed = match spec.draw(1_000_000, 11).unwrap() {
            Radii::Uniform(r) => f64::from(r).powi(3),
            Radii::PerParticle(radii) => mean_cubed_range(&radii),
        };
        999_999.0 * 4.0 / 3.0 * PI * mean_cubed / 1e9
    };
    let lognormal = RadiiSpec::default();
    let clamped = RadiiSpec { outside: Outside::Clamp, ..lognormal.clone() };
    let uniform = RadiiSpec { distribution: Distribution::Uniform, range: [1.0, 160.0], ..lognormal.clone() };
    let constant = |value| RadiiSpec { distribution: Distribution::Constant, value, ..RadiiSpec::default() };
    for (spec, expected, tolerance) in [
        (lognormal, 2540.0, 0.02),
        (clamped, 4200.0, 0.02),
        (uniform, 6860.0, 0.005),
        (constant(160.0), 17_160.0, 0.001),
        (constant(1.0), 0.004_19, 0.001),
    ] {
        let found = neighbours(&spec);
        assert!((found / expected - 1.0).abs() < tolerance, "{spec:?}: {found}, expected {expected}");
    }
}

#[test]
fn counted_neighbours_of_a_disordered_start_match_the_expectation() {
    let n = 3000;
    let sim_box = cube(1000.0, Boundary::Periodic);
    let particles = Particles::at(disordered(n, &sim_box, 21).iter());
    let radii = RadiiSpec::default().draw(n, 21).unwrap();
    let Radii::PerParticle(values) = &radii else { panic!("radii are per particle") };
    let expected = (n - 1) as f64 * 4.0 / 3.0 * PI * mean_cubed_range(values) / 1e9;
    let found = 2.0 * oracle::pairs(&sim_box, &particles, &radii).len() as f64 / n as f64;
    assert!((found / expected - 1.0).abs() < 0.05, "{found} neighbours, expected {expected}");
}

#[test]
fn radii_stay_in_range_and_clamping_fills_its_ends() {
    for outside in [Outside::Redraw, Outside::Clamp] {
        let Radii::PerParticle(radii) = (RadiiSpec { outside, ..RadiiSpec::default() }).draw(50_000, 2).unwrap() else {
            panic!("radii are per particle")
        };
        assert!(radii.iter().all(|r| (1.0..=330.0).contains(r)));
        let at_low = radii.iter().filter(|&&r| r == 1.0).count() as f64 / 50_000.0;
        // P(ln r < 0) = Phi(-1/2) = 0.3085 for N(1, 2).
        let expected = if outside == Outside::Clamp { 0.3085 } else { 0.0 };
        assert!((at_low - expected).abs() < 0.01, "{at_low} at the lower end");
    }
}

#[test]
fn a_range_out_of_reach_is_an_error() {
    let far = RadiiSpec { mu: 0.0, sigma: 0.1, range: [100.0, 200.0], ..RadiiSpec::default() };
    assert_eq!(far.draw(5, 1), Err(Error::NothingInRange { what: "radii", low: 100.0, high: 200.0 }));
}

#[test]
fn velocities_have_the_exact_temperature_and_no_momentum() {
    let masses = [1.0, 39.95];
    let kind: Vec<u32> = (0..5000).map(|i| i % 2).collect();
    let velocity = velocities(&kind, &masses, 1.44, 4);
    let found = temperature(&velocity, &kind, &masses);
    assert!((found / 1.44 - 1.0).abs() < 1e-7, "temperature {found}");
    for axis in velocity.axes() {
        let momentum: f64 = axis.iter().zip(&kind).map(|(&v, &k)| masses[k as usize] * f64::from(v)).sum();
        // Each of 5000 velocities is rounded to f32: at most 2^-24 of about 3 sigma, times the mass, added randomly.
        assert!(momentum.abs() < 5000f64.sqrt() * 40.0 * 1e-7, "momentum {momentum}");
    }
    // Equipartition: both types have the same temperature, within five standard errors of 3750 squares each.
    for kind_of in 0..2 {
        let of_kind = |i: &usize| kind[*i] == kind_of;
        let squares = (0..5000).filter(of_kind).flat_map(|i| velocity.get(i)).map(|v| f64::from(v).powi(2));
        let t = masses[kind_of as usize] * moments(squares).0;
        assert!((t / 1.44 - 1.0).abs() < 5.0 * (2.0f64 / 7500.0).sqrt(), "type {kind_of}: {t}");
    }
}

#[test]
fn one_particle_and_zero_temperature_are_at_rest() {
    assert_eq!(velocities(&[0], &[1.0], 1.0, 1), Vec3s::zeros(1));
    assert_eq!(velocities(&[0; 9], &[1.0], 0.0, 1), Vec3s::zeros(9));
    let two = velocities(&[0, 0], &[2.0], 1.5, 1);
    assert!((temperature(&two, &[0, 0], &[2.0]) / 1.5 - 1.0).abs() < 1e-6);
}

fn cluster_spec() -> Generate {
    Generate {
        positions: Positions::Cluster,
        n: 500,
        lengths: Some([1000.0; 3]),
        radii: Some(RadiiSpec::default()),
        ..Generate::default()
    }
}

fn build(spec: &Generate) -> generate::Generated {
    spec.build([Boundary::Wall; 3], 1.0).unwrap()
}

#[test]
fn a_seed_means_the_same_start_everywhere() {
    let start = build(&cluster_spec());
    assert_eq!(start, build(&cluster_spec()));
    let other = build(&Generate { seed: 2, ..cluster_spec() });
    assert_ne!(start.particles.position, other.particles.position);
    assert_ne!(start.particles.velocity, other.particles.velocity);
    assert_ne!(start.radii, other.radii);
    let golden = disordered(2, &cube(1.0, Boundary::Periodic), 1);
    assert_eq!(golden.iter().collect::<Vec<_>>(), GOLDEN_POSITIONS);
    let Some(Radii::PerParticle(radii)) = start.radii else { panic!("radii are per particle") };
    assert_eq!(radii[..3], GOLDEN_RADII);
}

/// Recorded on x86-64 Linux: another platform or version of the generators must agree.
const GOLDEN_POSITIONS: [[f32; 3]; 2] = [[0.17001611, 0.13087913, 0.9616429], [0.6483139, 0.93615043, 0.026661232]];
const GOLDEN_RADII: [f32; 3] = [4.1997075, 5.3776174, 63.977474];

#[test]
fn changing_positions_or_radii_leaves_the_other_streams_alone() {
    let start = build(&cluster_spec());
    let moved = build(&Generate { positions: Positions::Disordered, ..cluster_spec() });
    assert_eq!(start.radii, moved.radii);
    assert_eq!(start.particles.velocity, moved.particles.velocity);
    let clamped = RadiiSpec { outside: Outside::Clamp, ..RadiiSpec::default() };
    let resized = build(&Generate { radii: Some(clamped), ..cluster_spec() });
    assert_ne!(start.radii, resized.radii);
    assert_eq!(start.particles, resized.particles);
}

#[test]
fn a_request_that_makes_no_sense_names_its_key() {
    let valid = || Generate { density: Some(1.0), ..Generate::default() };
    let bad = |spec: Generate| spec.validate().unwrap_err().to_string();
    assert_eq!(bad(Generate { n: 0, ..valid() }), "n = 0: at least one particle is needed");
    assert_eq!(bad(Generate { density: Some(-1.0), ..valid() }), "density = -1: must be positive and finite");
    assert_eq!(bad(Generate { temperature: -0.5, ..valid() }), "temperature = -0.5: must be finite and not negative");
    assert_eq!(bad(Generate { spread: 0.0, ..valid() }), "spread = 0: must be positive and finite");
    let lengths = Some([1.0, 0.0, 1.0]);
    assert_eq!(
        bad(Generate { density: None, lengths, ..valid() }),
        "box = [1.0, 0.0, 1.0]: must be three positive, finite lengths"
    );
    assert_eq!(bad(Generate::default()), "the size of the box is missing: give either density or box = [x, y, z]");
    assert_eq!(
        bad(Generate { lengths: Some([1.0; 3]), ..valid() }),
        "density and box are both given: give either density or box = [x, y, z]"
    );
    let radii = |radii| Generate { radii: Some(radii), ..valid() };
    assert_eq!(
        bad(radii(RadiiSpec { range: [2.0, 1.0], ..RadiiSpec::default() })),
        "radii.range = [2.0, 1.0]: must be two positive numbers, the smaller one first"
    );
}

#[test]
fn names_and_distributions_are_read_from_the_command_line() {
    assert_eq!("sphere-surface".parse(), Ok(Positions::SphereSurface));
    assert_eq!("uniform".parse(), Ok(Positions::Disordered));
    assert_eq!(
        "bcc".parse::<Positions>().unwrap_err().to_string(),
        "unknown positions \"bcc\"; there are fcc, lattice, disordered, uniform, cluster, sphere-surface"
    );
    assert_eq!("constant:160".parse::<RadiiSpec>().unwrap().value, 160.0);
    assert_eq!("uniform:1,160".parse::<RadiiSpec>().unwrap().range, [1.0, 160.0]);
    for bad in ["", "uniform", "uniform:1", "uniform:1,2,clamp", "normal:1,2", "lognormal:1,2,a,3"] {
        assert_eq!(bad.parse::<RadiiSpec>(), Err(Error::UnknownRadii(bad.into())));
    }
}
