//! The steps that check the workspace as a whole.

use crate::command::{cargo, cargo_command, is_installed, run};
use std::{env, process::Command};

pub fn fmt() -> Result<(), String> {
    cargo(&["fmt", "--all", "--check"])
}

pub fn typos() -> Result<(), String> {
    if !is_installed("typos") {
        println!("skipped: install it with `cargo install typos-cli --locked`");
        return Ok(());
    }
    run(&mut Command::new("typos"))
}

/// Advisories are left out: they need a database from the network, and change without a change here.
pub fn deny() -> Result<(), String> {
    if !is_installed("cargo-deny") {
        println!("skipped: install it with `cargo install cargo-deny --locked`");
        return Ok(());
    }
    cargo(&["deny", "--locked", "check", "licenses", "bans", "sources"])
}

pub fn clippy() -> Result<(), String> {
    cargo(&["clippy", "--locked", "--workspace", "--all-targets", "--release", "--", "--deny", "warnings"])
}

pub fn doc() -> Result<(), String> {
    let arguments = ["doc", "--locked", "--workspace", "--no-deps", "--release"];
    run(cargo_command(&arguments).env("RUSTDOCFLAGS", "--deny warnings"))
}

/// The test command of the README.
pub fn test() -> Result<(), String> {
    cargo(&["test", "--workspace", "--release"])
}

/// The run command of the README with fewer steps, into a directory that is removed.
pub fn smoke() -> Result<(), String> {
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
