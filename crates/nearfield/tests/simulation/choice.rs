//! `auto`: a supported method, and why.

use crate::{crystal, smooth};
use nearfield::{
    Boundary, Dynamics, Interaction, Maintenance, Method, Order, Particles, Plan, Radii, SimBox, Simulation, System,
};

#[test]
fn auto_takes_the_fastest_of_what_it_measured_and_says_so() {
    let simulation = Simulation::builder(crystal(500, 0.8442, 1.0)).build().unwrap();
    let choice = simulation.choice();
    let fastest = choice.measured.iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    assert_eq!(choice.method, fastest.0);
    assert_eq!(simulation.plan().method, choice.method);
    assert!(choice.measured.len() > 3, "{choice:?}");
    assert!(choice.measured.iter().any(|(method, _)| *method == Method::Brute), "500 are few enough for all pairs");
    for (method, _) in &choice.measured {
        assert!(*method == choice.method || choice.reason.contains(method.name()), "{choice:?}");
    }
}

#[test]
fn auto_keeps_every_setting_but_the_method() {
    let plan = Plan { order: Order::Cell, maintenance: Maintenance::Fixed(7), skin: 0.2, ..Plan::new(Method::Brute) };
    let simulation = Simulation::builder(crystal(500, 0.8442, 1.0)).plan(plan).build().unwrap();
    assert_eq!(*simulation.plan(), Plan { method: simulation.choice().method, ..plan });
}

#[test]
fn auto_measures_only_methods_that_support_radii_of_each_particle() {
    let mut system = smooth(500, 0.2, 1.0);
    system.radii = Radii::PerParticle((0..500).map(|i| 1.0 + 0.002 * i as f32).collect());
    system.interaction.radius_per_sigma = 2.5;
    let simulation = Simulation::builder(system).build().unwrap();
    let measured: Vec<Method> = simulation.choice().measured.iter().map(|(method, _)| *method).collect();
    assert!(measured.contains(&Method::RtForces), "{measured:?}");
    assert!(measured.iter().all(|method| method.supports_variable_radii()), "{measured:?}");
}

#[test]
fn overlapping_starts_cannot_be_measured_and_fall_back_to_cell() {
    let system = System {
        sim_box: SimBox::cubic(10.0, Boundary::Periodic).unwrap(),
        particles: Particles::at([[1.0; 3], [1.0; 3], [5.0; 3]]),
        radii: Radii::Uniform(2.5),
        interaction: Interaction::lennard_jones(),
    };
    let dynamics = Dynamics { max_displacement: 0.1, ..Dynamics::nve(0.005) };
    let mut simulation = Simulation::builder(system.clone()).dynamics(dynamics).build().unwrap();
    assert_eq!(simulation.choice().method, Method::Cell);
    assert!(simulation.choice().reason.contains("overlap"));
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
