//! The conformance suite on the CPU engine.

nearfield_conformance::engine_tests!(cpu, nearfield_cpu::CpuEngine::new());
