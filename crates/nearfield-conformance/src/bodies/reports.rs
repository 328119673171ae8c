//! What an engine says it did.

use crate::{Factory, cases, plans};
use nearfield_core::{
    Dynamics, Engine, Maintenance, Method, Plan, Quantities, Skin, System, maintenance::EnergyCounter,
};
use std::sync::{
    Arc,
    atomic::{AtomicU32, Ordering},
};

const STEPS: u64 = 23;

fn liquid() -> System {
    cases::liquid(3, 1.0, 0.05, 2.2, 1)
}

fn advance(engine: &mut dyn Engine, from: u64, steps: u64) {
    engine.advance(&Dynamics::nve(0.004), from, steps, Quantities::FORCES).expect("a run");
}

/// BVH plans whose structure is kept at each evaluation: a list with a skin lets it rest.
fn upkeep_each_step() -> Vec<Plan> {
    let plans = plans::each_structure().into_iter().map(|plan| Plan { skin: Skin::NONE, ..plan });
    plans.filter(|plan| plan.method.uses_bvh()).collect()
}

/// Whatever the policy.
pub fn a_bvh_is_built_or_refitted_at_each_evaluation(factory: Factory) {
    let policies = [Maintenance::Every, Maintenance::Fixed(3), Maintenance::Average];
    for maintenance in policies.into_iter().chain([Maintenance::Gradient, Maintenance::GradientJoules]) {
        let plans: Vec<_> = upkeep_each_step().into_iter().map(|plan| Plan { maintenance, ..plan }).collect();
        plans::run(&mut *factory(), &liquid(), &plans, |engine, plan| {
            advance(engine, 0, STEPS);
            let report = engine.report();
            assert_eq!(report.evaluations, STEPS + 1, "{plan:?}");
            assert_eq!(report.builds + report.refits, report.evaluations, "{plan:?}: {report:?}");
            assert!(report.builds >= 1 && report.forced_builds < report.builds, "{plan:?}: {report:?}");
        });
    }
}

/// Evaluations 0, 5, 10, 15 and 20 of 24; a ghost layer that is outrun may force more.
pub fn every_never_refits_and_fixed_builds_at_each_period(factory: Factory) {
    for plan in upkeep_each_step() {
        let every = Plan { maintenance: Maintenance::Every, ..plan };
        let fixed = Plan { maintenance: Maintenance::Fixed(5), ..plan };
        plans::run(&mut *factory(), &liquid(), &[every, fixed], |engine, plan| {
            advance(engine, 0, STEPS);
            let report = engine.report();
            if plan.maintenance == Maintenance::Every {
                assert_eq!((report.builds, report.refits), (STEPS + 1, 0), "{plan:?}");
            } else if report.forced_builds == 0 {
                assert_eq!(report.builds, 5, "{plan:?}");
            } else {
                assert!((5..=5 + report.forced_builds).contains(&report.builds), "{plan:?}: {report:?}");
            }
        });
    }
}

/// A list with a skin serves several evaluations, one without is built at each.
pub fn a_skin_saves_list_builds(factory: Factory) {
    for plan in plans::each_structure().into_iter().filter(|plan| plan.method.uses_list()) {
        plans::run(&mut *factory(), &liquid(), &[Plan { skin: Skin::NONE, ..plan }], |engine, plan| {
            advance(engine, 0, STEPS);
            assert_eq!(engine.report().list_builds, STEPS + 1, "{plan:?}");
        });
        plans::run(&mut *factory(), &liquid(), &[Plan { skin: Skin::Fixed(0.3), ..plan }], |engine, plan| {
            advance(engine, 0, STEPS);
            let report = engine.report();
            assert!((1..=STEPS / 3).contains(&report.list_builds), "{plan:?}: {report:?}");
            assert_eq!(report.dangerous_builds, 0, "{plan:?}");
        });
    }
}

/// A meter of constant power.
struct Readings(Arc<AtomicU32>);

impl EnergyCounter for Readings {
    fn read(&mut self) -> (f64, f64) {
        let readings = f64::from(self.0.fetch_add(1, Ordering::Relaxed));
        (100.0 * readings, readings)
    }
}

/// And the run is as with any other policy.
pub fn a_policy_that_looks_at_energy_reads_the_meter(factory: Factory) {
    let maintenance = Maintenance::GradientJoules;
    let plans: Vec<_> = upkeep_each_step().into_iter().map(|plan| Plan { maintenance, ..plan }).collect();
    plans::run(&mut *factory(), &liquid(), &plans, |engine, plan| {
        let readings = Arc::new(AtomicU32::new(0));
        engine.attach_meter(Box::new(Readings(readings.clone())));
        advance(engine, 0, STEPS);
        assert!(readings.load(Ordering::Relaxed) > 0, "{plan:?}");
        let report = engine.report();
        assert_eq!(report.builds + report.refits, STEPS + 1, "{plan:?}: {report:?}");
    });
}

/// Recording can be switched on and off at any time.
pub fn history_holds_each_evaluation_while_it_is_recorded(factory: Factory) {
    let plans = [Plan::new(Method::Cell)].into_iter().chain(upkeep_each_step()).collect::<Vec<_>>();
    plans::run(&mut *factory(), &liquid(), &plans, |engine, plan| {
        engine.record_history(true);
        advance(engine, 0, 4);
        assert_eq!(engine.report().history.len(), 5, "{plan:?}");
        engine.record_history(false);
        advance(engine, 4, 3);
        let history = engine.report().history;
        assert_eq!(history.len(), 5, "{plan:?}");
        assert!(history[0].built, "{plan:?}");
        assert!(history.iter().all(|cost| cost.structure >= 0.0 && cost.query >= 0.0), "{plan:?}");
    });
}
