//! `cargo xtask gpu-test`: a folder that tests and measures Nearfield on a machine with a GPU but without Rust.
//!
//! `target/gpu-test` gets the command, the tests of nearfield-cuda, its benchmarks, and `run.sh`, which runs them and
//! writes `summary.json`. Copy the folder to the machine and call `run.sh OUTPUT` there.

use crate::command::{cargo_command, output, root, run, target};
use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// Bundles are copied around: they should stay small.
const LARGEST: u64 = 50 << 20;

pub fn run_step() -> Result<(), String> {
    let folder = target().join("gpu-test");
    // Nothing to remove the first time.
    let _ = fs::remove_dir_all(&folder);
    let bin = folder.join("bin");
    fs::create_dir_all(&bin).map_err(|error| format!("{}: {error}", bin.display()))?;
    let mut total = 0;
    for (name, executable) in executables()? {
        let path = bin.join(name);
        let mut strip = Command::new("strip");
        run(strip.arg("-o").arg(&path).arg(&executable))?;
        let size = path.metadata().map_err(|error| format!("{}: {error}", path.display()))?.len();
        println!("{} {:.1} MB", path.display(), size as f64 / 1e6);
        total += size;
    }
    copy(&root().join("xtask/gpu-test/run.sh"), &folder.join("run.sh"))?;
    copy(&root().join("examples/melt.toml"), &folder.join("melt.toml"))?;
    if total > LARGEST {
        return Err(format!("the bundle has {total} bytes, more than {LARGEST}"));
    }
    println!("copy {} to a machine with an NVIDIA driver and run ./run.sh OUTPUT there", folder.display());
    Ok(())
}

/// Builds what goes into the bundle, with the names it gets there.
fn executables() -> Result<Vec<(String, PathBuf)>, String> {
    let mut found = build(&["build", "--package", "nearfield-cli"], "bin")?;
    found.extend(build(&["test", "--no-run", "--package", "nearfield-cuda", "--test", "gpu"], "test")?);
    let benches = build(&["bench", "--no-run", "--package", "nearfield-cuda", "--benches"], "bench")?;
    found.extend(benches.into_iter().map(|(name, path)| (format!("bench-{name}"), path)));
    Ok(found)
}

/// The executables of a kind that a cargo command makes.
fn build(arguments: &[&str], kind: &str) -> Result<Vec<(String, PathBuf)>, String> {
    let mut command = cargo_command(arguments);
    command.args(["--locked", "--message-format", "json-render-diagnostics"]);
    if arguments[0] != "bench" {
        command.arg("--release");
    }
    let mut found = Vec::new();
    for line in output(&mut command)?.lines() {
        let message: Value = serde_json::from_str(line).map_err(|error| format!("cargo says {line}: {error}"))?;
        let target = &message["target"];
        if let (Some(name), Some(path)) = (target["name"].as_str(), message["executable"].as_str())
            && target["kind"][0] == kind
        {
            found.push((name.to_owned(), PathBuf::from(path)));
        }
    }
    Ok(found)
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    fs::copy(from, to).map(drop).map_err(|error| format!("{} to {}: {error}", from.display(), to.display()))
}
