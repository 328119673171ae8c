//! Every mistake in a file is one clear sentence that names the place.

use crate::{formats::LAMMPS_HEADER, read_text};
use nearfield::io::{Configuration, Frame, IoError, ReadOptions, Species, read, write};

/// Reads `text` as a file of that name and expects the message to be `NAME:LINE: ...PROBLEM...`.
fn expect(name: &str, text: &str, line: usize, problem: &str) {
    let message = match read_text(name, text) {
        Ok(_) => panic!("accepted, but expected `{problem}`:\n{text}"),
        Err(error) => error.to_string(),
    };
    let place = format!("{name}:{line}: ");
    assert!(message.contains(&place) && message.contains(problem), "expected `{place}... {problem}`, got `{message}`");
}

#[test]
fn wrong_extended_xyz_is_refused() {
    let lattice = |matrix: &str| format!("1\nLattice=\"{matrix}\" Properties=species:S:1:pos:R:3\nAr 0 0 0\n");
    let cases = [
        ("x\n\nAr 0 0 0\n", 1, "expected the number of atoms, found `x`"),
        ("-1\n\n", 1, "expected the number of atoms"),
        ("2\n\nAr 0 0 0\n", 3, "expected 2 atoms, found only 1"),
        ("2\n", 1, "expected 2 atoms, found only 0"),
        ("1\n\nAr 0 0 0\nAr 1 1 1\n", 4, "expected the number of atoms of the next frame, or the end of the file"),
        ("2\n\nAr 0 0\nAr 1 1 1\n", 3, "expected 4 fields (species:S:1:pos:R:3), found 3"),
        ("1\nProperties=pos:R:3\n0 0 0 1\n", 3, "expected 3 fields (pos:R:3), found 4"),
        ("1\n\nAr 0 1,5 0\n", 3, "y of particle 0: `1,5` is not a number"),
        ("2\n\nAr 0 0 0\nAr 0 0 nan\n", 4, "z of particle 1 is nan, but must be finite"),
        ("1\n\nAr -inf 0 0\n", 3, "x of particle 0 is -inf, but must be finite"),
        ("1\n\nAr 1e39 0 0\n", 3, "x of particle 0 is 1e39, but must be finite in single precision"),
        ("1\nProperties=pos:R:3:velo:R:3\n0 0 0 1 2 NaN\n", 3, "vz of particle 0 is NaN"),
        ("1\nProperties=pos:R:3:id:I:1\n0 0 0 1.5\n", 3, "id of particle 0: `1.5` is not a number"),
        ("1\nProperties=pos:R:2\n0 0\n", 2, "expected pos:R:3, found `pos:R:2`"),
        ("1\nProperties=species:S:1\nAr\n", 2, "expected a property pos:R:3"),
        ("1\npbc=\"T F F\"\nAr 0 0 0\n", 2, "no Lattice"),
        ("1\npbc=\"T F\"\nAr 0 0 0\n", 2, "expected three of T or F in pbc"),
        ("1\nLattice=\"1 0 0\nAr 0 0 0\n", 2, "expected a closing \""),
        (
            "2\nProperties=species:S:1:pos:R:3:masses:R:1\nH 0 0 0 1\nH 0 0 0 2\n",
            4,
            "particle 1 of species H has mass 2, but an earlier one has 1",
        ),
    ];
    for (text, line, problem) in cases {
        expect("a.xyz", text, line, problem);
    }
    expect("a.xyz", &lattice("1 0 0 0 1 0 0 0"), 2, "expected 9 numbers in Lattice");
    expect("a.xyz", &lattice("1 0 0 0 1 0 0.5 0 1"), 2, "the box is triclinic (Lattice vector c has x = 0.5)");
    expect(
        "a.xyz",
        &lattice("1 0 0 0 0 0 0 0 1"),
        2,
        "box axis y: bounds [0, 0) must be finite and have positive length",
    );
    expect("a.xyz", &lattice("1 0 0 0 1 0 0 0 -1"), 2, "box axis z");
    expect("a.xyz", &lattice("nan 0 0 0 1 0 0 0 1"), 2, "box axis x");
}

