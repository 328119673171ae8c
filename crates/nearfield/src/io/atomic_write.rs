//! Files that are complete or absent.

use super::{IoError, Result};
use std::{
    fs::{self, File},
    io::{self, BufWriter, Seek, Write},
    path::{Path, PathBuf},
};

/// What a file's content is written to.
pub trait WriteSeek: Write + Seek {}
impl<W: Write + Seek> WriteSeek for W {}

/// Writes a file so that at any moment, a kill or a power cut included, `path` holds either its old or its new content.
///
/// The content goes to a temporary file in the same folder, which is flushed to the disk and then renamed. A symbolic
/// link stays one. A `path` that is no regular file (a pipe, `/dev/stdout`) is written directly.
///
/// ```
/// let path = std::env::temp_dir().join("nearfield-atomic-write.txt");
/// nearfield::io::atomic_write(&path, |out| writeln!(out, "hello"))?;
/// assert_eq!(std::fs::read_to_string(&path)?, "hello\n");
/// # std::fs::remove_file(path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`IoError::Write`] when the folder is missing or not writable, the disk is full, or `content` fails; the old file is
/// then still in place.
pub fn atomic_write(path: impl AsRef<Path>, content: impl FnOnce(&mut dyn WriteSeek) -> io::Result<()>) -> Result<()> {
    let path = path.as_ref();
    write_through_temporary(path, content).map_err(|source| IoError::Write { path: path.to_owned(), source })
}

fn write_through_temporary(path: &Path, content: impl FnOnce(&mut dyn WriteSeek) -> io::Result<()>) -> io::Result<()> {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if fs::metadata(&target).is_ok_and(|m| !m.is_file() && !m.is_dir()) {
        return write_directly(&target, content);
    }
    let name = target.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "this is no file name"))?;
    let folder = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    };
    let mut prefix = std::ffi::OsString::from(".");
    prefix.push(name);
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".tmp");
    #[cfg(unix)]
    // A temporary file is private by default; this one becomes the user's: what the umask allows, or as it was.
    builder.permissions(
        fs::metadata(&target).map_or_else(|_| std::os::unix::fs::PermissionsExt::from_mode(0o666), |m| m.permissions()),
    );
    let mut temporary = BufWriter::with_capacity(1 << 18, builder.tempfile_in(&folder)?);
    content(&mut temporary)?;
    let temporary = temporary.into_inner()?;
    temporary.as_file().sync_all()?;
    temporary.persist(&target)?;
    #[cfg(unix)]
    // The rename itself is durable once the folder is.
    File::open(&folder)?.sync_all()?;
    Ok(())
}

/// Pipes and devices cannot seek: the content is made in memory first.
fn write_directly(target: &Path, content: impl FnOnce(&mut dyn WriteSeek) -> io::Result<()>) -> io::Result<()> {
    let mut memory = io::Cursor::new(Vec::new());
    content(&mut memory)?;
    File::options().write(true).open(target)?.write_all(memory.get_ref())
}
