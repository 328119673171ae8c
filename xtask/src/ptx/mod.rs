//! `cargo xtask ptx`: the generated header and the PTX of nearfield-kernels.
//!
//! - `cargo xtask ptx` writes `cuda/include/layouts.cuh`, then compiles each `cuda/*.cu` and `optix/*.cu` to
//!   `ptx/*.ptx`. To add a module: write its source, list it in `src/modules.rs`, run this. The crate includes its PTX
//!   files and would not compile without the new one, so an empty one is made first.
//! - `cargo xtask ptx --check` changes nothing: it names each committed file that this would change, and assembles all
//!   of them for every architecture.
//! - `cargo xtask ptx --registers [90]` changes nothing: registers, spills and memory of each kernel, as its source is
//!   now, on the architecture sm_90.
//!
//! The compiler comes from PyPI in fixed versions (see [`tools`]). Its output depends on source and version only, so
//! the files can be compared byte by byte.

mod assemble;
mod nvrtc;
mod sources;
mod tools;

use crate::command::{cargo_command, output};
use assemble::Assembler;
use sources::{Source, Target};
use std::{fs, path::Path};
use tools::Tools;

pub const ABOUT: &str = "device code: writes layouts.cuh and PTX; --check compares, --registers [ARCH] lists";

/// Contraction to fused multiply-adds is off because host and device must round alike.
const OPTIONS: [&str; 2] = ["--std=c++17", "--fmad=false"];

pub fn run(arguments: &[&str]) -> Result<(), String> {
    match arguments {
        [] => write(),
        ["--check"] => check(),
        ["--registers"] => registers("90"),
        ["--registers", architecture] => registers(architecture.trim_start_matches("sm_")),
        _ => Err("usage: cargo xtask ptx [--check | --registers [ARCH]]".into()),
    }
}

fn write() -> Result<(), String> {
    let tools = Tools::fetch()?;
    let sources = sources::all()?;
    for file in outputs(&sources).map(|(source, target)| source.ptx_file(target)) {
        if !file.exists() {
            write_file(&file, "")?;
        }
    }
    write_file(&sources::layouts_file(), &describe("header")?)?;
    for (source, target) in outputs(&sources) {
        write_file(&source.ptx_file(target), &compile(&tools, source, target)?)?;
    }
    check_modules(&sources)
}

fn check() -> Result<(), String> {
    let tools = Tools::fetch()?;
    let sources = sources::all()?;
    check_modules(&sources)?;
    let mut stale = Vec::new();
    if read_file(&sources::layouts_file())? != describe("header")? {
        stale.push(sources::layouts_file());
    }
    for (source, target) in outputs(&sources) {
        if read_file(&source.ptx_file(target))? != compile(&tools, source, target)? {
            stale.push(source.ptx_file(target));
        }
    }
    if !stale.is_empty() {
        let names: Vec<String> = stale.iter().map(|file| file.display().to_string()).collect();
        return Err(format!("not what its source gives: {}; run `cargo xtask ptx`", names.join(", ")));
    }
    let assembler = Assembler::new(&tools)?;
    for (source, target) in outputs(&sources) {
        assembler.assemble_for_all(source, target, &read_file(&source.ptx_file(target))?)?;
    }
    println!("{} files are up to date and assemble for sm_{}", sources.len(), assemble::ARCHITECTURES.join(", "));
    Ok(())
}

fn registers(architecture: &str) -> Result<(), String> {
    let tools = Tools::fetch()?;
    let assembler = Assembler::new(&tools)?;
    println!("{:<48} {:>9} {:>6} {:>6} {:>6}", "", "registers", "spills", "stack", "shared");
    for source in &sources::all()? {
        // Target and architecture are numbers of two or three digits.
        let number = |text: &str| text.parse().unwrap_or(u32::MAX);
        let runs = |target: &Target| number(target.0) <= number(architecture);
        let target = source.targets().into_iter().rfind(runs).ok_or("no source is compiled for that architecture")?;
        for kernel in assembler.resources(source, target, &compile(&tools, source, target)?, architecture)? {
            let name = format!("{}: {}", source.name, kernel.name);
            let assemble::Kernel { registers, spills, stack, shared, .. } = kernel;
            println!("{name:<48} {registers:>9} {spills:>6} {stack:>6} {shared:>6}");
        }
    }
    Ok(())
}

/// Each source with each of its targets.
fn outputs(sources: &[Source]) -> impl Iterator<Item = (&Source, Target)> {
    sources.iter().flat_map(|source| source.targets().into_iter().map(move |target| (source, target)))
}

fn compile(tools: &Tools, source: &Source, target: Target) -> Result<String, String> {
    let architecture = format!("--gpu-architecture=compute_{}", target.0);
    let include = format!("-I{}", sources::include_folder().display());
    let options: Vec<&str> = OPTIONS.into_iter().chain([architecture.as_str(), include.as_str()]).collect();
    // The bare file name: the PTX must not depend on where the workspace lies.
    tools.nvrtc.compile(&format!("{}.cu", source.name), &read_file(&source.file)?, &options)
}

/// What the crate itself says, by its example `device_code`.
fn describe(what: &str) -> Result<String, String> {
    let example = ["run", "--quiet", "--release", "--package", "nearfield-kernels", "--example", "device_code", what];
    output(&mut cargo_command(&example))
}

/// Whether `src/modules.rs` lists each source where it belongs, and nothing else; whether PTX is left of a removed one.
fn check_modules(sources: &[Source]) -> Result<(), String> {
    let text = describe("modules")?;
    let listed: Vec<&str> = text.lines().collect();
    let found: Vec<String> = sources.iter().map(Source::path).collect();
    let missing = found.iter().find(|path| !listed.contains(&path.as_str()));
    let superfluous = listed.iter().find(|path| !found.iter().any(|other| other == *path));
    match (missing, superfluous) {
        (Some(path), _) => Err(format!("{path} is not listed in nearfield-kernels/src/modules.rs")),
        (_, Some(path)) => Err(format!("nearfield-kernels/src/modules.rs lists {path}, which does not exist")),
        (None, None) if listed.len() != found.len() => {
            Err("nearfield-kernels/src/modules.rs lists a file twice".into())
        }
        (None, None) => match sources::orphans(sources)?.first() {
            Some(orphan) => Err(format!("{} has no source", orphan.display())),
            None => Ok(()),
        },
    }
}

fn read_file(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// Writes a file where that changes it.
fn write_file(path: &Path, text: &str) -> Result<(), String> {
    if fs::read_to_string(path).is_ok_and(|present| present == text) {
        return Ok(());
    }
    println!("{} {}", if text.is_empty() { "new" } else { "writing" }, path.display());
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}
