//! What the conformance suite cannot see of the ray-traced methods: that they save the work they should. Ignored where
//! the emulator was built without a C++ compiler.

mod emulated;

use nearfield_conformance::cases;
use nearfield_core::{Dynamics, Engine, Images, Maintenance, Method, Plan, Quantities, Report};
use nearfield_cuda::CudaEngine;
use nearfield_emulator::Emulator;
use std::sync::Arc;

const STEPS: u64 = 100;

/// A hot dense gas whose structure is built only where it must be.
fn run(plan: Plan) -> Report {
    let mut engine = CudaEngine::on(Arc::new(Emulator::new().expect("an emulator")));
    let plan = Plan { maintenance: Maintenance::Fixed(1000), ..plan };
    engine.load(&cases::liquid(4, 20.0, 0.05, 2.2, 1), &plan).expect("a load");
    engine.advance(&Dynamics::nve(0.002), 0, STEPS, Quantities::FORCES).expect("a run");
    engine.report()
}

/// A fifth of the cutoff is 25 steps of the fastest particles, 50 of most.
fn ghosts_serve_many_steps_and_are_drawn_anew_when_outrun() {
    for method in [Method::RtBoxes, Method::RtSpheres, Method::RtSquares, Method::RtForces, Method::RtPerse] {
        let report = run(Plan { images: Images::Ghosts, ..Plan::new(method) });
        assert_eq!(report.builds, 1 + report.forced_builds, "{method}: {report:?}");
        assert!((1..=STEPS / 10).contains(&report.forced_builds), "{method}: {report:?}");
    }
}

fn without_ghosts_refits_are_never_refused() {
    for method in [Method::RtBoxes, Method::RtSpheres, Method::RtSquares] {
        for images in [Images::Gamma, Images::Instances] {
            let report = run(Plan { images, ..Plan::new(method) });
            let updates = (report.builds, report.refits, report.forced_builds);
            assert_eq!(updates, (1, STEPS, 0), "{method}, {images}: {report:?}");
        }
    }
}

fn a_list_too_large_loses_its_skin_once_and_is_then_processed_in_batches() {
    let report = run(Plan { memory_budget: 20_000, ..Plan::new(Method::RtList) });
    assert_eq!((report.batched_evaluations, report.list_builds), (STEPS + 1, 0), "{report:?}");
    assert_eq!(report.builds, 2, "one with skin, one without: {report:?}");
}

fn main() {
    let tests: [(&str, fn()); 3] = [
        (
            "ghosts_serve_many_steps_and_are_drawn_anew_when_outrun",
            ghosts_serve_many_steps_and_are_drawn_anew_when_outrun,
        ),
        ("without_ghosts_refits_are_never_refused", without_ghosts_refits_are_never_refused),
        (
            "a_list_too_large_loses_its_skin_once_and_is_then_processed_in_batches",
            a_list_too_large_loses_its_skin_once_and_is_then_processed_in_batches,
        ),
    ];
    emulated::run(tests);
}
