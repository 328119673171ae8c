//! PTX to machine code by ptxas: whether it can be done, and the resources each kernel needs.

use super::{Source, Target, Tools};
use crate::command::target;
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    thread,
};

/// From Turing to Blackwell.
pub const ARCHITECTURES: [&str; 7] = ["75", "80", "86", "89", "90", "100", "120"];

/// The assembler.
pub struct Assembler<'a> {
    ptxas: &'a Path,
    folder: PathBuf,
}

/// What a kernel needs.
#[derive(Debug, PartialEq, Eq)]
pub struct Kernel {
    pub name: String,
    /// Per thread.
    pub registers: u32,
    /// Stored and loaded bytes per thread.
    pub spills: u32,
    /// Bytes per thread.
    pub stack: u32,
    /// Bytes per block.
    pub shared: u32,
}

impl<'a> Assembler<'a> {
    /// An assembler that keeps its intermediate files in `target/ptx`.
    pub fn new(tools: &'a Tools) -> Result<Self, String> {
        let folder = target().join("ptx");
        fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        Ok(Self { ptxas: &tools.ptxas, folder })
    }

    /// Assembles for each of [`ARCHITECTURES`] from the target on.
    pub fn assemble_for_all(&self, source: &Source, target: Target, ptx: &str) -> Result<(), String> {
        let input = &self.input(source, target, ptx)?;
        let first = ARCHITECTURES.iter().position(|&architecture| architecture == target.0).unwrap_or(0);
        thread::scope(|scope| {
            let run = |&architecture| scope.spawn(move || self.ptxas(input, architecture));
            let runs: Vec<_> = ARCHITECTURES[first..].iter().map(run).collect();
            runs.into_iter().try_for_each(|run| run.join().expect("threads only run ptxas").map(drop))
        })
    }

    /// What each kernel of a module needs.
    pub fn resources(&self, source: &Source, target: Target, ptx: &str, on: &str) -> Result<Vec<Kernel>, String> {
        Ok(parse_resources(&self.ptxas(&self.input(source, target, ptx)?, on)?))
    }

    fn input(&self, source: &Source, target: Target, ptx: &str) -> Result<PathBuf, String> {
        let path = self.folder.join(format!("{}.ptx", source.ptx_name(target)));
        let text = if source.is_optix() { without_optix_calls(ptx)? } else { ptx.to_owned() };
        fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(path)
    }

    /// Gives ptxas' messages.
    fn ptxas(&self, input: &Path, architecture: &str) -> Result<String, String> {
        let mut command = Command::new(self.ptxas);
        command.arg("--verbose").arg(format!("--gpu-name=sm_{architecture}")).arg(input);
        let output =
            command.arg("--output-file").arg(input.with_extension(format!("sm_{architecture}.cubin"))).output();
        let output = output.map_err(|error| format!("{}: {error}", self.ptxas.display()))?;
        let messages = [output.stdout, output.stderr].concat();
        let messages = String::from_utf8_lossy(&messages).into_owned();
        if !output.status.success() {
            return Err(format!("{} does not assemble for sm_{architecture}:\n{messages}", input.display()));
        }
        Ok(messages)
    }
}

/// PTX that ptxas can judge: functions that OptiX defines are unknown to it, so each call of one becomes moves of zero
/// to its results.
fn without_optix_calls(ptx: &str) -> Result<String, String> {
    let mut text = String::with_capacity(ptx.len());
    for line in ptx.lines() {
        let call = line.trim().strip_prefix("call").filter(|call| call.contains("_optix_"));
        let Some(call) = call else {
            text.push_str(line);
            text.push('\n');
            continue;
        };
        if !call.ends_with(';') {
            return Err(format!("a call of OptiX goes over several lines: {line}"));
        }
        let results = call.trim_start().strip_prefix('(').and_then(|rest| rest.split_once(')')).map_or("", |(r, _)| r);
        for result in results.split(',').map(str::trim).filter(|result| !result.is_empty()) {
            let is_wide = result.starts_with("%rd") || result.starts_with("%fd");
            text.push_str(&format!("\tmov.b{} {result}, 0;\n", if is_wide { 64 } else { 32 }));
        }
    }
    Ok(text)
}

/// Reads what `ptxas --verbose` says of each entry function.
fn parse_resources(messages: &str) -> Vec<Kernel> {
    let mut kernels: Vec<Kernel> = Vec::new();
    for line in messages.lines() {
        if let Some((_, rest)) = line.split_once("Compiling entry function '") {
            let name = rest.split('\'').next().unwrap_or_default().to_owned();
            kernels.push(Kernel { name, registers: 0, spills: 0, stack: 0, shared: 0 });
        } else if let Some(kernel) = kernels.last_mut() {
            kernel.stack = number_before(line, " bytes stack frame").unwrap_or(kernel.stack);
            kernel.spills += number_before(line, " bytes spill stores").unwrap_or(0);
            kernel.spills += number_before(line, " bytes spill loads").unwrap_or(0);
            kernel.registers = number_before(line, " registers").unwrap_or(kernel.registers);
            kernel.shared = number_before(line, " bytes smem").unwrap_or(kernel.shared);
        }
    }
    kernels
}

fn number_before(line: &str, words: &str) -> Option<u32> {
    let (before, _) = line.split_once(words)?;
    before.rsplit(|character: char| !character.is_ascii_digit()).next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_of_optix_become_moves_and_others_stay() {
        let ptx =
            "\tcall (%r1, %f2,%rd3), _optix_x, (%r4);\n\tcall _optix_set_payload, (%r1, %r2);\n\tcall (%r1), f, ();\n";
        let expected = "\tmov.b32 %r1, 0;\n\tmov.b32 %f2, 0;\n\tmov.b64 %rd3, 0;\n\tcall (%r1), f, ();\n";
        assert_eq!(without_optix_calls(ptx).unwrap(), expected);
        assert!(without_optix_calls("call (%r1),\n").is_ok());
        assert!(without_optix_calls("call (%r1), _optix_x,\n (%r2);").is_err());
    }

    #[test]
    fn resources_are_read_kernel_by_kernel() {
        let messages = "ptxas info    : Compiling entry function 'a' for 'sm_90'\n\
            ptxas info    : Function properties for a\n\
            \x20   16 bytes stack frame, 4 bytes spill stores, 8 bytes spill loads\n\
            ptxas info    : Used 40 registers, used 1 barriers, 16 bytes cumulative stack size, 2048 bytes smem\n\
            ptxas info    : Compiling entry function 'b' for 'sm_90'\n\
            ptxas info    : Function properties for b\n\
            \x20   0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads\n\
            ptxas info    : Used 12 registers, 400 bytes cmem[0]\n";
        let a = Kernel { name: "a".into(), registers: 40, spills: 12, stack: 16, shared: 2048 };
        let b = Kernel { name: "b".into(), registers: 12, spills: 0, stack: 0, shared: 0 };
        assert_eq!(parse_resources(messages), [a, b]);
    }
}
