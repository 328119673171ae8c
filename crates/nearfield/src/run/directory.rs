//! The output directory.

use crate::{Error, Result, io::IoError};
use std::{
    borrow::Cow,
    env, fs,
    path::{Path, PathBuf},
};

/// Makes an output directory without any of the `files`; one that holds an earlier run is renamed to `NAME.1`,
/// `NAME.2`, ... first. Gives the new name of what was moved.
pub(super) fn prepare(directory: &Path, files: &[&Path]) -> Result<Option<PathBuf>> {
    let failed = |source| IoError::Write { path: directory.to_owned(), source };
    let occupied = |what: String| Error::Occupied { directory: directory.to_owned(), what };
    let target = target(directory);
    let mut moved = None;
    if target.join(super::RECORD).exists() {
        let free = free_name(&target).ok_or_else(|| occupied("an earlier run".into()))?;
        fs::rename(&target, &free).map_err(failed)?;
        moved = Some(free);
    } else if let Some(file) = files.iter().find(|file| target.join(file).exists()) {
        // No run of ours: it might be the input.
        return Err(occupied(file.display().to_string()));
    }
    fs::create_dir_all(&target).map_err(failed)?;
    // A directory that exists may still refuse files.
    tempfile::tempfile_in(&target).map_err(failed)?;
    Ok(moved)
}

/// Removes what a kill in the middle of writing a file left behind.
pub(super) fn sweep(directory: &Path, files: &[&Path]) {
    let is_left_over = |name: &str| {
        let of = |file: &&Path| name.starts_with(&format!(".{}", file.display()));
        name.ends_with(".tmp") && files.iter().any(of)
    };
    for entry in fs::read_dir(directory).into_iter().flatten().flatten() {
        if entry.file_name().to_str().is_some_and(is_left_over) {
            // It does no harm but to take room.
            let _ = fs::remove_file(entry.path());
        }
    }
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
