//! Tables of results read back exactly.

use nearfield::io::{IoError, write_forces_csv, write_pairs_csv, write_pairs_npz};
use nearfield_core::{ListKind, NeighborList, PerParticle, Vec3s};
use std::{fs, io::Read};

fn list() -> NeighborList {
    NeighborList {
        kind: ListKind::Half,
        offsets: vec![0, 2, 2, 3],
        indices: vec![1, 2, 0],
        shifts: Some(vec![[0, 0, 0], [-1, 0, 1], [0, 1, 0]]),
        distances: Some(vec![0.1, 1.0e-30, 2.5]),
    }
}

#[test]
fn forces_have_one_row_a_particle() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("forces.csv");
    let force: Vec3s = [[0.1, -2.0, 1.0e-30], [f32::MAX, 0.0, 3.0]].into_iter().collect();
    let mut results = PerParticle { force, energy: vec![-6.773_368_053, 1.0 / 3.0], neighbors: vec![54, 0] };
    write_forces_csv(&path, &results).unwrap();
    type Row = (usize, f32, f32, f32, Option<f64>, Option<u32>);
    let rows =
        || -> Vec<Row> { csv::Reader::from_path(&path).unwrap().deserialize().map(|row| row.unwrap()).collect() };
    let expected: [Row; 2] =
        [(0, 0.1, -2.0, 1.0e-30, Some(-6.773_368_053), Some(54)), (1, f32::MAX, 0.0, 3.0, Some(1.0 / 3.0), Some(0))];
    assert_eq!(rows(), expected);
    assert!(fs::read_to_string(&path).unwrap().starts_with("id,fx,fy,fz,energy,neighbors\n0,"));
    (results.energy, results.neighbors) = (vec![], vec![]);
    write_forces_csv(&path, &results).unwrap();
    assert_eq!(rows()[0], (0, 0.1, -2.0, 1.0e-30, None, None));
}

#[test]
fn pairs_carry_their_shift_when_periodic() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pairs.csv");
    write_pairs_csv(&path, &list()).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("i,j,distance,sx,sy,sz\n0,1,0.1,0,0,0\n0,2,"), "{text}");
    let rows: Vec<(u32, u32, f32, i8, i8, i8)> =
        csv::Reader::from_reader(text.as_bytes()).deserialize().map(|row| row.unwrap()).collect();
    assert_eq!(rows, [(0, 1, 0.1, 0, 0, 0), (0, 2, 1.0e-30, -1, 0, 1), (2, 0, 2.5, 0, 1, 0)]);
    write_pairs_csv(&path, &NeighborList { shifts: None, ..list() }).unwrap();
    assert!(fs::read_to_string(&path).unwrap().starts_with("i,j,distance\n0,1,0.1\n"));
}

#[test]
fn npz_arrays_read_back() {
    fn array<T: npyz::Deserialize>(archive: &mut zip::ZipArchive<fs::File>, name: &str) -> (Vec<u64>, Vec<T>) {
        let mut bytes = Vec::new();
        archive.by_name(name).unwrap().read_to_end(&mut bytes).unwrap();
        let array = npyz::NpyFile::new(&bytes[..]).unwrap();
        (array.shape().to_vec(), array.into_vec().unwrap())
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pairs.npz");
    write_pairs_npz(&path, &list()).unwrap();
    let mut archive = zip::ZipArchive::new(fs::File::open(&path).unwrap()).unwrap();
    assert_eq!(array::<u32>(&mut archive, "i.npy"), (vec![3], vec![0, 0, 2]));
    assert_eq!(array::<u32>(&mut archive, "j.npy"), (vec![3], vec![1, 2, 0]));
    assert_eq!(array::<f32>(&mut archive, "distance.npy"), (vec![3], vec![0.1, 1.0e-30, 2.5]));
    assert_eq!(array::<i8>(&mut archive, "shift.npy"), (vec![3, 3], vec![0, 0, 0, -1, 0, 1, 0, 1, 0]));
    write_pairs_npz(&path, &NeighborList { shifts: None, ..list() }).unwrap();
    assert_eq!(zip::ZipArchive::new(fs::File::open(&path).unwrap()).unwrap().len(), 3);
}

#[test]
fn pairs_without_distances_are_refused() {
    let list = NeighborList { distances: None, ..list() };
    let path = std::path::Path::new("pairs.csv");
    assert!(matches!(write_pairs_csv(path, &list), Err(IoError::Unwritable { .. })));
    assert!(matches!(write_pairs_npz(path, &list), Err(IoError::Unwritable { .. })));
}
