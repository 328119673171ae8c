//! Tables of results: forces as CSV, pairs as CSV or NPZ.

use super::{IoError, Result, atomic_write};
use nearfield_core::{NeighborList, PerParticle};
use npyz::WriterBuilder;
use std::{
    io::{self, Write},
    path::Path,
};

/// Writes `id,fx,fy,fz,energy,neighbors`, one row a particle in input order; `id` counts from 0.
///
/// Numbers read back exactly. Columns whose array is empty stay empty.
///
/// # Errors
/// [`IoError::Write`].
pub fn write_forces_csv(path: impl AsRef<Path>, results: &PerParticle) -> Result<()> {
    atomic_write(path, |out| {
        let mut table = csv::Writer::from_writer(out);
        table.write_record(["id", "fx", "fy", "fz", "energy", "neighbors"])?;
        for (i, [fx, fy, fz]) in results.force.iter().enumerate() {
            table.serialize((i, fx, fy, fz, results.energy.get(i), results.neighbors.get(i)))?;
        }
        table.flush()
    })
}

/// Writes `i,j,distance`, and `sx,sy,sz` where the list has shifts, one row an entry of the list.
///
/// The shift counts box lengths: `dr = x_j - x_i + s * length`.
///
/// # Errors
/// [`IoError::Unwritable`] when the list has no distances, [`IoError::Write`].
pub fn write_pairs_csv(path: impl AsRef<Path>, list: &NeighborList) -> Result<()> {
    let distances = distances(path.as_ref(), list)?;
    atomic_write(path, |out| {
        let mut table = csv::Writer::from_writer(out);
        match &list.shifts {
            None => table.write_record(["i", "j", "distance"])?,
            Some(_) => table.write_record(["i", "j", "distance", "sx", "sy", "sz"])?,
        }
        for (entry, (i, j)) in list.pairs().enumerate() {
            match &list.shifts {
                None => table.serialize((i, j, distances[entry]))?,
                Some(shifts) => table.serialize((i, j, distances[entry], shifts[entry]))?,
            }
        }
        table.flush()
    })
}

/// Writes the NumPy arrays `i` and `j` (`[P]`, uint32), `distance` (`[P]`, float32), and `shift` (`[P, 3]`, int8) where
/// the list has shifts; `numpy.load` opens the file. Uncompressed, as `numpy.savez` does.
///
/// # Errors
/// As [`write_pairs_csv`].
pub fn write_pairs_npz(path: impl AsRef<Path>, list: &NeighborList) -> Result<()> {
    let distances = distances(path.as_ref(), list)?;
    atomic_write(path, |out| {
        let n = list.n_entries() as u64;
        let mut archive = zip::ZipWriter::new(out);
        write_array(&mut archive, "i", &[n], list.pairs().map(|(i, _)| i))?;
        write_array(&mut archive, "j", &[n], list.indices.iter().copied())?;
        write_array(&mut archive, "distance", &[n], distances.iter().copied())?;
        if let Some(shifts) = &list.shifts {
            write_array(&mut archive, "shift", &[n, 3], shifts.iter().flatten().copied())?;
        }
        archive.finish()?;
        Ok(())
    })
}

fn write_array<T: npyz::AutoSerialize>(
    archive: &mut zip::ZipWriter<impl Write + io::Seek>,
    name: &str,
    shape: &[u64],
    values: impl Iterator<Item = T>,
) -> io::Result<()> {
    let stored = zip::write::SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Stored)
        // Beyond 4 GiB the archive needs another header, to be chosen beforehand.
        .large_file(true);
    archive.start_file(npyz::npz::file_name_from_array_name(name), stored)?;
    let mut array = npyz::WriteOptions::new().default_dtype().shape(shape).writer(archive).begin_nd()?;
    array.extend(values)?;
    array.finish()
}

fn distances<'a>(path: &Path, list: &'a NeighborList) -> Result<&'a [f32]> {
    let reason = "the neighbour list was made without distances";
    let missing = || IoError::Unwritable { path: path.to_owned(), reason: reason.to_owned() };
    list.distances.as_deref().ok_or_else(missing)
}
