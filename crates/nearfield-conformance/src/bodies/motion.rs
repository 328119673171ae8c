//! Trajectories at constant energy.

use crate::{Factory, OracleEngine, cases, plans};
use nearfield_core::{
    Boundary, Dynamics, Engine, Ensemble, Images, Interaction, Maintenance, Method, ParticleType, Particles, Plan,
    Quantities, Radii, Skin, System, Truncation,
    potentials::{Potential, Wca},
};
use rand::RngExt;

fn snapshot(engine: &mut dyn Engine) -> Particles {
    let mut particles = Particles::default();
    engine.snapshot(&mut particles).expect("a copy");
    particles
}

/// Loads, runs from step 0 and gives the end.
fn run(engine: &mut dyn Engine, system: &System, plan: &Plan, dynamics: &Dynamics, steps: u64) -> Particles {
    engine.load(system, plan).unwrap_or_else(|error| panic!("{plan:?}: {error}"));
    engine.advance(dynamics, 0, steps, Quantities::FORCES).unwrap_or_else(|error| panic!("{plan:?}: {error}"));
    snapshot(engine)
}

/// The unwrapped coordinate of particle `i`.
fn unwrapped(system: &System, particles: &Particles, i: usize, axis: usize) -> f64 {
    let length = f64::from(system.sim_box.lengths()[axis]);
    f64::from(particles.position.get(i)[axis]) + f64::from(particles.image[i][axis]) * length
}

/// The largest distance between corresponding unwrapped coordinates.
fn apart(system: &System, a: &Particles, b: &Particles) -> f64 {
    let n = system.particles.len();
    assert_eq!((a.len(), b.len()), (n, n));
    (0..n)
        .flat_map(|i| (0..3).map(move |axis| (i, axis)))
        .map(|(i, axis)| (unwrapped(system, a, i, axis) - unwrapped(system, b, i, axis)).abs())
        .fold(0.0, f64::max)
}

/// Three types of different mass.
fn give_masses(system: &mut System) {
    system.interaction.types = [1.0, 0.5, 4.0]
        .iter()
        .enumerate()
        .map(|(k, &mass)| ParticleType { name: k.to_string(), mass, ..ParticleType::default() })
        .collect();
    for (i, kind) in system.particles.kind.iter_mut().enumerate() {
        *kind = (i * 7 % 3) as u32;
    }
}

/// Against the oracle engine: roundings of 1e-7 grow by less than a thousand in forty steps of a liquid.
pub fn every_plan_follows_the_same_trajectory(factory: Factory) {
    let mut system = cases::liquid(3, 1.0, 0.05, 2.5, 1);
    give_masses(&mut system);
    let dynamics = Dynamics::nve(0.004);
    let expected = run(&mut OracleEngine::new(), &system, &Plan::new(Method::Brute), &dynamics, 40);
    plans::run(&mut *factory(), &system, &plans::every(), |engine, plan| {
        let found = run(engine, &system, plan, &dynamics, 40);
        let apart = apart(&system, &found, &expected);
        assert!(apart < 1e-4, "{plan:?}: {apart} from the oracle's trajectory");
        assert_eq!(found.kind, expected.kind, "{plan:?}");
    });
}

/// Bit for bit: what is rebuilt when, and how long a list serves, are matters of speed.
pub fn maintenance_and_skin_do_not_change_a_deterministic_trajectory(factory: Factory) {
    let system = cases::liquid(3, 2.0, 0.1, 2.2, 2);
    let maintenance = [
        Maintenance::Every,
        Maintenance::Fixed(5),
        Maintenance::Average,
        Maintenance::Gradient,
        Maintenance::Displacement,
    ];
    let mut plans = vec![Plan::new(Method::Brute), Plan::new(Method::Cell)];
    for plan in plans::each_structure().into_iter().filter(|plan| plan.method.uses_bvh()) {
        plans.extend(maintenance.iter().map(|&maintenance| Plan { maintenance, ..plan }));
    }
    for skin in [0.0, 0.1, 0.3] {
        plans.extend(Images::ALL.iter().map(|&images| Plan {
            images,
            skin: Skin::Fixed(skin),
            ..Plan::new(Method::RtList)
        }));
    }
    let mut first = None;
    plans::run(&mut *factory(), &system, &plans::deterministic(plans), |engine, plan| {
        let end = run(engine, &system, plan, &Dynamics::nve(0.004), 60);
        let (expected, method) = first.get_or_insert_with(|| (end.clone(), plan.method));
        assert!(end == *expected, "{plan:?} leaves the trajectory of {method}");
    });
}

