//! The conformance suite on the GPU engine, its kernels run by the emulator. Ignored where that was built without a C++
//! compiler.

use libtest_mimic::{Arguments, Trial};
use nearfield_core::Engine;
use nearfield_cuda::CudaEngine;
use nearfield_emulator::Emulator;
use std::sync::Arc;

fn engine() -> Box<dyn Engine> {
    Box::new(CudaEngine::on(Arc::new(Emulator::new().expect("an emulator"))))
}

fn main() {
    let arguments = Arguments::from_args();
    let trials = nearfield_conformance::bodies().into_iter().map(|(name, body)| {
        let test = move || {
            body(&engine);
            Ok(())
        };
        Trial::test(name, test).with_ignored_flag(!nearfield_emulator::available())
    });
    libtest_mimic::run(&arguments, trials.collect()).exit();
}
