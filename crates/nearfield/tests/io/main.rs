//! Reading and writing files, through the public interface.

mod errors;
mod formats;
mod growing;
mod round_trips;
mod tables;

use nearfield::io::{Configuration, ReadOptions, Result, read};

/// Reads `text` as a file of the given name.
fn read_text(name: &str, text: &str) -> Result<Configuration> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    read(path, &ReadOptions::default())
}
