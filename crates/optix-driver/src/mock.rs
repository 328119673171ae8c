//! A driver for tests: functions of the driver's types that note what they were called with.
//!
//! Everything above the loader runs against it as against the real one, through a table of the real layout. Handles are
//! the numbers 1, 2, 3, … in order of creation. State is per thread, hence per test.

mod describe;
mod functions;

use std::cell::RefCell;
use std::ffi::c_void;
use std::ptr;
use std::sync::Arc;

use crate::context::{ContextOptions, DeviceContext};
use crate::loader::OptiX;
use crate::module::Module;
use crate::options::{ModuleOptions, PipelineOptions};
use crate::sys;
use crate::table::ABI_87;

pub use describe::describe;
pub use functions::query_function_table;

#[derive(Default)]
struct Driver {
    calls: Vec<String>,
    handles: usize,
    failure: Option<(&'static str, i32, String)>,
    log: Option<(sys::LogFunction, *mut c_void)>,
    cache_off: bool,
    cache_location: Vec<u8>,
}

thread_local!(static DRIVER: RefCell<Driver> = RefCell::default());

/// Forgets all calls, handles and failures.
pub fn reset() {
    DRIVER.set(Driver::default());
}

/// A fresh mock, loaded.
pub fn load() -> OptiX {
    reset();
    // SAFETY: the mock fills the table with functions of this module, of the types of the slots they are put into.
    unsafe { OptiX::query(query_function_table, &ABI_87) }.expect("the mock has every function")
}

/// A context of a fresh mock. No calls are noted yet.
pub fn context() -> Arc<DeviceContext> {
    reset();
    another_context()
}

/// A context beside those that the test has.
pub fn another_context() -> Arc<DeviceContext> {
    // SAFETY: the mock fills the table with its own functions, and follows no pointer to a CUDA context.
    let context = unsafe {
        let optix = OptiX::query(query_function_table, &ABI_87).expect("the mock has every function");
        DeviceContext::new(&optix, ptr::null_mut(), ContextOptions::default())
    };
    take_calls();
    context.expect("the mock makes contexts")
}

/// A module in `context`.
pub fn module(context: &Arc<DeviceContext>) -> Arc<Module> {
    Module::from_ptx(context, "", ModuleOptions::default(), &PipelineOptions::default())
        .expect("the mock accepts every source")
}

/// Makes every later call of `function` return `code` and write `log`.
pub fn fail(function: &'static str, code: i32, log: &str) {
    DRIVER.with_borrow_mut(|driver| driver.failure = Some((function, code, log.to_owned())));
}

/// The calls so far.
pub fn calls() -> Vec<String> {
    DRIVER.with_borrow(|driver| driver.calls.clone())
}

/// The calls so far, forgetting them.
pub fn take_calls() -> Vec<String> {
    DRIVER.with_borrow_mut(|driver| std::mem::take(&mut driver.calls))
}
