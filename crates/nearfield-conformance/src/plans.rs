//! The plans a body goes through.

use nearfield_core::{Engine, Images, Method, Order, Plan, System};

/// Every method, BVH methods with every treatment of images, each in every memory order.
pub fn every() -> Vec<Plan> {
    let mut plans = Vec::new();
    for plan in each_structure() {
        plans.extend(Order::ALL.iter().map(|&order| Plan { order, ..plan }));
    }
    plans
}

/// Every method, BVH methods with every treatment of images.
pub fn each_structure() -> Vec<Plan> {
    let mut plans = Vec::new();
    for plan in each_method() {
        let images = if plan.method.uses_bvh() { Images::ALL } else { &[Images::Gamma] };
        plans.extend(images.iter().map(|&images| Plan { images, ..plan }));
    }
    plans
}

/// Every method, the other choices by default.
pub fn each_method() -> Vec<Plan> {
    Method::ALL.iter().map(|&method| Plan::new(method)).collect()
}

/// The same plans with sums independent of order.
pub fn deterministic(plans: Vec<Plan>) -> Vec<Plan> {
    plans.into_iter().map(|plan| Plan { deterministic: true, ..plan }).collect()
}

/// Loads the system by each of the plans that the engine supports and hands the engine to the body.
///
/// # Panics
/// When none is supported: a body that ran nothing has shown nothing.
pub fn run(engine: &mut dyn Engine, system: &System, plans: &[Plan], mut body: impl FnMut(&mut dyn Engine, &Plan)) {
    let mut ran = 0;
    for plan in plans {
        if engine.supports(system, plan).is_ok() {
            engine.load(system, plan).unwrap_or_else(|error| panic!("{plan:?}: {error}"));
            body(engine, plan);
            ran += 1;
        }
    }
    assert!(ran > 0, "the engine supports none of the plans");
}
