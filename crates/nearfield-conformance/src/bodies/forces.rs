//! Forces, energies and virials against the float64 oracle.

use crate::{
    Expected, Factory,
    cases::{self, Case},
    plans,
};
use nearfield_core::{
    Boundary, Engine, Error, Interaction, Method, Mixing, Order, ParticleType, PerParticle, Plan, Quantities, Radii,
    Totals, Truncation,
    potentials::{Gaussian, LennardJones, Morse, PairPotential, Potential, Table, Wca, Yukawa},
};
use rand::RngExt;
use std::sync::Arc;

/// Both kinds of sums: fast ones and those independent of order.
fn with_and_without_determinism(plans: Vec<Plan>) -> Vec<Plan> {
    let mut both = plans.clone();
    both.extend(plans::deterministic(plans));
    both
}

/// Evaluates and compares everything with the oracle.
fn compare(engine: &mut dyn Engine, expected: &Expected, what: &str) {
    let totals = engine.evaluate(Quantities::ALL).unwrap_or_else(|error| panic!("{what}: {error}"));
    let mut found = PerParticle::default();
    engine.per_particle(&mut found).expect("a copy");
    let reference = &expected.reference;
    assert_eq!((found.force.len(), found.energy.len()), (reference.force.len(), reference.energy.len()), "{what}");
    for (i, force) in found.force.iter().enumerate() {
        let error = expected.force_error[i];
        for (axis, (found, exact)) in force.map(f64::from).into_iter().zip(reference.force[i]).enumerate() {
            assert!((found - exact).abs() <= error, "{what}: force {axis} on {i}: {found} for {exact} ± {error}");
        }
    }
    let close = |name: &str, found: f64, exact: f64, error: f64| {
        assert!((found - exact).abs() <= error, "{what}: {name} {found} for {exact} ± {error}");
    };
    close("energy", totals.potential_energy, reference.potential_energy, expected.energy_error);
    close("virial", totals.virial, reference.virial, expected.virial_error);
    close("sum of energies", found.energy.iter().sum(), reference.potential_energy, expected.energy_error);
    for (i, (&found, &exact)) in found.energy.iter().zip(&reference.energy).enumerate() {
        close(&format!("energy of {i}"), found, exact, expected.energy_error);
    }
    assert_eq!(totals.pairs, reference.pairs, "{what}");
}

/// Every input of [`cases::all`], by every structure.
pub fn forces_energies_and_virials_equal_the_oracle_on_every_input(factory: Factory) {
    let (mut engine, plans) = (factory(), with_and_without_determinism(plans::each_structure()));
    for Case { name, system } in cases::all() {
        let expected = Expected::new(&system);
        plans::run(&mut *engine, &system, &plans, |engine, plan| {
            compare(engine, &expected, &format!("{name}, {plan:?}"));
        });
    }
}

/// A liquid under each potential and truncation, in each boundary.
pub fn every_potential_and_truncation_equals_the_oracle(factory: Factory) {
    let mut engine = factory();
    let rows: Vec<[f64; 3]> = (0..300)
        .map(|k| 0.5 + 2.0 * f64::from(k) / 299.0)
        .map(|r| [r, Gaussian.energy(r * r, 1.0, 1.0), Gaussian.f_over_r(r * r, 1.0, 1.0) * r])
        .collect();
    let potentials = [
        Potential::LennardJones(LennardJones),
        Potential::Wca(Wca),
        Potential::Yukawa(Yukawa { kappa: 1.2 }),
        Potential::Morse(Morse { alpha: 3.0 }),
        Potential::Gaussian(Gaussian),
        Potential::Table(Arc::new(Table::new(&rows).expect("a table"))),
    ];
    for (k, potential) in potentials.into_iter().enumerate() {
        for (t, truncation) in [Truncation::Cut, Truncation::Energy, Truncation::Force].into_iter().enumerate() {
            let mut system = cases::liquid(3, 1.0, 0.1, 2.5, 17);
            let (name, boundary) = cases::BOUNDARIES[(k + t) % cases::BOUNDARIES.len()];
            system.sim_box = cases::cube(system.sim_box.lengths()[0], boundary);
            // Shaken atoms may lie beyond a wall.
            let length = system.sim_box.lengths()[0];
            for axis in system.particles.position.axes_mut() {
                axis.iter_mut().for_each(|x| *x = x.clamp(0.0, length.next_down()));
            }
            system.interaction = Interaction { potential: potential.clone(), truncation, ..system.interaction };
            let expected = Expected::new(&system);
            plans::run(&mut *engine, &system, &with_and_without_determinism(plans::each_method()), |engine, plan| {
                compare(engine, &expected, &format!("{} {truncation:?} {name}, {plan:?}", potential.name()));
            });
        }
    }
}