/// Without forces the unwrapped position of each particle is a straight line, whatever its place in memory.
pub fn free_flight_keeps_input_order_and_continuous_unwrapped_positions(factory: Factory) {
    for boundary in [[Boundary::Periodic; 3], [Boundary::Periodic, Boundary::Open, Boundary::Periodic]] {
        let sim_box = cases::cube(10.0, boundary);
        let mut system = cases::soft(sim_box, cases::uniform(80, &sim_box, 3), Radii::Uniform(1.0));
        give_masses(&mut system);
        system.interaction.types.iter_mut().for_each(|kind| kind.epsilon = 0.0);
        let mut rng = cases::rng(4);
        for axis in system.particles.velocity.axes_mut() {
            axis.iter_mut().for_each(|v| *v = rng.random_range(-3.0..3.0));
        }
        system.particles.image.iter_mut().enumerate().for_each(|(i, image)| image[0] = i as i32 - 40);
        let (dt, start) = (0.15, system.particles.clone());
        plans::run(&mut *factory(), &system, &plans::every(), |engine, plan| {
            for round in 1..=4u32 {
                let from = u64::from(round - 1) * 12;
                engine.advance(&Dynamics::nve(dt), from, 12, Quantities::FORCES).expect("a run");
                let now = snapshot(engine);
                assert_eq!(now.kind, start.kind, "{plan:?}");
                assert_eq!(now.velocity, start.velocity, "{plan:?}");
                let time = f64::from(round) * 12.0 * f64::from(dt);
                for i in 0..start.len() {
                    for axis in 0..3 {
                        let v = f64::from(start.velocity.get(i)[axis]);
                        let expected = unwrapped(&system, &start, i, axis) + v * time;
                        let found = unwrapped(&system, &now, i, axis);
                        assert!((found - expected).abs() < 1e-3, "{plan:?}: {i} is at {found}, not {expected}");
                        let x = now.position.get(i)[axis];
                        assert!(!sim_box.is_periodic(axis) || (0.0..10.0).contains(&x), "{plan:?}: {x} not wrapped");
                    }
                }
            }
        });
    }
}

/// With different masses.
pub fn momentum_is_conserved(factory: Factory) {
    let mut system = cases::liquid(3, 1.0, 0.05, 2.5, 5);
    give_masses(&mut system);
    let mass = |k: u32| f64::from(system.interaction.types[k as usize].mass);
    let momenta = |p: &Particles| -> Vec<[f64; 3]> {
        p.velocity.iter().zip(&p.kind).map(|(v, &k)| v.map(|v| mass(k) * f64::from(v))).collect()
    };
    let sum = |momenta: &[[f64; 3]], axis: usize| momenta.iter().map(|p| p[axis]).sum::<f64>();
    let before = momenta(&system.particles);
    let scale: f64 = before.iter().flatten().map(|p| p.abs()).sum();
    plans::run(&mut *factory(), &system, &plans::each_structure(), |engine, plan| {
        let totals = engine.advance(&Dynamics::nve(0.004), 0, 100, Quantities::FORCES).expect("a run");
        let after = momenta(&snapshot(engine));
        for axis in 0..3 {
            let drift = sum(&after, axis) - sum(&before, axis);
            assert!(drift.abs() < 2e-6 * scale, "{plan:?}: axis {axis} drifts by {drift}");
            assert!((totals.momentum[axis] - sum(&after, axis)).abs() < 2e-6 * scale, "{plan:?}: {totals:?}");
        }
    });
}

