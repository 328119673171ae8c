//! Runs tests that need the emulator, ignored where it was built without a C++ compiler.

use libtest_mimic::{Arguments, Trial};

/// Runs those that the command line asks for, and ends the process.
pub fn run<T: FnOnce() + Send + 'static>(tests: impl IntoIterator<Item = (&'static str, T)>) -> ! {
    let trial = |(name, test): (&'static str, T)| {
        let run = move || {
            test();
            Ok(())
        };
        Trial::test(name, run).with_ignored_flag(!nearfield_emulator::available())
    };
    libtest_mimic::run(&Arguments::from_args(), tests.into_iter().map(trial).collect()).exit()
}
