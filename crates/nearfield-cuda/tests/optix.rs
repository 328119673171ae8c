//! OptiX in validation mode, which checks every call and launch. Ignored where there is no GPU with OptiX.

use libtest_mimic::{Arguments, Trial};
use nearfield_conformance::{cases, plans};
use nearfield_core::{Dynamics, ListKind, ListRequest, Maintenance, Plan, Quantities};
use nearfield_cuda::{CudaDevice, CudaEngine, Gpu};
use std::sync::Arc;

fn device() -> Option<CudaDevice> {
    let device = CudaDevice::new(0).ok()?;
    device.ray_tracing().is_ok().then_some(device)
}

/// Builds, refits, forces with and without energies, fused steps and lists.
fn every_ray_traced_method_runs_without_a_word(device: &Arc<CudaDevice>) {
    let mut engine = CudaEngine::on(device.clone());
    let system = cases::liquid(4, 1.0, 0.1, 2.2, 1);
    let plans: Vec<Plan> = plans::each_structure().into_iter().filter(|plan| plan.method.uses_bvh()).collect();
    let plans: Vec<Plan> = plans.into_iter().map(|plan| Plan { maintenance: Maintenance::Fixed(3), ..plan }).collect();
    for plans in [plans::deterministic(plans.clone()), plans] {
        plans::run(&mut engine, &system, &plans, |engine, plan| {
            let request = ListRequest { shifts: true, ..ListRequest::new(ListKind::Full) };
            engine.evaluate(Quantities::ALL).expect("an evaluation");
            engine.advance(&Dynamics::nve(0.004), 0, 7, Quantities::ALL).expect("a run");
            engine.neighbor_list(request).expect("a list");
            assert_eq!(device.take_ray_tracing_messages(), [""; 0], "{plan:?}");
        });
    }
}

fn main() {
    // SAFETY: no other thread runs yet.
    unsafe { std::env::set_var("NEARFIELD_OPTIX_VALIDATION", "1") };
    let arguments = Arguments::from_args();
    let device = device().map(Arc::new);
    let ignored = device.is_none();
    let test = move || {
        every_ray_traced_method_runs_without_a_word(&device.ok_or("there is no GPU with OptiX")?);
        Ok(())
    };
    let trial = Trial::test("every_ray_traced_method_runs_without_a_word", test).with_ignored_flag(ignored);
    libtest_mimic::run(&arguments, vec![trial]).exit();
}
