//! The compiler and the assembler: NVRTC 12.2, whose PTX 8.2 every driver from R535 on takes, and ptxas 12.9, which
//! knows every architecture.
//!
//! pip fetches their wheels by hash (`ptx-requirements.txt`) into `target/ptx-tools`, where they stay. The hashes are
//! those of the x86-64 wheels for Linux.

use super::nvrtc::Nvrtc;
use crate::command::{root, run, target};
use std::{fs, path::PathBuf, process::Command};

/// Both, ready for use.
pub struct Tools {
    pub nvrtc: Nvrtc,
    pub ptxas: PathBuf,
}

impl Tools {
    /// Those of `target/ptx-tools`, fetched where they are missing or of other versions.
    pub fn fetch() -> Result<Self, String> {
        let folder = target().join("ptx-tools");
        let requirements = root().join("xtask/ptx-requirements.txt");
        let wanted =
            fs::read_to_string(&requirements).map_err(|error| format!("{}: {error}", requirements.display()))?;
        let stamp = folder.join("requirements.txt");
        if fs::read_to_string(&stamp).ok().as_ref() != Some(&wanted) {
            check_pip()?;
            // Nothing to remove the first time.
            let _ = fs::remove_dir_all(&folder);
            let mut pip = Command::new("python3");
            pip.args([
                "-m",
                "pip",
                "install",
                "--quiet",
                "--disable-pip-version-check",
                "--no-deps",
                "--require-hashes",
            ]);
            pip.args(["--only-binary=:all:", "--target"]).arg(&folder).arg("--requirement").arg(&requirements);
            // As root it would warn of a system's packages, which `--target` leaves alone.
            pip.env("PIP_ROOT_USER_ACTION", "ignore");
            run(&mut pip)?;
            fs::write(&stamp, wanted).map_err(|error| format!("{}: {error}", stamp.display()))?;
        }
        Ok(Self {
            nvrtc: Nvrtc::open(&folder.join("nvidia/cuda_nvrtc/lib/libnvrtc.so.12"))?,
            ptxas: folder.join("nvidia/cuda_nvcc/bin/ptxas"),
        })
    }
}

fn check_pip() -> Result<(), String> {
    let found = Command::new("python3").args(["-m", "pip", "--version"]).output();
    match found {
        Ok(output) if output.status.success() => Ok(()),
        _ => {
            Err("the compiler of device code is fetched by `python3 -m pip`, which is missing: install Python 3 with \
                  pip (Debian and Ubuntu: apt-get install python3-pip)"
                .into())
        }
    }
}