/// Three types with both mixing rules, and search radii that scale sigma.
pub fn mixtures_of_types_equal_the_oracle(factory: Factory) {
    let mut engine = factory();
    for mixing in [Mixing::LorentzBerthelot, Mixing::Geometric] {
        for radii in [false, true] {
            let mut system = cases::liquid(3, 1.0, 0.05, 2.5, 19);
            let kind = |name: &str, epsilon, sigma, mass| ParticleType { name: name.into(), epsilon, sigma, mass };
            system.interaction.types =
                vec![kind("a", 1.0, 1.0, 1.0), kind("b", 0.4, 0.8, 2.5), kind("c", 2.0, 0.9, 0.3)];
            system.interaction.mixing = mixing;
            system.interaction.truncation = Truncation::Energy;
            for (i, kind) in system.particles.kind.iter_mut().enumerate() {
                *kind = (i % 3) as u32;
            }
            if radii {
                let mut rng = cases::rng(23);
                let n = system.particles.len();
                system.radii = Radii::PerParticle((0..n).map(|_| rng.random_range(1.5..2.5)).collect());
            }
            let expected = Expected::new(&system);
            plans::run(
                &mut *engine,
                &system,
                &with_and_without_determinism(plans::each_structure()),
                |engine, plan| {
                    compare(engine, &expected, &format!("{mixing:?}, radii {radii}, {plan:?}"));
                },
            );
        }
    }
}

/// Newton's third law.
pub fn forces_sum_to_zero(factory: Factory) {
    let system = cases::liquid(3, 1.0, 0.12, 2.5, 29);
    let expected = Expected::new(&system);
    plans::run(&mut *factory(), &system, &with_and_without_determinism(plans::every()), |engine, plan| {
        engine.evaluate(Quantities::FORCES).expect("an evaluation");
        let mut found = PerParticle::default();
        engine.per_particle(&mut found).expect("a copy");
        // The roundings of both sides of a pair are equal and opposite; those of the sums remain.
        let allowed: f64 = f64::from(f32::EPSILON) * expected.reference.magnitude.iter().sum::<f64>();
        for (axis, f) in found.force.axes().into_iter().enumerate() {
            let sum: f64 = f.iter().map(|&f| f64::from(f)).sum();
            assert!(sum.abs() <= allowed, "{plan:?}: axis {axis} sums to {sum}, allowed {allowed}");
        }
    });
}

/// `Quantities::FORCES` leaves the rest empty and the forces as they are.
pub fn asking_for_forces_only_changes_no_force(factory: Factory) {
    let system = cases::liquid(3, 1.0, 0.12, 2.5, 31);
    let expected = Expected::new(&system);
    plans::run(&mut *factory(), &system, &with_and_without_determinism(plans::each_structure()), |engine, plan| {
        let (mut full, mut forces) = (PerParticle::default(), PerParticle::default());
        engine.evaluate(Quantities::ALL).expect("an evaluation");
        engine.per_particle(&mut full).expect("a copy");
        let totals = engine.evaluate(Quantities::FORCES).expect("an evaluation");
        engine.per_particle(&mut forces).expect("a copy");
        assert!(forces.energy.is_empty() && forces.neighbors.is_empty(), "{plan:?}");
        assert_eq!((totals.potential_energy, totals.virial, totals.pairs), (0.0, 0.0, 0), "{plan:?}");
        if plan.deterministic {
            assert_eq!(full.force, forces.force, "{plan:?}");
        }
        for (i, (a, b)) in full.force.iter().zip(forces.force.iter()).enumerate() {
            let apart = (0..3).map(|k| f64::from((a[k] - b[k]).abs())).fold(0.0, f64::max);
            assert!(apart <= expected.force_error[i], "{plan:?}: forces on {i} differ by {apart}");
        }
    });
}

