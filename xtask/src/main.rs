//! Project tasks: `cargo xtask ci` runs everything that must pass before a change is merged, `cargo xtask STEP` one
//! step of it.
//!
//! Every step that compiles uses the release profile: dependencies are then compiled once for all of them, and the
//! kernels, which take a minute, once for tests and the smoke run.

use std::{
    env,
    process::{Command, ExitCode, Stdio},
    time::Instant,
};

/// A step by name.
struct Step {
    name: &'static str,
    about: &'static str,
    run: fn() -> Result<(), String>,
}

/// In the order in which mistakes are cheapest to find.
const STEPS: &[Step] = &[
    Step { name: "fmt", about: "formatting", run: fmt },
    Step { name: "typos", about: "spelling (where typos is installed)", run: typos },
    Step { name: "deny", about: "dependencies (where cargo-deny is installed)", run: deny },
    Step { name: "clippy", about: "lints, warnings denied", run: clippy },
    Step { name: "doc", about: "documentation, warnings denied", run: doc },
    Step { name: "test", about: "all tests", run: test },
    Step { name: "smoke", about: "a short run of the melt example", run: smoke },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let names: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let steps: Vec<&Step> = match names[..] {
        ["ci"] => STEPS.iter().collect(),
        [name] => STEPS.iter().filter(|step| step.name == name).collect(),
        _ => Vec::new(),
    };
    if steps.is_empty() {
        eprintln!("usage: cargo xtask ci | STEP, where STEP is one of");
        for step in STEPS {
            eprintln!("  {:<8} {}", step.name, step.about);
        }
        return ExitCode::from(2);
    }
    for step in steps {
        println!("== {}: {}", step.name, step.about);
        let start = Instant::now();
        if let Err(reason) = (step.run)() {
            eprintln!("== {} failed: {reason}", step.name);
            return ExitCode::FAILURE;
        }
        println!("== {}: {:.0} s", step.name, start.elapsed().as_secs_f64());
    }
    ExitCode::SUCCESS
}

fn fmt() -> Result<(), String> {
    cargo(&["fmt", "--all", "--check"])
}

fn typos() -> Result<(), String> {
    if !is_installed("typos") {
        println!("skipped: install it with `cargo install typos-cli --locked`");
        return Ok(());
    }
    run(&mut Command::new("typos"))
}

/// Advisories are left out: they need a database from the network, and change without a change here.
fn deny() -> Result<(), String> {
    if !is_installed("cargo-deny") {
        println!("skipped: install it with `cargo install cargo-deny --locked`");
        return Ok(());
    }
    cargo(&["deny", "--locked", "check", "licenses", "bans", "sources"])
}

fn clippy() -> Result<(), String> {
    cargo(&["clippy", "--locked", "--workspace", "--all-targets", "--release", "--", "--deny", "warnings"])
}

fn doc() -> Result<(), String> {
    let arguments = ["doc", "--locked", "--workspace", "--no-deps", "--release"];
    run(cargo_command(&arguments).env("RUSTDOCFLAGS", "--deny warnings"))
}

/// The test command of the README.
fn test() -> Result<(), String> {
    cargo(&["test", "--workspace", "--release"])
}

/// The run command of the README with fewer steps, into a directory that is removed.
fn smoke() -> Result<(), String> {
    let output = env::temp_dir().join(format!("nearfield-smoke-{}", std::process::id()));
    let directory = output.to_str().ok_or("the temporary directory has no UTF-8 name")?;
    let arguments = ["run", "--release", "--", "run", "examples/melt.toml", "--steps", "100", "--output", directory];
    let outcome = cargo(&arguments).and_then(|()| {
        ["run.json", "thermo.csv", "trajectory.xyz", "checkpoint.nearfield"]
            .into_iter()
            .find(|file| !output.join(file).is_file())
            .map_or(Ok(()), |file| Err(format!("the run wrote no {file}")))
    });
    // Nothing to remove when the run failed early.
    let _ = std::fs::remove_dir_all(&output);
    outcome
}

fn cargo(arguments: &[&str]) -> Result<(), String> {
    run(&mut cargo_command(arguments))
}

/// The cargo that runs this program.
fn cargo_command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments).current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    command
}

fn run(command: &mut Command) -> Result<(), String> {
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?}: {status}")),
        Err(error) => Err(format!("{command:?}: {error}")),
    }
}

fn is_installed(program: &str) -> bool {
    Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
}
