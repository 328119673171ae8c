//! Files that grow by whole records.

use super::{IoError, Result};
use std::{
    fs::File,
    io::{self, Write},
    path::{Path, PathBuf},
};

/// A growing file, such as a trajectory or a table of a running simulation.
///
/// Each record goes to the operating system at once and in one piece, so a kill leaves at most the last record cut
/// short. A checkpoint keeps [`AppendFile::length`]; to resume, [`AppendFile::open_at`] drops whatever came after it.
///
/// ```
/// use nearfield::io::AppendFile;
/// let path = std::env::temp_dir().join("nearfield-append-file.csv");
/// let mut table = AppendFile::create(&path)?;
/// table.append(b"step,energy\n")?;
/// let checkpoint = table.length();
/// table.append(b"1,-6.77\n")?;
/// let mut resumed = AppendFile::open_at(&path, checkpoint)?;
/// resumed.append(b"1,-6.78\n")?;
/// assert_eq!(std::fs::read_to_string(&path)?, "step,energy\n1,-6.78\n");
/// # std::fs::remove_file(path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct AppendFile {
    path: PathBuf,
    file: File,
    length: u64,
}

impl AppendFile {
    /// An empty file; one that exists is emptied.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn create(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let failed = |source| IoError::Write { path: path.to_owned(), source };
        let file = File::options().append(true).create(true).open(path).map_err(failed)?;
        file.set_len(0).map_err(failed)?;
        Ok(Self { path: path.to_owned(), file, length: 0 })
    }

    /// Continues an existing file after its first `length` bytes; the rest is dropped.
    ///
    /// # Errors
    /// [`IoError::TooShort`] when the file has fewer bytes, [`IoError::Write`] when it cannot be opened or cut.
    pub fn open_at(path: impl AsRef<Path>, length: u64) -> Result<Self> {
        let path = path.as_ref();
        let failed = |source| IoError::Write { path: path.to_owned(), source };
        let file = File::options().append(true).open(path).map_err(failed)?;
        let found = file.metadata().map_err(failed)?.len();
        if found < length {
            return Err(IoError::TooShort { path: path.to_owned(), expected: length, found });
        }
        file.set_len(length).map_err(failed)?;
        Ok(Self { path: path.to_owned(), file, length })
    }

    /// Appends one whole record. When it does not fit on the disk, the file stays as it was.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn append(&mut self, record: &[u8]) -> Result<()> {
        if let Err(source) = self.file.write_all(record) {
            // Cutting off the partial record is best effort: the error that matters is the first one.
            let _ = self.file.set_len(self.length);
            return Err(self.failed(source));
        }
        self.length += record.len() as u64;
        Ok(())
    }

    /// Bytes written so far; the argument of [`AppendFile::open_at`].
    pub fn length(&self) -> u64 {
        self.length
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Waits until everything is on the disk; call it before a checkpoint refers to [`AppendFile::length`].
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn sync(&self) -> Result<()> {
        self.file.sync_data().map_err(|source| self.failed(source))
    }

    fn failed(&self, source: io::Error) -> IoError {
        IoError::Write { path: self.path.clone(), source }
    }
}
