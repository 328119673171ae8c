//! 64-bit ARM: lints of everything, and the tests of the vector kernels in an emulator.

use crate::command::{cargo_command, is_installed, output, run};
use std::{env::consts::ARCH, path::Path, process::Command};

pub const ABOUT: &str = "lints for aarch64 and tests of its kernels (where its compiler, and qemu, are installed)";

const TARGET: &str = "aarch64-unknown-linux-gnu";

/// Where Debian's cross compiler has the C library.
const SYSTEM: &str = "/usr/aarch64-linux-gnu";

const LINKER: &str = "aarch64-linux-gnu-gcc";
const EMULATOR: &str = "qemu-aarch64";

pub fn run_step() -> Result<(), String> {
    if ARCH == "aarch64" {
        println!("skipped: this machine is one, the other steps are for it");
        return Ok(());
    }
    let library = output(Command::new("rustc").args(["--print", "target-libdir", "--target", TARGET]))?;
    if !Path::new(library.trim()).is_dir() {
        println!("skipped: install it with `rustup target add {TARGET}`");
        return Ok(());
    }
    let lints = ["clippy", "--locked", "--workspace", "--all-targets", "--release", "--target", TARGET];
    run(cargo_command(&lints).args(["--", "--deny", "warnings"]))?;
    if !is_installed(LINKER) || !is_installed(EMULATOR) || !Path::new(SYSTEM).is_dir() {
        println!("tests skipped: install {LINKER} and {EMULATOR} (Debian: gcc-aarch64-linux-gnu qemu-user)");
        return Ok(());
    }
    // The other tests take half an hour in an emulator.
    let tests = ["test", "--locked", "--release", "--target", TARGET, "--package", "nearfield-cpu", "--lib"];
    run(cargo_command(&tests)
        .args(["--", "lanes", "cluster", "grid::"])
        .env("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER", LINKER)
        .env("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER", format!("{EMULATOR} -L {SYSTEM}")))
}
