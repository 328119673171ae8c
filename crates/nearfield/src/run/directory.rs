//! The output directory.

use crate::{Error, Result, io::IoError};
use std::{
    borrow::Cow,
    env, fs,
    path::{Path, PathBuf},
};

/// Makes an empty output directory; one that holds an earlier run is renamed to `NAME.1`, `NAME.2`, ... first.
/// Gives the new name of what was moved.
pub(super) fn prepare(directory: &Path) -> Result<Option<PathBuf>> {
    let failed = |source| IoError::Write { path: directory.to_owned(), source };
    let target = target(directory);
    let mut moved = None;
    if target.join("run.json").exists() {
        let free = free_name(&target).ok_or_else(|| Error::Occupied(directory.to_owned()))?;
        fs::rename(&target, &free).map_err(failed)?;
        moved = Some(free);
    }
    fs::create_dir_all(&target).map_err(failed)?;
    // A directory that exists may still refuse files.
    tempfile::tempfile_in(&target).map_err(failed)?;
    Ok(moved)
}

/// What is to be renamed: the directory that a link leads to, not the link.
fn target(directory: &Path) -> Cow<'_, Path> {
    if directory.is_symlink() || directory.file_name().is_none() {
        fs::canonicalize(directory).map_or(directory.into(), Cow::from)
    } else {
        directory.into()
    }
}

/// A free name for an earlier run. None for a directory the user is in: it holds more than a run.
fn free_name(directory: &Path) -> Option<PathBuf> {
    let here = env::current_dir().and_then(fs::canonicalize).ok()?;
    if here.starts_with(fs::canonicalize(directory).ok()?) {
        return None;
    }
    let name = |k: usize| {
        let mut name = directory.file_name()?.to_owned();
        name.push(format!(".{k}"));
        Some(directory.with_file_name(name))
    };
    (1..).map_while(name).find(|path| !path.exists())
}
