//! The files of device code in nearfield-kernels.

use crate::command::root;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// A source file.
pub struct Source {
    /// Its name without extension.
    pub name: String,
    /// `cuda` or `optix`.
    pub folder: &'static str,
    /// Where it is.
    pub file: PathBuf,
}

impl Source {
    /// Where it is compiled to.
    pub fn ptx_file(&self) -> PathBuf {
        ptx_folder().join(format!("{}.ptx", self.name))
    }

    /// Its path in the crate.
    pub fn path(&self) -> String {
        format!("{}/{}.cu", self.folder, self.name)
    }

    /// Whether it calls what only the OptiX compiler defines.
    pub fn is_optix(&self) -> bool {
        self.folder == "optix"
    }
}

/// Every source, sorted by path. Names are unique: all are compiled to one folder.
pub fn all() -> Result<Vec<Source>, String> {
    let mut sources = Vec::new();
    for folder in ["cuda", "optix"] {
        for file in files_with(&krate().join(folder), "cu")? {
            let name = stem(&file)?;
            if sources.iter().any(|source: &Source| source.name == name) {
                return Err(format!("{} has the name of another source", file.display()));
            }
            sources.push(Source { name, folder, file });
        }
    }
    Ok(sources)
}

/// PTX files without a source.
pub fn orphans(sources: &[Source]) -> Result<Vec<PathBuf>, String> {
    let mut files = files_with(&ptx_folder(), "ptx")?;
    files.retain(|file| !sources.iter().any(|source| source.ptx_file() == *file));
    Ok(files)
}

/// The generated header.
pub fn layouts_file() -> PathBuf {
    include_folder().join("layouts.cuh")
}

/// Headers of the sources.
pub fn include_folder() -> PathBuf {
    krate().join("cuda/include")
}

fn ptx_folder() -> PathBuf {
    krate().join("ptx")
}

fn krate() -> PathBuf {
    root().join("crates/nearfield-kernels")
}

/// Files of a folder by extension, sorted; none where there is no folder.
fn files_with(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, String> {
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let entries = fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let entries = entries.map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.into_iter().map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|found| found == extension));
    files.sort();
    Ok(files)
}

fn stem(file: &Path) -> Result<String, String> {
    let stem = file.file_stem().and_then(|stem| stem.to_str());
    stem.map(str::to_owned).ok_or_else(|| format!("{} has no UTF-8 name", file.display()))
}