#[test]
fn wrong_lammps_data_is_refused() {
    let with = |body: &str| format!("{LAMMPS_HEADER}\n{body}");
    // The header has ten lines and a blank one follows, so the section name is on line 12.
    let cases = [
        ("Atoms\n\n1 1 0 0 0\n", 14, "expected 2 atoms, found only 1"),
        ("Atoms\n\n1 1 0 0 0\n\nVelocities\n\n1 0 0 0\n", 16, "expected 2 atoms, found only 1"),
        ("Atoms\n\n1 1 0 0 0\n2 1 0 0 0\n3 1 0 0 0\n", 16, "unexpected line after the 2 atoms"),
        ("Atoms # atomic\n\n1 1 0 0\n2 1 0 0 0\n", 14, "expected 5 fields (id type x y z), found 4"),
        ("Atoms\n\n1 1 0 0 0 0 0 0\n2 1 0 0 0\n", 15, "expected 8 fields (id type x y z ix iy iz), found 5"),
        ("Atoms\n\n1 1 1 0 0 0\n2 1 1 0 0 0\n", 14, "expected the atom style after the section name"),
        ("Atoms # sphere\n\n1 1 0 0 0 0 0\n2 1 0 0 0 0 0\n", 14, "expected atom style atomic, charge"),
        ("Atoms\n\n1 3 0 0 0\n2 1 0 0 0\n", 14, "expected an atom type from 1 to 2, found `3`"),
        ("Atoms\n\n1 1 0 0 0\n1 1 0 0 0\n", 15, "atom id 1 occurs twice"),
        ("Atoms\n\n1 1 0 0 nan\n2 1 0 0 0\n", 14, "z of particle 0 is nan"),
        ("Atoms\n\n1 1 0 0 0\n2 1 0 0 O\n", 15, "z of particle 1: `O` is not a number"),
        ("Velocities\n\n1 0 0 0\n2 0 0 0\n", 12, "expected the Atoms section before Velocities"),
        (
            "Atoms\n\n1 1 0 0 0\n2 1 0 0 0\n\nVelocities\n\n1 0 0 0\n3 0 0 0\n",
            20,
            "expected the id of an atom, found `3`",
        ),
        ("Atoms\n\n1 1 0 0 0\n2 1 0 0 0\n\nVelocities\n\n1 0 0 0\n1 0 0 0\n", 20, "atom id 1 occurs twice"),
        ("Masses\n\n1 1.0\n\nAtoms\n\n", 16, "expected 2 masses, found only 1"),
        ("Masses\n\n1 1.0\n2 -1\n", 15, "expected a positive mass, found `-1`"),
        ("Masses\n\n1 1.0\n1 1.0\n", 15, "expected each atom type once"),
        ("Atoms\n\n1 1 0 0 0\n2 1 0 0 0\n\nJunk\n", 17, "expected a section name"),
        ("\n", 12, "expected 2 atoms, found only 0"),
    ];
    for (body, line, problem) in cases {
        expect("a.data", &with(body), line, problem);
    }
}

#[test]
fn wrong_lammps_headers_are_refused() {
    let cases = [
        ("0 0 0 xy xz yz", "0 0.5 0 xy xz yz", 10, "the box is triclinic (0 0.5 0 xy xz yz)"),
        ("0 10 xlo xhi", "1 0 0 avec", 7, "the box is triclinic"),
        ("0 10 ylo yhi\n", "", 11, "a LAMMPS data file needs a box"),
        ("0 10 zlo zhi", "10 0 zlo zhi", 12, "box axis z: bounds [10, 0)"),
        ("2 atoms\n", "", 11, "expected a header line `N atoms`"),
        ("2 atom types # comment\n", "", 11, "expected a header line `N atom types`"),
        ("2 atoms", "two atoms", 3, "expected a header line (`N atoms`"),
        ("2 atoms", "2.5 atoms", 3, "expected a count"),
        ("2 atom types", "99999999999 atom types", 4, "expected a count of at most 1048576"),
    ];
    for (old, new, line, problem) in cases {
        let text = format!("{}\nAtoms\n\n1 1 0 0 0\n2 1 0 0 0\n", LAMMPS_HEADER.replace(old, new));
        expect("a.data", &text, line, problem);
    }
}