/// The totals that do not come from pairs.
pub fn kinetic_energy_momentum_and_largest_force_are_those_of_the_particles(factory: Factory) {
    let mut system = cases::liquid(3, 1.3, 0.1, 2.5, 37);
    system.interaction.types.push(ParticleType { name: "2".into(), mass: 3.5, ..ParticleType::default() });
    system.particles.kind.iter_mut().step_by(3).for_each(|kind| *kind = 1);
    let mut expected = Totals::default();
    for (v, &kind) in system.particles.velocity.iter().zip(&system.particles.kind) {
        let mass = f64::from(system.interaction.types[kind as usize].mass);
        for (momentum, v) in expected.momentum.iter_mut().zip(v) {
            *momentum += mass * f64::from(v);
            expected.kinetic_energy += 0.5 * mass * f64::from(v).powi(2);
        }
    }
    plans::run(&mut *factory(), &system, &with_and_without_determinism(plans::each_method()), |engine, plan| {
        let totals = engine.evaluate(Quantities::FORCES).expect("an evaluation");
        let scale = 1e-5 * expected.kinetic_energy;
        assert!((totals.kinetic_energy - expected.kinetic_energy).abs() < scale, "{plan:?}: {totals:?}");
        for axis in 0..3 {
            assert!((totals.momentum[axis] - expected.momentum[axis]).abs() < scale, "{plan:?}: {totals:?}");
        }
        let mut found = PerParticle::default();
        engine.per_particle(&mut found).expect("a copy");
        let norm = |f: [f32; 3]| f.iter().map(|&f| f64::from(f).powi(2)).sum::<f64>().sqrt();
        let largest = found.force.iter().map(norm).fold(0.0, f64::max);
        assert!((totals.max_force / largest - 1.0).abs() < 1e-5, "{plan:?}: {} for {largest}", totals.max_force);
    });
}

/// Lennard-Jones at zero distance; the Gaussian core does not mind ([`cases::all`] has such inputs).
pub fn coincident_particles_are_an_error_that_names_both_where_the_potential_diverges(factory: Factory) {
    let mut engine = factory();
    for boundary in [[Boundary::Periodic; 3], [Boundary::Open; 3]] {
        let mut system = cases::liquid(3, 1.0, 0.05, 2.5, 41);
        system.sim_box = cases::cube(system.sim_box.lengths()[0], boundary);
        let healthy = system.clone();
        let place = system.particles.position.get(20);
        system.particles.position.set(71, place);
        for potential in
            [Potential::LennardJones(LennardJones), Potential::Wca(Wca), Potential::Yukawa(Yukawa { kappa: 1.0 })]
        {
            system.interaction.potential = potential;
            plans::run(
                &mut *engine,
                &system,
                &with_and_without_determinism(plans::each_structure()),
                |engine, plan| {
                    for quantities in [Quantities::ALL, Quantities::FORCES] {
                        match engine.evaluate(quantities) {
                            Err(Error::Coincident(20, 71) | Error::Coincident(71, 20)) => {}
                            other => panic!("{plan:?}, {quantities:?}: {other:?}"),
                        }
                    }
                    engine.load(&healthy, plan).expect("a load");
                    assert!(engine.evaluate(Quantities::ALL).is_ok(), "{plan:?}: still failing after a new system");
                },
            );
        }
    }
}

/// Bit for bit, where the plan asks for it.
pub fn deterministic_forces_are_bitwise_equal_between_all_plans_and_repeats(factory: Factory) {
    let mut engine = factory();
    let mut cases = cases::all();
    cases.push(Case { name: "liquid".into(), system: cases::liquid(4, 1.0, 0.12, 2.5, 43) });
    for Case { name, system } in cases {
        let mut first: Option<(PerParticle, Method)> = None;
        plans::run(&mut *engine, &system, &plans::deterministic(plans::every()), |engine, plan| {
            for _ in 0..if plan.order == Order::Morton { 2 } else { 1 } {
                engine.evaluate(Quantities::FORCES).expect("an evaluation");
                let mut found = PerParticle::default();
                engine.per_particle(&mut found).expect("a copy");
                let (expected, method) = first.get_or_insert((found.clone(), plan.method));
                for (i, (a, b)) in expected.force.iter().zip(found.force.iter()).enumerate() {
                    // As numbers: an empty sum may be either zero.
                    assert!(a == b, "{name}: force on {i} is {a:?} by {method}, {b:?} by {plan:?}");
                }
            }
        });
    }
}
