//! What valid files give.

use crate::read_text;
use nearfield::io::{Configuration, Format, Frame, Frames, IoError, ReadOptions, read, write};
use nearfield_core::{Boundary, Interaction, Particles, Radii, SimBox, System};

const TWO_FRAMES: &str = "2\nfirst\nAr 0 0 0\nNe 1 2 3\n\n1\nsecond\nAr 5 6 7\n";

#[test]
fn plain_xyz_is_open_and_may_have_further_columns() {
    let gas = read_text("gas.xyz", "2\n  argon at T=300 K \nAr 0 -1.5e1 2 0.1\nNe 1 2 3 0.2\n").unwrap();
    assert_eq!(gas.position.get(0), [0.0, -15.0, 2.0]);
    assert_eq!(gas.species.names, ["Ar", "Ne"]);
    assert_eq!(gas.species.of, [0, 1]);
    assert_eq!(gas.comment.as_deref(), Some("argon at T=300 K"));
    assert_eq!((gas.bounds, gas.velocity, gas.id), (None, None, None));
}

#[test]
fn free_text_that_resembles_extended_xyz_stays_free_text() {
    let gas = read_text("gas.xyz", "1\nProperties of Maxwell's gas at T=300 K\nAr 0 0 0\n").unwrap();
    assert_eq!(gas.comment.as_deref(), Some("Properties of Maxwell's gas at T=300 K"));
}

#[test]
fn extended_xyz_columns_may_come_in_any_order() {
    let text = "1\n\
        Lattice=\"10 0 0 0 20 0 0 0 30\" Origin=\"-5 0 5\" pbc=\"T T F\" Step=7 Time=0.035 energy=-1.5 flag\
        \x20Properties=id:I:1:velo:R:3:magmom:R:2:pos:R:3:radius:R:1:species:S:1:forces:R:3:mass:R:1\n\
        42 1 2 3 9 9 4 5 6 0.5 Xe 7 8 9 131.3\n";
    let xenon = read_text("xenon.extxyz", text).unwrap();
    assert_eq!(xenon.position.get(0), [4.0, 5.0, 6.0]);
    assert_eq!(xenon.velocity.unwrap().get(0), [1.0, 2.0, 3.0]);
    assert_eq!(xenon.force.unwrap().get(0), [7.0, 8.0, 9.0]);
    assert_eq!((xenon.id, xenon.radius, xenon.mass), (Some(vec![42]), Some(vec![0.5]), Some(vec![131.3])));
    assert_eq!((xenon.step, xenon.time), (Some(7), Some(0.035)));
    let bounds = xenon.bounds.unwrap();
    assert_eq!((bounds.lo, bounds.hi), ([-5.0, 0.0, 5.0], [5.0, 20.0, 35.0]));
    assert_eq!(bounds.periodic, Some([true, true, false]));
}

#[test]
fn a_lattice_without_pbc_is_periodic_and_rotation_residues_are_ignored() {
    let text = "1\nLattice=\"10 1e-16 0 -6e-16 10 0 0 0 10\"\r\nAr 0 0 0\r\n";
    assert_eq!(read_text("a.xyz", text).unwrap().bounds.unwrap().periodic, Some([true; 3]));
}

#[test]
fn any_frame_of_a_trajectory_can_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.xyz");
    std::fs::write(&path, TWO_FRAMES).unwrap();
    let comment = |frame| read(&path, &ReadOptions { frame, ..Default::default() }).unwrap().comment.unwrap();
    assert_eq!(comment(Frame::First), "first");
    assert_eq!(comment(Frame::Last), "second");
    assert_eq!(comment(Frame::Index(0)), "first");
    assert_eq!(comment(Frame::Index(1)), "second");
    let error = read(&path, &ReadOptions { frame: Frame::Index(2), ..Default::default() }).unwrap_err();
    assert!(matches!(error, IoError::NoSuchFrame { frame: 2, found: 2, .. }), "{error}");
    let comments: Vec<_> = Frames::open(&path).unwrap().map(|frame| frame.unwrap().comment.unwrap()).collect();
    assert_eq!(comments, ["first", "second"]);
}

#[test]
fn a_broken_frame_ends_the_iteration_and_its_line_counts_from_the_start_of_the_file() {
    let text = TWO_FRAMES.replace("5 6 7", "5 6 seven");
    let frames: Vec<_> = Frames::new(text.as_bytes(), "two.xyz").collect();
    assert_eq!(frames.len(), 2);
    let message = "two.xyz:8: z of particle 0: `seven` is not a number";
    assert_eq!(frames[1].as_ref().unwrap_err().to_string(), message);
    assert_eq!(Frames::new(text.as_bytes(), "two.xyz").last_frame().unwrap_err().to_string(), message);
}

#[test]
fn a_told_format_wins_over_the_extension() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("positions.txt");
    std::fs::write(&path, TWO_FRAMES).unwrap();
    let options = ReadOptions { format: Some(Format::ExtendedXyz), frame: Frame::First };
    assert_eq!(read(&path, &options).unwrap().len(), 2);
}

/// Header of two atoms and two types in a box of 10 x 10 x 10.
pub const LAMMPS_HEADER: &str = "title, timestep = 12\n\n2 atoms\n2 atom types # comment\n0 bonds\n\n\
    0 10 xlo xhi\n0 10 ylo yhi\n0 10 zlo zhi\n0 0 0 xy xz yz\n";

