//! The CUDA engine on a real GPU. Where there is none, every test shows as ignored.
//!
//! | tests | |
//! |---|---|
//! | `conformance::` | the suite that every engine passes |
//! | `small::` | kernels of plain CUDA on small systems, quick enough under compute-sanitizer |
//! | `neighbors::` | the pairs of 50,000 particles against the CPU engine's |
//! | `melt::` | energy and momentum over `NEARFIELD_MELT_STEPS` steps (2,000 unless said) |
//! | `checkpoints::` | runs that change between GPU and CPU |
//! | `memory::` | what does not fit |
//! | `sequences::` | work kept as CUDA graphs |

mod checkpoints;
mod melt;
mod memory;
mod neighbors;
mod sequences;
mod small;

use libtest_mimic::{Arguments, Trial};
use nearfield_conformance::plans;
use nearfield_core::{Engine, Method, Plan};
use nearfield_cuda::CudaEngine;

/// What a test needs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Needs {
    Cuda,
    RayTracing,
}

/// Tests under construction, ignored where the machine lacks what they need.
struct Trials {
    has_gpu: bool,
    has_ray_tracing: bool,
    trials: Vec<Trial>,
}

impl Trials {
    fn add(&mut self, name: impl Into<String>, needs: Needs, body: impl FnOnce() + Send + 'static) {
        let can_run = self.has_gpu && (needs == Needs::Cuda || self.has_ray_tracing);
        let trial = Trial::test(name, || {
            body();
            Ok(())
        });
        self.trials.push(trial.with_ignored_flag(!can_run));
    }

    /// A test for each plan.
    fn add_for(&mut self, name: &str, plans: Vec<Plan>, body: fn(&Plan)) {
        for plan in plans {
            let needs = if plan.method.uses_bvh() { Needs::RayTracing } else { Needs::Cuda };
            let images = if plan.method.uses_bvh() { format!("_with_{}", plan.images) } else { String::new() };
            self.add(format!("{name}_by_{}{images}", plan.method), needs, move || body(&plan));
        }
    }
}

fn main() {
    let arguments = Arguments::from_args();
    let gpu = CudaEngine::new(0).map(drop);
    if let Err(reason) = &gpu {
        eprintln!("no GPU to test: {reason}");
    }
    let ray_tracing = nearfield_cuda::devices()
        .is_ok_and(|devices| devices.iter().any(|device| device.ordinal == 0 && device.ray_tracing.is_ok()));
    let mut trials = Trials { has_gpu: gpu.is_ok(), has_ray_tracing: ray_tracing, trials: Vec::new() };
    for (name, body) in nearfield_conformance::bodies() {
        trials.add(format!("conformance::{name}"), Needs::Cuda, move || body(&|| Box::new(engine())));
    }
    let plain = || plans::every().into_iter().filter(|plan| !plan.method.uses_bvh()).collect::<Vec<_>>();
    for plan in plain() {
        let name = format!("small::lists_and_motion_by_{}_in_order_{}", plan.method, plan.order);
        trials.add(name, Needs::Cuda, move || small::lists_and_motion(&plan));
    }
    trials.add_for(
        "neighbors::pairs_are_those_of_the_cpu",
        plans::each_structure(),
        neighbors::pairs_are_those_of_the_cpu,
    );
    let queries = "neighbors::queries_are_answered_as_by_the_cpu";
    trials.add(queries, Needs::Cuda, neighbors::queries_are_answered_as_by_the_cpu);
    let rays = plans::each_structure().into_iter().filter(|plan| plan.method.uses_bvh());
    trials.add_for(
        "neighbors::a_million_particles_have_the_pairs_that_cells_find",
        rays.collect(),
        neighbors::a_million_particles_have_the_pairs_that_cells_find,
    );
    trials.add_for(
        "melt::energy_and_momentum_are_conserved",
        plans::each_method(),
        melt::energy_and_momentum_are_conserved,
    );
    trials.add_for("checkpoints::a_run_goes_on_from_gpu_to_cpu", plans::each_method(), checkpoints::from_gpu_to_cpu);
    trials.add_for("checkpoints::a_run_goes_on_from_cpu_to_gpu", plans::each_method(), checkpoints::from_cpu_to_gpu);
    let cell = vec![Plan::new(Method::Cell)];
    trials.add_for("memory::a_list_that_does_not_fit_is_an_error", cell, memory::a_list_that_does_not_fit_is_an_error);
    trials.add(
        "sequences::a_sequence_that_comes_again_is_kept_as_a_graph",
        Needs::Cuda,
        sequences::a_sequence_that_comes_again_is_kept_as_a_graph,
    );
    libtest_mimic::run(&arguments, trials.trials).exit();
}

/// The engine under test.
fn engine() -> CudaEngine {
    CudaEngine::new(0).unwrap_or_else(|error| panic!("{error}"))
}

/// The engine with a system loaded; `None` where the plan's method cannot treat it.
fn loaded(system: &nearfield_core::System, plan: &Plan) -> Option<CudaEngine> {
    if !plan.method.supports_variable_radii() && !system.radii.is_uniform() {
        return None;
    }
    let mut engine = engine();
    engine.load(system, plan).unwrap_or_else(|error| panic!("{plan:?}: {error}"));
    Some(engine)
}
