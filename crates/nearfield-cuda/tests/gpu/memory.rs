//! What does not fit into the memory of the device.

use crate::loaded;
use nearfield_conformance::cases;
use nearfield_core::{Boundary, Engine, Error, ListKind, ListRequest, Plan, Quantities, Radii};

/// Every particle is every other's neighbour: their indices need 360 GB, more than any GPU has. The error says how much
/// is needed and free, and the engine goes on.
pub fn a_list_that_does_not_fit_is_an_error(plan: &Plan) {
    let n = 300_000;
    let sim_box = cases::cube(1.0, [Boundary::Open; 3]);
    let system = cases::soft(sim_box, cases::uniform(n, &sim_box, 1), Radii::Uniform(2.0));
    let mut engine = loaded(&system, plan).expect("one cutoff suits any method");
    let total = nearfield_cuda::devices().expect("there is a device")[0].memory;
    match engine.neighbor_list(ListRequest::new(ListKind::Full)) {
        Err(error @ Error::OutOfMemory { needed, available, .. }) => {
            let entries = (n * (n - 1)) as u64;
            assert!(needed >= 4 * entries, "{error}");
            assert!(available > 0 && available <= total, "{error}, which has {total}");
        }
        Err(other) => panic!("{other}"),
        Ok(list) => panic!("a list of {} entries", list.n_entries()),
    }
    let few = cases::soft(sim_box, cases::uniform(100, &sim_box, 1), Radii::Uniform(2.0));
    engine.load(&few, plan).expect("it fits");
    assert_eq!(engine.evaluate(Quantities::ALL).expect("an evaluation").pairs, 100 * 99 / 2);
}
