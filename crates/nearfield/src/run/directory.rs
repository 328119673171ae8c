//! The output directory.

use crate::{Result, io::IoError};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Makes an empty output directory; one that holds an earlier run is renamed to `NAME.1`, `NAME.2`, ... first.
/// Gives the new name of what was moved.
pub(super) fn prepare(directory: &Path) -> Result<Option<PathBuf>> {
    let failed = |source| IoError::Write { path: directory.to_owned(), source };
    let mut moved = None;
    if directory.join("run.json").exists() {
        let name = |k: usize| {
            let mut name = directory.file_name().unwrap_or_default().to_owned();
            name.push(format!(".{k}"));
            directory.with_file_name(name)
        };
        let free = (1..).map(name).find(|path| !path.exists()).expect("some number is free");
        fs::rename(directory, &free).map_err(failed)?;
        moved = Some(free);
    }
    fs::create_dir_all(directory).map_err(failed)?;
    // A directory that exists may still refuse files.
    tempfile::tempfile_in(directory).map_err(failed)?;
    Ok(moved)
}
