//! Project tasks: `cargo xtask ci` runs everything that must pass before a change is merged, `cargo xtask STEP` one
//! step of it.
//!
//! Every step that compiles uses the release profile: dependencies are then compiled once for all of them, and the
//! kernels, which take a minute, once for tests and the smoke run.

mod aarch64;
mod checks;
mod command;
mod gpu_test;
mod ptx;

use std::{env, process::ExitCode, time::Instant};

/// A step by name.
struct Step {
    name: &'static str,
    about: &'static str,
    /// Arguments in `ci`; none for steps that are no part of it.
    ci: Option<&'static [&'static str]>,
    run: Run,
}

enum Run {
    /// Takes no arguments.
    Plain(fn() -> Result<(), String>),
    /// Takes those typed after its name.
    With(fn(&[&str]) -> Result<(), String>),
}

use Run::{Plain, With};

/// In the order in which mistakes are cheapest to find.
const STEPS: &[Step] = &[
    Step { name: "fmt", about: "formatting", ci: Some(&[]), run: Plain(checks::fmt) },
    Step { name: "typos", about: "spelling (where typos is installed)", ci: Some(&[]), run: Plain(checks::typos) },
    Step {
        name: "deny",
        about: "dependencies (where cargo-deny is installed)",
        ci: Some(&[]),
        run: Plain(checks::deny),
    },
    Step { name: "ptx", about: ptx::ABOUT, ci: Some(&["--check"]), run: With(ptx::run) },
    Step { name: "clippy", about: "lints, warnings denied", ci: Some(&[]), run: Plain(checks::clippy) },
    Step { name: "doc", about: "documentation, warnings denied", ci: Some(&[]), run: Plain(checks::doc) },
    Step { name: "test", about: "all tests", ci: Some(&[]), run: Plain(checks::test) },
    Step { name: "aarch64", about: aarch64::ABOUT, ci: Some(&[]), run: Plain(aarch64::run_step) },
    Step { name: "smoke", about: "a short run of the melt example", ci: Some(&[]), run: Plain(checks::smoke) },
    Step { name: "gpu-test", about: "a bundle for a machine with a GPU", ci: None, run: Plain(gpu_test::run_step) },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let steps: Vec<(&Step, &[&str])> = match &arguments[..] {
        ["ci"] => STEPS.iter().filter_map(|step| Some((step, step.ci?))).collect(),
        [name, rest @ ..] => STEPS.iter().filter(|step| step.name == *name).map(|step| (step, rest)).collect(),
        [] => Vec::new(),
    };
    if steps.is_empty() {
        eprintln!("usage: cargo xtask ci | STEP, where STEP is one of");
        for step in STEPS {
            eprintln!("  {:<8} {}", step.name, step.about);
        }
        return ExitCode::from(2);
    }
    for (step, arguments) in steps {
        println!("== {}", [&[step.name], arguments].concat().join(" "));
        let start = Instant::now();
        let outcome = match step.run {
            Plain(run) if arguments.is_empty() => run(),
            Plain(_) => Err(format!("unknown arguments {}", arguments.join(" "))),
            With(run) => run(arguments),
        };
        if let Err(reason) = outcome {
            eprintln!("== {} failed: {reason}", step.name);
            return ExitCode::FAILURE;
        }
        println!("== {}: {:.0} s", step.name, start.elapsed().as_secs_f64());
    }
    ExitCode::SUCCESS
}
