//! A trajectory that grows frame by frame.

use super::{AppendFile, Configuration, IoError, Result, extended_xyz};
use std::path::Path;

/// Writes extended XYZ frames that ASE and OVITO open; each is handed to the operating system as soon as it is
/// complete.
///
/// To resume, keep [`Trajectory::length`] in the checkpoint and go on with [`Trajectory::open_at`].
#[derive(Debug)]
pub struct Trajectory {
    file: AppendFile,
    /// Reused from frame to frame.
    text: Vec<u8>,
}

impl Trajectory {
    /// An empty trajectory; a file that exists is emptied.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn create(path: impl AsRef<Path>) -> Result<Self> {
        Ok(Self { file: AppendFile::create(path)?, text: Vec::new() })
    }

    /// Continues a trajectory after its first `length` bytes; later frames are dropped.
    ///
    /// # Errors
    /// As [`AppendFile::open_at`].
    pub fn open_at(path: impl AsRef<Path>, length: u64) -> Result<Self> {
        Ok(Self { file: AppendFile::open_at(path, length)?, text: Vec::new() })
    }

    /// Appends a frame.
    ///
    /// # Errors
    /// [`IoError::Unwritable`] when arrays differ in length, [`IoError::Write`].
    pub fn append(&mut self, frame: &Configuration) -> Result<()> {
        if let Some(reason) = frame.flaw() {
            return Err(IoError::Unwritable { path: self.file.path().to_owned(), reason });
        }
        self.text.clear();
        extended_xyz::encode(frame, &mut self.text);
        self.file.append(&self.text)
    }

    /// Bytes written so far.
    pub fn length(&self) -> u64 {
        self.file.length()
    }

    /// Waits until everything is on the disk.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn sync(&self) -> Result<()> {
        self.file.sync()
    }
}
