//! What observers measure, where the answer is known.

use crate::build;
use nearfield::{
    Boundary, Dynamics, Interaction, Method, Particles, Radii, SimBox, Simulation, System,
    observe::{MeanSquaredDisplacement, Observer, RadialDistribution, ThermoTable},
    potentials::{Gaussian, Potential},
};
use std::{fs, ops::ControlFlow, path::Path};

/// Uniformly random points that do not feel each other.
fn ideal_gas(n: usize, length: f32) -> System {
    let sim_box = SimBox::cubic(length, Boundary::Periodic).unwrap();
    let mut seed = 2u64;
    let mut random = || {
        // Multiplier of Knuth's MMIX; the high bits are good.
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f32 / (1u32 << 24) as f32
    };
    let mut particles = Particles::at((0..n).map(|_| std::array::from_fn(|_| length * random())).collect::<Vec<_>>());
    for i in 0..n {
        particles.velocity.set(i, std::array::from_fn(|_| 4.0 * random() - 2.0));
    }
    let mut interaction = Interaction { potential: Potential::Gaussian(Gaussian), ..Interaction::lennard_jones() };
    interaction.types[0].epsilon = 0.0;
    System { sim_box, particles, radii: Radii::Uniform(2.0), interaction }
}

fn run(simulation: &mut Simulation, steps: u64, observer: impl Observer + 'static) {
    simulation.run(steps, &mut [Box::new(observer)], &mut |_| ControlFlow::Continue(())).unwrap();
}

fn rows(path: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(path).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect()
}

#[test]
fn an_ideal_gas_has_no_structure() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rdf.csv");
    let mut simulation = build(Simulation::builder(ideal_gas(8000, 20.0)).method(Method::Cell));
    run(&mut simulation, 3, RadialDistribution::new(&path, 1, 20));
    let rows = rows(&path);
    assert_eq!(rows.len(), 20);
    for (bin, row) in rows.iter().enumerate() {
        let (r, g) = (row[0], row[1]);
        assert!((r - 0.1 * (bin as f64 + 0.5)).abs() < 1e-6);
        // Four correlated samples count as one: pairs in a shell of one sample.
        let pairs = 8000.0 * 4.0 * std::f64::consts::PI * r * r * 0.1 / 2.0;
        assert!((g - 1.0).abs() < 5.0 / pairs.sqrt(), "g({r}) = {g} with {pairs} pairs");
    }
}

#[test]
fn free_particles_move_by_velocity_times_time_across_faces() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("msd.csv");
    let system = ideal_gas(300, 5.0);
    let mean_square = |axis: usize| -> f64 {
        system.particles.velocity.axes()[axis].iter().map(|&v| f64::from(v).powi(2)).sum::<f64>() / 300.0
    };
    let expected: Vec<f64> = (0..3).map(mean_square).collect();
    let mut simulation = build(Simulation::builder(system).method(Method::Cell).dynamics(Dynamics::nve(0.03125)));
    run(&mut simulation, 640, MeanSquaredDisplacement::new(&path, 64));
    let rows = rows(&path);
    assert_eq!(rows.len(), 11);
    for row in &rows {
        let [step, time, msd] = [row[0], row[1], row[2]];
        assert_eq!(time, 0.03125 * step);
        for axis in 0..3 {
            let ballistic = expected[axis] * time * time;
            // Positions round to 2.4e-7 at each step.
            assert!((row[3 + axis] - ballistic).abs() <= 1e-4 * ballistic, "axis {axis} at {time}: {}", row[3 + axis]);
        }
        assert!((msd - row[3] - row[4] - row[5]).abs() <= 1e-12 * msd);
    }
    assert!(rows[10][2] > 100.0, "twenty time units cross the box of 5 many times");
}

#[test]
fn the_thermo_table_is_what_thermo_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("thermo.csv");
    let mut simulation = build(Simulation::builder(crate::smooth(108, 0.5, 1.0)).method(Method::Cell));
    let start = simulation.thermo().unwrap();
    run(&mut simulation, 25, ThermoTable::new(&path, 10));
    let rows = rows(&path);
    assert_eq!(rows.iter().map(|row| row[0]).collect::<Vec<_>>(), [0.0, 10.0, 20.0], "the last step is no multiple");
    let expected = [
        0.0,
        0.0,
        start.temperature,
        start.kinetic_energy,
        start.potential_energy,
        start.total_energy,
        start.pressure,
        start.virial,
        start.pairs as f64,
        start.max_force,
    ];
    assert_eq!(rows[0], expected);
    assert_eq!(simulation.step(), 25);
}

#[test]
fn an_observer_that_cannot_write_stops_the_run_naming_its_file() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    let path = folder.path().join("file/thermo.csv");
    let mut simulation = build(Simulation::builder(crate::smooth(108, 0.5, 1.0)).method(Method::Cell));
    let mut observers: [Box<dyn Observer>; 1] = [Box::new(ThermoTable::new(&path, 10))];
    let error = simulation.run(25, &mut observers, &mut |_| ControlFlow::Continue(())).unwrap_err();
    assert!(error.to_string().contains("file/thermo.csv"), "{error}");
}
