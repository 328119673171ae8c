//! What an engine takes and what it refuses.

use crate::{Factory, cases, plans};
use nearfield_core::{Dynamics, Error, ListKind, ListRequest, PerParticle, Quantities, Radii};

/// A point ray from i finds the j whose box holds i: a method that gathers by it needs equal radii.
pub fn different_radii_are_refused_exactly_by_the_methods_that_cannot_treat_them(factory: Factory) {
    let mut engine = factory();
    let uniform = cases::liquid(3, 1.0, 0.05, 2.0, 1);
    let mut different = uniform.clone();
    different.radii = Radii::PerParticle((0..uniform.particles.len()).map(|i| 1.0 + (i % 3) as f32 / 3.0).collect());
    for plan in plans::every() {
        assert_eq!(engine.supports(&uniform, &plan), Ok(()), "{plan:?}");
        let (answer, load) = (engine.supports(&different, &plan), engine.load(&different, &plan));
        assert_eq!(answer, load, "{plan:?}");
        if plan.method.supports_variable_radii() {
            assert_eq!(answer, Ok(()), "{plan:?}");
        } else {
            assert!(matches!(answer, Err(Error::Unsupported { method, .. }) if method == plan.method), "{plan:?}");
        }
    }
}

/// An error, not a panic.
pub fn an_engine_without_a_system_says_so(factory: Factory) {
    let mut engine = factory();
    assert_eq!(engine.evaluate(Quantities::ALL), Err(Error::NotLoaded));
    assert_eq!(engine.advance(&Dynamics::nve(0.01), 0, 1, Quantities::ALL), Err(Error::NotLoaded));
    assert_eq!(engine.neighbor_list(ListRequest::new(ListKind::Half)), Err(Error::NotLoaded));
    assert_eq!(engine.report(), Default::default());
    assert!(!engine.device().is_empty());
}

/// A smaller system after a larger one by the same plan, and back: buffers are reused, results are not.
pub fn loading_forgets_the_system_before(factory: Factory) {
    let (large, small) = (cases::liquid(4, 1.0, 0.1, 2.5, 3), cases::liquid(3, 1.0, 0.1, 2.2, 4));
    for plan in plans::deterministic(plans::each_structure()) {
        let mut used = factory();
        if used.supports(&large, &plan).is_err() {
            continue;
        }
        for system in [&large, &small, &large] {
            let mut fresh = factory();
            let (mut expected, mut found) = (PerParticle::default(), PerParticle::default());
            for (engine, out) in [(&mut fresh, &mut expected), (&mut used, &mut found)] {
                engine.load(system, &plan).expect("a load");
                engine.advance(&Dynamics::nve(0.004), 0, 3, Quantities::ALL).expect("a run");
                engine.per_particle(out).expect("a copy");
            }
            assert!(found == expected, "{plan:?}: an engine remembers an earlier system");
            assert_eq!(used.report().evaluations, fresh.report().evaluations, "{plan:?}");
        }
    }
}
