//! What the numbers were measured on.

use crate::energy;
use serde::{Deserialize, Serialize};
use std::{env, fs, thread};

/// The machine and what ran on it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Model of the processor, where the system tells.
    pub cpu: Option<String>,
    /// Processor cores that may be used.
    pub cores: usize,
    /// Memory, \[bytes\], where the system tells.
    pub memory: Option<u64>,
    /// Operating system and architecture.
    pub system: String,
    /// Version of the NVIDIA driver, where there is one.
    pub driver: Option<String>,
    /// Version of Nearfield.
    pub nearfield: String,
}

impl Machine {
    /// This one.
    pub fn this() -> Self {
        Self {
            cpu: field("/proc/cpuinfo", "model name"),
            cores: thread::available_parallelism().map_or(1, usize::from),
            memory: field("/proc/meminfo", "MemTotal").and_then(|text| kibibytes(&text)),
            system: format!("{} {}", env::consts::OS, env::consts::ARCH),
            driver: energy::driver_version(),
            nearfield: env!("CARGO_PKG_VERSION").into(),
        }
    }
}

/// What comes after `key:` in a file of Linux about the machine.
fn field(path: &str, key: &str) -> Option<String> {
    let text = fs::read_to_string(path).ok()?;
    let line = text.lines().find(|line| line.starts_with(key))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

fn kibibytes(text: &str) -> Option<u64> {
    Some(text.strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}
