//! Which format a file has, and the two functions most callers need.

use super::{
    Configuration, Frames, IoError, Result, atomic_write, extended_xyz, gro, lammps_data, line_reader::LineReader,
};
use std::{
    fs::File,
    io::{self, BufRead, BufReader},
    path::Path,
};

/// A file format for particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Extended XYZ and plain XYZ: `.xyz`, `.extxyz`.
    ExtendedXyz,
    /// LAMMPS data: `.data`, `.lmp`.
    LammpsData,
    /// GROMACS coordinates: `.gro`; read only.
    Gro,
}

impl Format {
    /// The format by the extension of a file name.
    ///
    /// # Errors
    /// [`IoError::UnknownExtension`].
    pub fn of(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        match extension.to_str() {
            Some("xyz" | "extxyz") => Ok(Self::ExtendedXyz),
            Some("data" | "lmp") => Ok(Self::LammpsData),
            Some("gro") => Ok(Self::Gro),
            _ => {
                let known = ".xyz, .extxyz (extended XYZ), .data, .lmp (LAMMPS data), .gro (GROMACS)";
                Err(IoError::UnknownExtension { path: path.to_owned(), known })
            }
        }
    }
}

/// Which frame of a trajectory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Frame {
    /// The first.
    #[default]
    First,
    /// The last.
    Last,
    /// The one with this index, counted from 0.
    Index(usize),
}

/// How to read; the default is the first frame, with the format told by extension.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// The format, where the extension does not tell it. Standard input is extended XYZ unless told otherwise.
    pub format: Option<Format>,
    /// The frame.
    pub frame: Frame,
}

/// The name of an input in messages: `standard input` for `-`.
pub fn input_name(path: &Path) -> String {
    if path == Path::new("-") { "standard input".into() } else { path.display().to_string() }
}

/// Reads particles from a file, or from standard input where `path` is `-`.
///
/// # Errors
/// [`IoError`]: the file is missing, of unknown format, empty, or wrong in a certain line.
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Configuration> {
    let path = path.as_ref();
    if path == Path::new("-") {
        let format = options.format.unwrap_or(Format::ExtendedXyz);
        return read_from(io::stdin().lock(), &input_name(path), format, options.frame);
    }
    let format = options.format.map_or_else(|| Format::of(path), Ok)?;
    let file = File::open(path).map_err(|source| IoError::Open { path: path.to_owned(), source })?;
    read_from(BufReader::with_capacity(1 << 18, file), &input_name(path), format, options.frame)
}

fn read_from(input: impl BufRead, name: &str, format: Format, frame: Frame) -> Result<Configuration> {
    if format == Format::ExtendedXyz {
        let frames = Frames::new(input, name);
        return match frame {
            Frame::First => frames.frame(0),
            Frame::Index(index) => frames.frame(index),
            Frame::Last => frames.last_frame(),
        };
    }
    if matches!(frame, Frame::Index(1..)) {
        return Err(IoError::SingleFrame { file: name.to_owned() });
    }
    let lines = LineReader::new(input, name, 0);
    match format {
        Format::Gro => gro::read(lines),
        _ => lammps_data::read(lines),
    }
}

/// Writes particles to a file, whole or not at all ([`atomic_write`]); the extension tells the format.
///
/// # Errors
/// [`IoError::UnknownExtension`], [`IoError::Unwritable`] when the format cannot hold the configuration,
/// [`IoError::Write`].
pub fn write(path: impl AsRef<Path>, configuration: &Configuration) -> Result<()> {
    let path = path.as_ref();
    let unwritable = |reason: String| IoError::Unwritable { path: path.to_owned(), reason };
    let mut text = Vec::new();
    let format = Format::of(path)?;
    if let Some(reason) = configuration.flaw() {
        return Err(unwritable(reason));
    }
    match format {
        Format::ExtendedXyz => extended_xyz::encode(configuration, &mut text),
        Format::LammpsData => lammps_data::encode(configuration, &mut text).map_err(|r| unwritable(r.to_owned()))?,
        Format::Gro => {
            return Err(unwritable("GROMACS files are read only; write .xyz, .extxyz, .data or .lmp".to_owned()));
        }
    }
    atomic_write(path, |out| out.write_all(&text))
}
