//! Overlaps, blow-ups and small memory.

use crate::{Factory, cases, plans};
use nearfield_core::{
    Boundary, Dynamics, Engine, Ensemble, Error, Interaction, Method, Particles, PerParticle, Plan, Quantities, Radii,
    System,
};

/// Random points under Lennard-Jones, two of them coincident: forces overflow.
fn overlapping() -> System {
    let sim_box = cases::cube(6.0, [Boundary::Periodic; 3]);
    let mut points = cases::uniform(150, &sim_box, 1);
    points.push(points[7]);
    let mut system = cases::soft(sim_box, points, Radii::Uniform(2.5));
    system.interaction = Interaction::lennard_jones();
    system
}

/// With the limit set, no step carries a particle further, and the run goes on until the overlaps are gone.
pub fn no_particle_moves_further_than_the_limit_and_overlapping_starts_survive(factory: Factory) {
    let system = overlapping();
    let lengths = system.sim_box.lengths();
    for ensemble in [Ensemble::Nve, Ensemble::Langevin { temperature: 1.0, friction: 1.0 }] {
        let dynamics = Dynamics { ensemble, max_displacement: 0.05, ..Dynamics::nve(0.005) };
        plans::run(&mut *factory(), &system, &plans::each_structure(), |engine, plan| {
            let (mut before, mut after) = (system.particles.clone(), Particles::default());
            for step in 0..30 {
                engine.advance(&dynamics, step, 1, Quantities::FORCES).unwrap_or_else(|e| panic!("{plan:?}: {e}"));
                engine.snapshot(&mut after).expect("a copy");
                for i in 0..after.len() {
                    let moved: f64 = (0..3)
                        .map(|a| {
                            let image = f64::from(after.image[i][a] - before.image[i][a]);
                            f64::from(after.position.get(i)[a]) - f64::from(before.position.get(i)[a])
                                + image * f64::from(lengths[a])
                        })
                        .map(|d| d * d)
                        .sum();
                    // Positions are rounded to half an ulp of the box, three times.
                    assert!(moved.sqrt() < 0.05 + 3e-6, "{plan:?}, step {step}: {i} moved {}", moved.sqrt());
                }
                std::mem::swap(&mut before, &mut after);
            }
            let finite = |v: [f32; 3]| v.iter().all(|x| x.is_finite());
            assert!(before.position.iter().all(finite) && before.velocity.iter().all(finite), "{plan:?}");
        });
    }
}

/// An error that names the step, not NaN positions.
pub fn a_run_that_blows_up_is_an_error(factory: Factory) {
    let sim_box = cases::cube(10.0, [Boundary::Periodic; 3]);
    let mut system = cases::soft(sim_box, vec![[5.0; 3], [5.0, 5.0, 5.00001], [1.0; 3]], Radii::Uniform(2.5));
    system.interaction = Interaction::lennard_jones();
    plans::run(&mut *factory(), &system, &plans::each_structure(), |engine, plan| {
        match engine.advance(&Dynamics::nve(0.01), 0, 10, Quantities::ALL) {
            Err(Error::NonFinite { step, .. }) => assert!(step <= 10, "{plan:?}: step {step}"),
            other => panic!("{plan:?}: {other:?}"),
        }
    });
}

/// Batches instead of an overflow or an error.
pub fn a_list_beyond_the_memory_budget_gives_the_same_forces_and_trajectory(factory: Factory) {
    let system = cases::liquid(4, 1.0, 0.1, 2.5, 2);
    let roomy = Plan { deterministic: true, ..Plan::new(Method::RtList) };
    let mut expected: Option<(PerParticle, Particles)> = None;
    let plans: Vec<Plan> = [roomy.memory_budget, 20_000, 3_000, 1]
        .iter()
        .flat_map(|&memory_budget| plans::each_structure().into_iter().map(move |plan| Plan { memory_budget, ..plan }))
        .filter(|plan| plan.method.uses_list())
        .collect();
    plans::run(&mut *factory(), &system, &plans::deterministic(plans), |engine: &mut dyn Engine, plan| {
        let (mut forces, mut end) = (PerParticle::default(), Particles::default());
        engine.evaluate(Quantities::ALL).unwrap_or_else(|error| panic!("{plan:?}: {error}"));
        engine.per_particle(&mut forces).expect("a copy");
        engine.advance(&Dynamics::nve(0.004), 0, 20, Quantities::FORCES).expect("a run");
        engine.snapshot(&mut end).expect("a copy");
        let batched = engine.report().batched_evaluations;
        // Pairs of clusters may fit where pairs of particles do not.
        if plan.method == Method::Cluster && plan.memory_budget == 20_000 {
            return;
        }
        assert_eq!(batched > 0, plan.memory_budget < roomy.memory_budget, "{plan:?}: {batched} in batches");
        let (first, trajectory) = expected.get_or_insert_with(|| (forces.clone(), end.clone()));
        assert!(forces.force == first.force && forces.neighbors == first.neighbors, "{plan:?}");
        assert!(end == *trajectory, "{plan:?}");
    });
}