#[test]
fn wrong_gromacs_files_are_refused() {
    let atom = "    1AR      AR    1   0.794   1.439   0.610";
    let with = |n: &str, atom: &str, rest: &str| format!("Argon\n{n}\n{atom}\n{rest}");
    expect("a.gro", &with("x", atom, "1 1 1\n"), 2, "expected the number of atoms, found `x`");
    expect("a.gro", &with("2", atom, ""), 3, "expected 2 atoms, found only 1");
    expect("a.gro", &with("2", atom, "1 1 1\n"), 4, "expected an atom in fixed columns");
    expect("a.gro", &with("1", atom, ""), 3, "the file ends before the line with the box");
    expect("a.gro", &with("1", atom, "1 1\n"), 4, "expected a box of 3 or 9 numbers");
    expect("a.gro", &with("1", atom, "1 1 1 0 0 0.5 0 0 0\n"), 4, "the box is triclinic");
    expect("a.gro", &with("1", atom, "1 1 -1\n"), 4, "box axis z");
    expect("a.gro", &with("1", atom, "1 1 1\njunk\n"), 5, "unexpected line after the 1 atoms and the box");
    expect("a.gro", &with("1", &atom[..40], "1 1 1\n"), 3, "expected an atom in fixed columns");
    expect(
        "a.gro",
        &with("1", &atom.replace("1.439", "1.4x9"), "1 1 1\n"),
        3,
        "y of particle 0: `1.4x9` is not a number",
    );
    expect("a.gro", &with("1", &atom.replace("  0.610", " 1nf.0 "), "1 1 1\n"), 3, "z of particle 0");
    expect("a.gro", &with("1", "é", "1 1 1\n"), 3, "expected an atom in fixed columns");
    let atoms = format!("{atom}\n{atom}  0.0055 -0.1400  0.2127");
    expect("a.gro", &with("2", &atoms, "1 1 1\n"), 4, "expected 3 numbers, as for the first atom");
}

#[test]
fn empty_missing_unknown_and_binary_files_are_told_apart() {
    for (name, text) in
        [("a.xyz", ""), ("a.xyz", "\n \n"), ("a.data", ""), ("a.data", "\n\n"), ("a.gro", ""), ("a.gro", "\n")]
    {
        let error = read_text(name, text).unwrap_err();
        assert!(matches!(error, IoError::Empty { .. }), "{name} {text:?}: {error}");
        assert!(error.to_string().ends_with(&format!("{name} is empty")), "{error}");
    }
    let error = read("no/such/file.xyz", &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().starts_with("cannot open no/such/file.xyz: "), "{error}");
    let error = read_text("a.pdb", "1\n").unwrap_err();
    assert!(error.to_string().contains("the known extensions are .xyz, .extxyz"), "{error}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.xyz");
    std::fs::write(&path, b"1\n\nAr 0 \xff 0\n").unwrap();
    let error = read(&path, &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().ends_with("a.xyz:3: this is not text (invalid UTF-8)"), "{error}");
    std::fs::write(folder.path().join("a.gro"), "x").unwrap();
    let options = ReadOptions { frame: Frame::Index(3), ..Default::default() };
    let error = read(folder.path().join("a.gro"), &options).unwrap_err();
    assert!(matches!(error, IoError::SingleFrame { .. }), "{error}");
}

#[test]
fn what_a_format_cannot_hold_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let atom = Configuration::at([[0.0; 3]]);
    let unnamed = Configuration { species: Species { names: vec!["a b".into()], of: vec![0] }, ..atom.clone() };
    let uneven = Configuration { id: Some(vec![]), ..atom.clone() };
    let kindless = Configuration { species: Species { names: vec![], of: vec![0] }, ..atom.clone() };
    let cases = [
        ("a.data", &atom, "needs a box"),
        ("a.gro", &atom, "read only"),
        ("a.xyz", &unnamed, "species name `a b`"),
        ("a.xyz", &uneven, "ids has 0 entries, but there are 1 particles"),
        ("a.xyz", &kindless, "the species of particle 0 has no name"),
    ];
    for (name, configuration, reason) in cases {
        let path = folder.path().join(name);
        let error = write(&path, configuration).unwrap_err();
        assert!(matches!(error, IoError::Unwritable { .. }) && error.to_string().contains(reason), "{error}");
        assert!(!path.exists());
    }
    let error = write(folder.path().join("no/such/folder.xyz"), &atom).unwrap_err();
    assert!(matches!(error, IoError::Write { .. }), "{error}");
}