/// Velocity Verlet is of second order: halving dt divides the fluctuation of the energy by four. A force-shifted cutoff,
/// for a jump in the force would add an error of its own.
pub fn energy_fluctuations_fall_with_the_square_of_the_time_step(factory: Factory) {
    let mut system = cases::liquid(3, 1.0, 0.02, 2.5, 6);
    system.interaction.truncation = Truncation::Force;
    let mut engine = factory();
    system.particles = run(&mut *engine, &system, &Plan::new(Method::Cell), &Dynamics::nve(0.004), 200);
    plans::run(&mut *engine, &system, &plans::each_method(), |engine, plan| {
        let mut fluctuation = |dt: f32, steps: u64| {
            engine.load(&system, plan).expect("a load");
            let energies: Vec<f64> = (0..steps)
                .map(|step| engine.advance(&Dynamics::nve(dt), step, 1, Quantities::ALL).expect("a step"))
                .map(|totals| totals.kinetic_energy + totals.potential_energy)
                .collect();
            let mean = energies.iter().sum::<f64>() / steps as f64;
            (energies.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / steps as f64).sqrt()
        };
        let [coarse, middle, fine] = [(0.008, 100), (0.004, 200), (0.002, 400)].map(|(dt, n)| fluctuation(dt, n));
        for ratio in [coarse / middle, middle / fine] {
            assert!((3.2..5.0).contains(&ratio), "{plan:?}: fluctuations {coarse}, {middle}, {fine}");
        }
        // The depth of the wells is about 500 in all.
        assert!(fine < 0.01, "{plan:?}: {fine}");
    });
}

/// Velocity Verlet is reversible; what remains are roundings and their growth.
pub fn reversed_velocities_lead_back_to_the_start(factory: Factory) {
    let system = cases::liquid(3, 1.0, 0.05, 2.5, 7);
    plans::run(&mut *factory(), &system, &plans::each_structure(), |engine, plan| {
        let mut back = system.clone();
        back.particles = run(engine, &system, plan, &Dynamics::nve(0.004), 80);
        let away = apart(&system, &back.particles, &system.particles);
        assert!(away > 0.1, "{plan:?}: nothing moved");
        for axis in back.particles.velocity.axes_mut() {
            axis.iter_mut().for_each(|v| *v = -*v);
        }
        let end = run(engine, &back, plan, &Dynamics::nve(0.004), 80);
        let apart = apart(&system, &end, &system.particles);
        assert!(apart < 2e-4, "{plan:?}: {apart} from the start");
    });
}

/// The position between walls that a free particle reaches, and whether its velocity has turned.
fn folded(x: f64, lo: f64, hi: f64) -> (f64, bool) {
    let (length, phase) = (hi - lo, (x - lo).rem_euclid(2.0 * (hi - lo)));
    if phase > length { (lo + 2.0 * length - phase, true) } else { (lo + phase, false) }
}

