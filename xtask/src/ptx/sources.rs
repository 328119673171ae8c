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
    /// Whether it is compiled for compute capability 9.0 too.
    pub vector_reductions: bool,
}

/// What a source is compiled for: an architecture, and those above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target(pub &'static str);

/// Compute capability 7.5 is the first with ray tracing cores and all that the kernels use.
const EVERY_GPU: Target = Target("75");
/// The first that adds vectors of floats by one atomic instruction.
const VECTOR_REDUCTIONS: Target = Target("90");

impl Source {
    /// What it is compiled for.
    pub fn targets(&self) -> Vec<Target> {
        let newer = self.vector_reductions.then_some(VECTOR_REDUCTIONS);
        [EVERY_GPU].into_iter().chain(newer).collect()
    }

    /// Where it is compiled to.
    pub fn ptx_file(&self, target: Target) -> PathBuf {
        ptx_folder().join(format!("{}.ptx", self.ptx_name(target)))
    }

    /// Name of the compiled file without its extension.
    pub fn ptx_name(&self, target: Target) -> String {
        if target == EVERY_GPU { self.name.clone() } else { format!("{}.sm_{}", self.name, target.0) }
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
            let text = fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
            let vector_reductions = text.lines().any(|line| line == "#define VECTOR_REDUCTIONS");
            sources.push(Source { name, folder, file, vector_reductions });
        }
    }
    Ok(sources)
}

/// PTX files without a source.
pub fn orphans(sources: &[Source]) -> Result<Vec<PathBuf>, String> {
    let mut files = files_with(&ptx_folder(), "ptx")?;
    let is_of = |source: &Source, file: &Path| source.targets().iter().any(|&target| source.ptx_file(target) == file);
    files.retain(|file| !sources.iter().any(|source| is_of(source, file)));
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
