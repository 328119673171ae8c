//! Sizes beyond brute force: methods against each other.

use crate::{Factory, cases, plans};
use nearfield_core::{ListKind, ListRequest, Method, PerParticle, Quantities, oracle};

/// Neighbour counts by every structure, and pairs with their images by each method.
pub fn every_structure_finds_the_same_pairs_among_a_hundred_thousand_particles(factory: Factory) {
    let system = cases::hundred_thousand();
    let mut plans = plans::each_structure();
    plans.retain(|plan| plan.method != Method::Brute);
    let (mut counts, mut pairs) = (None, None);
    let mut listed = Vec::new();
    plans::run(&mut *factory(), &system, &plans, |engine, plan| {
        let totals = engine.evaluate(Quantities::ALL).expect("an evaluation");
        let mut found = PerParticle::default();
        engine.per_particle(&mut found).expect("a copy");
        let counted = (totals.pairs, found.neighbors);
        assert!(*counts.get_or_insert_with(|| counted.clone()) == counted, "{plan:?} counts other neighbours");
        if !listed.contains(&plan.method) {
            listed.push(plan.method);
            let request = ListRequest { shifts: true, ..ListRequest::new(ListKind::Half) };
            let found = oracle::canonical(&engine.neighbor_list(request).expect("a list"));
            assert!(*pairs.get_or_insert_with(|| found.clone()) == found, "{plan:?} finds other pairs");
        }
    });
    let (n, volume) = (system.particles.len() as f64, system.sim_box.volume());
    let mean =
        n * (n - 1.0) / 2.0 * 4.0 / 3.0 * std::f64::consts::PI * f64::from(system.radii.largest()).powi(3) / volume;
    let found = counts.map_or(0.0, |counts| counts.0 as f64);
    assert!((found - mean).abs() < 6.0 * mean.sqrt(), "{found} pairs where a uniform gas has {mean}");
}
