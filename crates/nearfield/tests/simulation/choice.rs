//! `auto`: a supported method, and why.

use crate::{crystal, smooth};
use nearfield::{
    Boundary, Device, Dynamics, Interaction, Maintenance, Method, Order, Particles, Plan, Radii, SimBox, Simulation,
    Skin, System,
};
use std::ops::ControlFlow;

#[test]
fn a_short_run_takes_what_is_predicted_to_be_the_fastest() {
    let mut simulation = Simulation::builder(crystal(500, 0.8442, 1.0)).device(Device::Cpu).build().unwrap();
    simulation.advance(5).unwrap();
    let choice = simulation.choice();
    let quickest = choice.candidates.iter().min_by(|a, b| a.predicted_seconds.total_cmp(&b.predicted_seconds)).unwrap();
    assert_eq!(choice.method, quickest.method);
    assert_eq!(simulation.plan().method, choice.method);
    assert!(choice.candidates.len() > 3, "{choice:?}");
    assert!(choice.candidates.iter().all(|candidate| candidate.measured_seconds.is_none()), "{choice:?}");
    assert_eq!(choice.survey.unwrap().n, 500);
}

#[test]
fn a_long_run_tries_some_and_moves_as_if_the_fastest_had_been_asked_for() {
    const STEPS: u64 = 30_000;
    let plan = Plan { deterministic: true, ..Plan::new(Method::Cell) };
    let builder = || Simulation::builder(crystal(108, 0.8442, 1.0)).device(Device::Cpu).plan(plan);
    let mut tuned = builder().build().unwrap();
    tuned.run(STEPS, &mut [], &mut |_| ControlFlow::Continue(())).unwrap();
    let choice = tuned.choice().clone();
    let tried: Vec<_> = choice.candidates.iter().filter(|candidate| candidate.measured_seconds.is_some()).collect();
    assert!(tried.len() > 1, "{choice:?}");
    assert!(choice.reason.contains("tried at step"), "{choice:?}");
    for candidate in &tried {
        assert!(choice.reason.contains(candidate.method.name()) || choice.method == candidate.method, "{choice:?}");
    }
    let mut fixed = builder().method(choice.method).build().unwrap();
    fixed.advance(STEPS).unwrap();
    assert!(tuned.system().unwrap().particles == fixed.system().unwrap().particles, "{choice:?}");
    let (tuned, fixed) = (tuned.report(), fixed.report());
    // A few more, where the engine was loaded again; the trials were of dozens.
    assert!(tuned.evaluations - fixed.evaluations < 20, "trials are not counted: {tuned:?} {fixed:?}");
}

#[test]
fn auto_keeps_every_setting_but_the_method() {
    let plan = Plan {
        order: Order::Cell,
        maintenance: Maintenance::Fixed(7),
        skin: Skin::Fixed(0.2),
        ..Plan::new(Method::Brute)
    };
    let simulation = Simulation::builder(crystal(500, 0.8442, 1.0)).plan(plan).build().unwrap();
    assert_eq!(*simulation.plan(), Plan { method: simulation.choice().method, ..plan });
}

#[test]
fn auto_considers_only_methods_that_support_radii_of_each_particle() {
    let mut system = smooth(500, 0.2, 1.0);
    system.radii = Radii::PerParticle((0..500).map(|i| 1.0 + 0.002 * i as f32).collect());
    system.interaction.radius_per_sigma = 2.5;
    let simulation = Simulation::builder(system).device(Device::Cpu).build().unwrap();
    let choice = simulation.choice();
    let methods: Vec<Method> = choice.candidates.iter().map(|candidate| candidate.method).collect();
    assert!(methods.contains(&Method::RtForces), "{methods:?}");
    assert!(methods.iter().all(|method| method.supports_variable_radii()), "{methods:?}");
    assert!(choice.survey.unwrap().variable_radii);
}

#[test]
fn overlapping_starts_run_where_the_displacement_is_limited_and_are_refused_where_not() {
    let system = System {
        sim_box: SimBox::cubic(10.0, Boundary::Periodic).unwrap(),
        particles: Particles::at([[1.0; 3], [1.0; 3], [5.0; 3]]),
        radii: Radii::Uniform(2.5),
        interaction: Interaction::lennard_jones(),
    };
    let dynamics = Dynamics { max_displacement: 0.1, ..Dynamics::nve(0.005) };
    let mut simulation = Simulation::builder(system.clone()).dynamics(dynamics).build().unwrap();
    assert!(simulation.advance(10).unwrap().total_energy.is_finite());
    let error = Simulation::builder(system).build().unwrap().thermo().unwrap_err();
    assert!(error.to_string().contains("particles 0 and 1 are at the same place"), "{error}");
    assert!(error.is_request());
}

#[test]
fn what_cannot_run_is_refused_at_once() {
    let system = smooth(108, 0.5, 1.0);
    let empty = System { particles: Particles::default(), ..system.clone() };
    let message = |system: System, method: Option<Method>| {
        let builder = Simulation::builder(system);
        let builder = if let Some(method) = method { builder.method(method) } else { builder };
        builder.build().err().expect("refused").to_string()
    };
    assert!(message(empty, None).contains("no particles"));
    let mut wrong = system.clone();
    wrong.particles.position.set(7, [1.0, f32::NAN, 1.0]);
    assert!(message(wrong, None).contains("particle 7: coordinate y is NaN"));
    let mut wrong = system.clone();
    wrong.radii = Radii::PerParticle(vec![1.0; 108]);
    assert!(message(wrong, Some(Method::RtPerse)).contains("use cell, rt-list or rt-forces"));
    let builder = Simulation::builder(system).dynamics(Dynamics::nve(f32::NAN));
    assert!(builder.build().err().expect("refused").to_string().contains("dt"));
}
