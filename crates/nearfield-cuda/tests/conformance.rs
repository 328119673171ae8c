//! The conformance suite on the GPU engine, its kernels run by the emulator. Ignored where that was built without a C++
//! compiler.

mod emulated;

use nearfield_core::Engine;
use nearfield_cuda::CudaEngine;
use nearfield_emulator::Emulator;
use std::sync::Arc;

fn engine() -> Box<dyn Engine> {
    Box::new(CudaEngine::on(Arc::new(Emulator::new().expect("an emulator"))))
}

fn main() {
    emulated::run(nearfield_conformance::bodies().into_iter().map(|(name, body)| (name, move || body(&engine))));
}