/// Free particles, the fastest of which bounce several times in a step.
pub fn walls_reflect_elastically_and_keep_particles_inside(factory: Factory) {
    for (name, boundary) in cases::BOUNDARIES.into_iter().filter(|(name, _)| name.contains('w')) {
        let sim_box = cases::cube(5.0, boundary);
        let mut system = cases::soft(sim_box, cases::uniform(100, &sim_box, 8), Radii::Uniform(1.0));
        system.interaction.types[0].epsilon = 0.0;
        let mut rng = cases::rng(9);
        for axis in system.particles.velocity.axes_mut() {
            axis.iter_mut().for_each(|v| *v = rng.random_range(-60.0..60.0));
        }
        let dt = 0.25;
        plans::run(&mut *factory(), &system, &plans::each_structure(), |engine, plan| {
            let mut before = system.particles.clone();
            for step in 0..12 {
                engine.advance(&Dynamics::nve(dt), step, 1, Quantities::FORCES).expect("a step");
                let after = snapshot(engine);
                for i in 0..after.len() {
                    for axis in (0..3).filter(|&axis| boundary[axis] == Boundary::Wall) {
                        let (x, v) = (before.position.get(i)[axis], before.velocity.get(i)[axis]);
                        let (found, speed) = (after.position.get(i)[axis], after.velocity.get(i)[axis]);
                        let (expected, turned) = folded(f64::from(x) + f64::from(dt) * f64::from(v), 0.0, 5.0);
                        let what = format!("{name}, {plan:?}: particle {i} from {x} at {v}");
                        assert!((0.0..=5.0).contains(&found), "{what}: left the box to {found}");
                        assert!((f64::from(found) - expected).abs() < 2e-5, "{what}: at {found}, not {expected}");
                        // Within rounding of a wall either side of the bounce is right.
                        let at_wall = expected.min(5.0 - expected) < 2e-5;
                        assert!(at_wall || speed == if turned { -v } else { v }, "{what}: leaves at {speed}");
                        assert_eq!(speed.abs(), v.abs(), "{what}");
                    }
                }
                before = after;
            }
        });
    }
}

/// Collisions with each other and with walls.
pub fn an_interacting_gas_between_walls_conserves_energy(factory: Factory) {
    let mut system = cases::lattice(4, 1.5, 1.2, [Boundary::Wall; 3]);
    system.interaction = Interaction { potential: Potential::Wca(Wca), ..Interaction::lennard_jones() };
    cases::thermalize(&mut system, 1.5, &mut cases::rng(10));
    plans::run(&mut *factory(), &system, &plans::each_structure(), |engine, plan| {
        let start = engine.evaluate(Quantities::ALL).expect("an evaluation");
        let end = engine.advance(&Dynamics::nve(0.002), 0, 250, Quantities::ALL).expect("a run");
        let (before, after) =
            (start.kinetic_energy + start.potential_energy, end.kinetic_energy + end.potential_energy);
        assert!((after / before - 1.0).abs() < 1e-3, "{plan:?}: {before} became {after}");
        assert!(end.potential_energy > 0.0, "{plan:?}: nothing collided");
        let particles = snapshot(engine);
        assert!(particles.position.iter().flatten().all(|x| (0.0..=6.0).contains(&x)), "{plan:?}");
    });
}

/// Bit for bit, for every ensemble; and a run in parts equals the run in one.
pub fn continuing_from_a_snapshot_equals_not_having_stopped(factory: Factory) {
    let system = cases::liquid(3, 1.0, 0.05, 2.5, 11);
    let ensembles = [
        Ensemble::Nve,
        Ensemble::Langevin { temperature: 1.2, friction: 1.0 },
        Ensemble::Rescale { temperature: 1.2, relaxation: 0.1 },
    ];
    for ensemble in ensembles {
        let dynamics = Dynamics { ensemble, seed: 12, ..Dynamics::nve(0.004) };
        plans::run(&mut *factory(), &system, &plans::deterministic(plans::each_structure()), |engine, plan| {
            engine.advance(&dynamics, 0, 10, Quantities::FORCES).expect("a run");
            let mut half = system.clone();
            engine.snapshot(&mut half.particles).expect("a copy");
            engine.advance(&dynamics, 10, 4, Quantities::ALL).expect("a run");
            engine.advance(&dynamics, 14, 6, Quantities::FORCES).expect("a run");
            let whole = snapshot(engine);
            engine.load(&half, plan).expect("a load");
            assert!(snapshot(engine) == half.particles, "{plan:?}: loading alters the particles");
            engine.advance(&dynamics, 10, 10, Quantities::FORCES).expect("a run");
            assert!(snapshot(engine) == whole, "{ensemble:?}, {plan:?}: differs after a restart");
        });
    }
}