#[test]
fn lammps_atoms_keep_their_order_and_velocities_find_them_by_id() {
    let text = format!(
        "{LAMMPS_HEADER}\nMasses\n\n2 20.18 # Ne\n1 39.95 # Ar\n\nPair Coeffs # lj/cut\n\n1 1.0 1.0\n2 1.0 1.0\n\n\
        Atoms # atomic\n\n7 2 1 2 3 0 -1 2\n3 1 4 5 6 0 0 0 # last\n\nVelocities\n\n3 0.4 0.5 0.6\n7 0.1 0.2 0.3\n"
    );
    let mixture = read_text("mixture.data", &text).unwrap();
    assert_eq!(mixture.id, Some(vec![7, 3]));
    assert_eq!(mixture.species.names, ["1", "2"]);
    assert_eq!(mixture.species.of, [1, 0]);
    assert_eq!(mixture.mass, Some(vec![39.95, 20.18]));
    assert_eq!(mixture.position.get(0), [1.0, 2.0, 3.0]);
    assert_eq!(mixture.image, Some(vec![[0, -1, 2], [0; 3]]));
    assert_eq!(mixture.velocity.unwrap().iter().collect::<Vec<_>>(), [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]);
    assert_eq!(mixture.step, Some(12));
    assert_eq!(mixture.bounds.unwrap().periodic, None);
}

#[test]
fn lammps_styles_are_told_by_comment_or_columns() {
    let styles = [
        ("Atoms", "1 2 4 5 6"),
        ("Atoms", "1 2 4 5 6 0 0 0"),
        ("Atoms # atomic", "1 2 4 5 6"),
        ("Atoms  # charge", "1 2 1 4 5 6"),
        ("Atoms", "1 2 -0.5 4 5 6"),
        ("Atoms # molecular", "1 1 2 4 5 6"),
        ("Atoms # full", "1 1 2 0.5 4 5 6"),
        ("Atoms", "1 1 2 0.5 4 5 6 1 1 1"),
    ];
    let header = LAMMPS_HEADER.replace("2 atoms", "1 atoms");
    for (section, atom) in styles {
        let atoms = read_text("a.lmp", &format!("{header}\n{section}\n\n{atom}\n")).unwrap();
        assert_eq!(atoms.position.get(0), [4.0, 5.0, 6.0], "{section}: {atom}");
        assert_eq!(atoms.species.of, [1], "{section}: {atom}");
    }
}

#[test]
fn lammps_type_labels_name_the_species() {
    let text = format!("{LAMMPS_HEADER}\nAtom Type Labels\n\n1 Ar\n2 Ne\n\nAtoms\n\n1 Ne 1 2 3\n2 1 4 5 6\n");
    let mixture = read_text("mixture.data", &text).unwrap();
    assert_eq!(mixture.species.names, ["Ar", "Ne"]);
    assert_eq!(mixture.species.of, [1, 0]);
}

#[test]
fn gromacs_columns_of_any_precision_are_read() {
    // Five decimals: columns of ten characters.
    let wide = "Water t= 1.5 step= 300\n 2\n\
        \x20   1SOL     OW    1   0.12345  -1.23456   2.34567  0.100000 -0.200000  0.300000\n\
        \x20   1SOL    HW1    2   1.00000   2.00000   3.00000  0.000000  0.000000  0.000000\n\
        \x20  3.00000   4.00000   5.00000   0.0 0.0 0.0 0.0 0.0 0.0\n";
    let water = read_text("water.gro", wide).unwrap();
    assert_eq!(water.position.get(0), [0.12345, -1.23456, 2.34567]);
    assert_eq!(water.velocity.unwrap().get(0), [0.1, -0.2, 0.3]);
    assert_eq!(water.species.names, ["OW", "HW1"]);
    assert_eq!((water.time, water.step), (Some(1.5), Some(300)));
    assert_eq!(water.bounds.unwrap().hi, [3.0, 4.0, 5.0]);
}

#[test]
fn a_system_reads_back_from_its_file() {
    let boundary = [Boundary::Periodic, Boundary::Wall, Boundary::Open];
    let system = System {
        sim_box: SimBox::new([-1.0, 0.1, 0.0], [3.0, 9.3, 7.7], boundary).unwrap(),
        particles: Particles::at([[0.0, 0.5, 1.0], [2.0, 0.1, -3.0]]),
        radii: Radii::PerParticle(vec![0.5, 1.5]),
        interaction: Interaction::lennard_jones(),
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("system.xyz");
    write(&path, &Configuration::from(&system)).unwrap();
    let back = read(&path, &ReadOptions::default()).unwrap();
    assert_eq!(back.position, system.particles.position);
    assert_eq!(back.velocity.as_ref(), Some(&system.particles.velocity));
    assert_eq!(back.image.as_ref(), Some(&system.particles.image));
    assert_eq!((back.species.names, back.species.of, back.mass), (vec!["1".into()], vec![0, 0], Some(vec![1.0])));
    assert_eq!(back.radius, Some(vec![0.5, 1.5]));
    let bounds = back.bounds.unwrap();
    assert_eq!((bounds.lo, bounds.hi), (system.sim_box.lo(), system.sim_box.hi()));
    assert_eq!(bounds.periodic, Some([true, false, false]));
}
