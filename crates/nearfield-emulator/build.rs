//! Compiles the kernels for the host, where there is a C++ compiler.

use std::{
    env,
    ffi::OsStr,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
    process::Stdio,
};

/// Where kernel sources are, and the headers of those of nearfield-kernels.
const SOURCES: [&str; 3] = ["../nearfield-kernels/cuda", "../nearfield-kernels/optix", "tests/kernels"];
const HEADERS: &str = "../nearfield-kernels/cuda/include";

fn main() {
    println!("cargo:rustc-check-cfg=cfg(host_compiler)");
    for watched in ["../nearfield-kernels", "shim", "tests/kernels", "build.rs"] {
        println!("cargo:rerun-if-changed={watched}");
    }
    println!("cargo:rerun-if-env-changed=CXX");
    if !compiler_exists() {
        println!("cargo:warning=no C++ compiler: GPU kernels cannot be emulated, and tests of them are ignored");
        return;
    }
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    let mut build = compiler();
    build.include(root.join("shim")).include(root.join(HEADERS));
    let mut modules = Vec::new();
    for folder in SOURCES {
        for source in kernels(&root.join(folder)) {
            let wrapper = out.join(format!("module_{}.cpp", modules.len()));
            write(&wrapper, &module(&source, modules.len()));
            build.file(wrapper);
            modules.push(source);
        }
    }
    let table = out.join("modules.cpp");
    write(&table, &module_table(modules.len()));
    build.file(table);
    for part in ["fault", "fiber", "machine", "launch"] {
        build.file(root.join(format!("shim/{part}.cpp")));
    }
    build.compile("nearfield_emulated_kernels");
    println!("cargo:rustc-cfg=host_compiler");
}

fn compiler() -> cc::Build {
    let mut build = cc::Build::new();
    // As on the device, products and sums are not contracted; buffers are read and written as different types.
    build.cpp(true).std("c++17").opt_level(2).warnings(false);
    for flag in ["-ffp-contract=off", "-fno-math-errno", "-fno-strict-aliasing", "-Wno-unknown-pragmas"] {
        build.flag(flag);
    }
    build
}

/// Whether there is a compiler with GNU extensions: built-ins, `__thread`.
fn compiler_exists() -> bool {
    let Ok(tool) = compiler().try_get_compiler() else { return false };
    let mut command = tool.to_command();
    command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
    !tool.is_like_msvc() && command.status().is_ok_and(|status| status.success())
}

/// The `.cu` files of a folder, in the order of their names; none where there is no such folder.
fn kernels(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut sources: Vec<_> = entries.map(|e| e.path()).filter(|p| p.extension() == Some(OsStr::new("cu"))).collect();
    sources.sort();
    sources
}

/// A kernel source in an unnamed namespace, because names of different modules must not meet.
fn module(source: &Path, number: usize) -> String {
    let name = source.file_stem().expect("it has an extension").to_string_lossy();
    format!(
        "#include \"cuda.hpp\"\n\
         static emulator::Module this_module({name:?});\n\
         namespace {{\n\
         #include {source:?}\n\
         }}\n\
         extern \"C\" const emulator::Module* nearfield_emulated_module_{number}() {{ return &this_module; }}\n"
    )
}

fn module_table(count: usize) -> String {
    let mut declarations = String::new();
    let mut table = String::new();
    for number in 0..count {
        let function = format!("nearfield_emulated_module_{number}");
        let _ = writeln!(declarations, "extern \"C\" const emulator::Module* {function}();");
        let _ = writeln!(table, "    {function},");
    }
    format!(
        "#include \"registry.hpp\"\n{declarations}\
         const emulator::Module* (*const emulator::MODULES[])() = {{\n{table}    nullptr,\n}};\n"
    )
}

fn write(path: &Path, text: &str) {
    fs::write(path, text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}
