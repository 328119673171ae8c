//! Files that other programs wrote. They are not part of this repository: the environment variable `NEARFIELD_DATA`
//! names their folder, `../shared/data` from the workspace root by default; where it is absent these tests are ignored.

use libtest_mimic::{Arguments, Failed, Trial};
use nearfield::io::{Configuration, IoError, Problem, ReadOptions, read, write};
use std::path::{Path, PathBuf};

fn main() {
    let data = std::env::var_os("NEARFIELD_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    type Test = fn(&Path) -> Result<(), Failed>;
    let tests: [(&str, Test); 8] = [
        ("gromacs_argon_has_5832_atoms_with_velocities", gromacs_argon_has_5832_atoms_with_velocities),
        ("gromacs_ids_with_gaps_are_kept", gromacs_ids_with_gaps_are_kept),
        ("lammps_melt_agrees_with_the_dump_of_the_same_run", lammps_melt_agrees_with_the_dump_of_the_same_run),
        ("lammps_drop_has_a_box_around_negative_coordinates", lammps_drop_has_a_box_around_negative_coordinates),
        ("orthorhombic_xyz_gives_box_species_masses_and_forces", orthorhombic_xyz_gives_box_species_masses_and_forces),
        ("xyz_without_lattice_is_open", xyz_without_lattice_is_open),
        ("triclinic_xyz_is_a_clear_error", triclinic_xyz_is_a_clear_error),
        ("every_file_survives_a_round_trip", every_file_survives_a_round_trip),
    ];
    let is_absent = !data.is_dir();
    let trial = |(name, test): (&str, Test)| {
        let data = data.clone();
        Trial::test(name, move || test(&data)).with_ignored_flag(is_absent)
    };
    libtest_mimic::run(&Arguments::from_args(), tests.into_iter().map(trial).collect()).exit();
}

fn load(path: PathBuf) -> Result<Configuration, Failed> {
    read(path, &ReadOptions::default()).map_err(Failed::from)
}

fn gromacs_argon_has_5832_atoms_with_velocities(data: &Path) -> Result<(), Failed> {
    let argon = load(data.join("gromacs/argon5832.gro"))?;
    assert_eq!(argon.len(), 5832);
    assert_eq!(argon.position.get(0), [0.794, 1.439, 0.610]);
    assert_eq!(argon.position.get(5831), [5.738, 5.378, 5.108]);
    assert_eq!(argon.velocity.as_ref().unwrap().get(5831), [0.0362, -0.2872, 0.0357]);
    assert_eq!(argon.species.names, ["AR"]);
    assert_eq!(argon.comment.as_deref(), Some("Argon"));
    let bounds = argon.bounds.unwrap();
    assert_eq!((bounds.lo, bounds.hi, bounds.periodic), ([0.0; 3], [6.05449; 3], None));
    Ok(())
}

fn gromacs_ids_with_gaps_are_kept(data: &Path) -> Result<(), Failed> {
    let argon = load(data.join("gromacs/argon12.gro"))?;
    assert_eq!(argon.id.unwrap(), [1, 61, 108, 251, 363, 554, 784, 921, 1934, 3600, 4013, 5811]);
    Ok(())
}

fn lammps_melt_agrees_with_the_dump_of_the_same_run(data: &Path) -> Result<(), Failed> {
    let melt = load(data.join("lammps/melt.data"))?;
    let dump = std::fs::read_to_string(data.join("lammps/melt2048_periodic.forces"))?;
    let rows: Vec<&str> = dump.lines().skip(9).collect();
    assert_eq!((melt.len(), rows.len()), (2048, 2048));
    for (i, row) in rows.iter().enumerate() {
        let numbers: Vec<f64> = row.split_whitespace().map(|v| v.parse().unwrap()).collect();
        assert_eq!(melt.id.as_ref().unwrap()[i], numbers[0] as u64);
        assert_eq!(melt.position.get(i).map(f64::from), numbers[2..5], "atom {i}");
    }
    assert_eq!(melt.mass.unwrap(), [1.0]);
    assert_eq!(melt.species.names, ["1"]);
    assert_eq!(melt.bounds.unwrap().hi.map(f64::from), [13.436_769_485_473_633; 3]);
    Ok(())
}

fn lammps_drop_has_a_box_around_negative_coordinates(data: &Path) -> Result<(), Failed> {
    let drop = load(data.join("lammps/drop.data"))?;
    let bounds = drop.bounds.unwrap();
    assert_eq!(bounds.lo.map(f64::from), [-6.718_384_742_736_816; 3]);
    assert_eq!(
        drop.position.get(0).map(f64::from),
        [-0.747_509_539_127_349_9, 2.745_611_906_051_635_7, 2.349_539_756_774_902_3]
    );
    Ok(())
}

fn orthorhombic_xyz_gives_box_species_masses_and_forces(data: &Path) -> Result<(), Failed> {
    let crystal = load(data.join("vesin/Cd2I4O12.xyz"))?;
    assert_eq!(crystal.len(), 18);
    assert_eq!(crystal.species.names.len(), 3);
    assert_eq!(crystal.species.names[0], "Cd");
    assert_eq!(crystal.mass.as_ref().unwrap()[0], 112.414);
    assert_eq!(crystal.force.as_ref().unwrap().get(0), [-0.038_657_1, -0.058_028_75, 0.028_490_28]);
    let lengths = [5.777_906_156_568_9, 5.935_302_115_959_4, 32.370_489_11].map(|length: f64| length as f32);
    assert_eq!(crystal.bounds.unwrap().hi, lengths);
    let diamond = load(data.join("vesin/diamond.xyz"))?;
    assert_eq!(diamond.bounds.unwrap().periodic, Some([true; 3]));
    Ok(())
}

fn xyz_without_lattice_is_open(data: &Path) -> Result<(), Failed> {
    for (name, n) in [("naphthalene", 18), ("slab", 8), ("water", 51)] {
        let molecule = load(data.join(format!("vesin/{name}.xyz")))?;
        assert_eq!((molecule.len(), molecule.bounds), (n, None), "{name}");
    }
    Ok(())
}

fn triclinic_xyz_is_a_clear_error(data: &Path) -> Result<(), Failed> {
    for name in ["carbon", "rotated_box"] {
        let error = read(data.join(format!("vesin/{name}.xyz")), &ReadOptions::default()).unwrap_err();
        assert!(matches!(error, IoError::Parse { line: 2, problem: Problem::Triclinic { .. }, .. }), "{name}: {error}");
        assert!(error.to_string().contains("only orthorhombic boxes"), "{error}");
    }
    Ok(())
}

fn every_file_survives_a_round_trip(data: &Path) -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    for name in ["gromacs/argon5832.gro", "lammps/melt.data", "vesin/Cd2I4O12.xyz", "vesin/water.xyz"] {
        let original = load(data.join(name))?;
        let copy = folder.path().join("copy.xyz");
        write(&copy, &original)?;
        let copied = load(copy)?;
        assert_eq!(copied.position, original.position, "{name}");
        assert_eq!(copied.velocity, original.velocity, "{name}");
        assert_eq!(copied.species, original.species, "{name}");
        assert_eq!(copied.id, original.id, "{name}");
        assert_eq!(copied.bounds.map(|b| (b.lo, b.hi)), original.bounds.map(|b| (b.lo, b.hi)), "{name}");
    }
    Ok(())
}
