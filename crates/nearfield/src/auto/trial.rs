//! A few steps of a method on the device, from a state that is not changed by it.

use nearfield_core::{Dynamics, Engine, Plan, Quantities, Result, System};
use std::time::Instant;

/// Steps that warm up: the first also evaluates the forces at the start, and compiles programs on a GPU.
const WARM_UP: u64 = 2;
/// Fewest steps measured: a list or a structure lives about so long.
const STEPS: u64 = 16;
/// Fewest seconds measured, where a step takes less than a quarter of a millisecond.
const SECONDS: f64 = 0.004;

/// Seconds that a trial of a method takes, given those of a step.
pub(super) fn duration(seconds_of_step: f64) -> f64 {
    SECONDS + (WARM_UP + 1 + STEPS) as f64 * seconds_of_step
}

/// Seconds of a step by a plan, of a system that is at step `from`.
pub(super) fn seconds_of_step(
    engine: &mut dyn Engine,
    system: &System,
    dynamics: &Dynamics,
    from: u64,
    plan: &Plan,
) -> Result<f64> {
    engine.load(system, plan)?;
    engine.advance(dynamics, from, WARM_UP, Quantities::FORCES)?;
    let (mut done, mut chunk) = (0, STEPS);
    let start = Instant::now();
    loop {
        engine.advance(dynamics, from + WARM_UP + done, chunk, Quantities::FORCES)?;
        done += chunk;
        let seconds = start.elapsed().as_secs_f64();
        if seconds >= SECONDS {
            return Ok(seconds / done as f64);
        }
        // Doubling, as longer chunks wait for the device less often.
        chunk = done;
    }
}
