//! What `cargo xtask ptx` needs to know: `device_code header` prints the generated header, `device_code modules` the
//! path of each source.

use nearfield_kernels::{MODULES, RAY_MODULES, layouts};
use std::process::ExitCode;

fn main() -> ExitCode {
    match std::env::args().nth(1).as_deref() {
        Some("header") => print!("{}", layouts::header()),
        Some("modules") => {
            for (folder, modules) in [("cuda", MODULES), ("optix", RAY_MODULES)] {
                for module in modules {
                    println!("{folder}/{}.cu", module.name);
                }
            }
        }
        _ => {
            eprintln!("usage: device_code header | modules");
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}
