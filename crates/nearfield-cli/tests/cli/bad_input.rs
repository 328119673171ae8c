//! Each mistake is one clear sentence and exit code 2, and nothing is written or lost.

use crate::command::Folder;

/// Three particles in a periodic cube of length 10.
const GOOD: &str = "3\nLattice=\"10 0 0 0 10 0 0 0 10\" Properties=species:S:1:pos:R:3 pbc=\"T T T\"\n\
                    A 1 1 1\nA 2 1 1\nA 5 5 5\n";

/// A short run of 108 particles.
const RUN: &str = "[system.generate]\npositions = \"fcc\"\nn = 108\ndensity = 0.8\ntemperature = 1.0\n\
                   [interaction]\ncutoff = 2.0\n[method]\nname = \"cell\"\n[dynamics]\nsteps = 5\n";

#[test]
fn a_wrong_file_is_refused_naming_particle_and_line() {
    let folder = Folder::new();
    let lattice = |comment: &str, atoms: &str| format!("2\n{comment}\n{atoms}\n");
    let cubic = "Lattice=\"10 0 0 0 10 0 0 0 10\" Properties=species:S:1:pos:R:3";
    let cases = [
        (lattice(cubic, "A 1 1 1\nA nan 1 1"), ["bad.xyz:4:", "x of particle 1 is nan"]),
        (lattice(cubic, "A 1 -inf 1\nA 1 1 1"), ["bad.xyz:3:", "y of particle 0 is -inf"]),
        (lattice(cubic, "A 1 1 1\nA 1 1"), ["bad.xyz:4:", "expected 4 fields (species:S:1:pos:R:3), found 3"]),
        (lattice(cubic, "A 1 1 1"), ["bad.xyz:3:", "expected 2 atoms, found only 1"]),
        (lattice(cubic, "A 1 1 1\nA 2 2 2\nA 3 3 3"), ["bad.xyz:5:", "expected the number of atoms of the next frame"]),
        (lattice(cubic, "A 1 1 1\nA 1 one 1"), ["bad.xyz:4:", "`one` is not a number"]),
        (
            lattice("Lattice=\"10 0 0 0 0 0 0 0 10\"", "A 1 1 1\nA 2 2 2"),
            ["bad.xyz:2:", "must be finite and have positive length"],
        ),
        (lattice("Lattice=\"10 0 0 0 10 0 0 0 -3\"", "A 1 1 1\nA 2 2 2"), ["bad.xyz:2:", "axis z"]),
        (lattice("Lattice=\"10 1 0 0 10 0 0 0 10\"", "A 1 1 1\nA 2 2 2"), ["bad.xyz:2:", "only orthorhombic boxes"]),
        (
            lattice("Lattice=\"10 0 0 0 10 0 0 0 10\" Properties=pos:R:3:radius:R:1", "1 1 1 1\n2 2 2 0"),
            ["bad.xyz: particle 1", "radius 0 must be positive"],
        ),
        (
            lattice("Lattice=\"10 0 0 0 10 0 0 0 10\" Properties=pos:R:3:radius:R:1", "1 1 1 -1\n2 2 2 1"),
            ["bad.xyz: particle 0", "radius -1 must be positive"],
        ),
        (
            lattice("Lattice=\"10 0 0 0 10 0 0 0 10\" Properties=pos:R:3:radius:R:1", "1 1 1 NaN\n2 2 2 1"),
            ["bad.xyz:3:", "radius of particle 0 is NaN"],
        ),
        (
            lattice("Lattice=\"10 0 0 0 10 0 0 0 10\" Properties=pos:R:3:radius:R:1", "1 1 1 1\n2 2 2 5.5"),
            ["radius of particle 1", "exceeds half the periodic length of axis x"],
        ),
    ];
    for (text, words) in cases {
        folder.write("bad.xyz", &text).write("run.toml", "[system]\ninput = \"bad.xyz\"");
        folder.refuse("neighbors bad.xyz --cutoff 1 --output pairs.csv", &words);
        folder.refuse("forces bad.xyz --cutoff 1 --output forces.csv", &words);
        folder.refuse("run run.toml", &words);
    }
}

#[test]
fn a_missing_unknown_or_foreign_file_is_named() {
    let folder = Folder::new();
    folder.write("image.png", [0x89, 0x50]).write("binary.xyz", [0xff, 0xfe, 0x00]).write("nothing.xyz", "");
    folder.write("run.toml", "[system]\ninput = \"gone.xyz\"");
    folder.refuse("neighbors gone.xyz --cutoff 1", &["cannot open gone.xyz: No such file"]);
    folder.refuse("forces image.png", &["image.png: unknown file format", ".xyz"]);
    folder.refuse("neighbors binary.xyz --cutoff 1", &["binary.xyz:1: this is not text"]);
    folder.refuse("neighbors nothing.xyz --cutoff 1", &["nothing.xyz is empty"]);
    folder.refuse("neighbors . --cutoff 1", &["unknown file format"]);
    folder.refuse("run gone.toml", &["error: cannot read gone.toml: No such file"]);
    folder.refuse("run run.toml", &["cannot open gone.xyz: No such file"]);
    folder.refuse("forces --config gone.toml nothing.xyz", &["gone.toml", "No such file"]);
}

#[test]
fn a_cutoff_must_be_positive_finite_and_within_half_the_box() {
    let folder = Folder::new();
    folder.write("good.xyz", GOOD);
    for cutoff in ["0", "-1", "nan", "inf", "1e39", "1e-60"] {
        folder.refuse(
            &format!("neighbors good.xyz --cutoff {cutoff} --output pairs.csv"),
            &["must be positive and finite"],
        );
        folder.refuse(&format!("forces good.xyz --cutoff {cutoff}"), &["cutoff", "must be positive and finite"]);
    }
    let half = ["cutoff 5.01 exceeds half the periodic length of axis x (10 / 2 = 5)"];
    folder.refuse("neighbors good.xyz --cutoff 5.01", &half);
    folder.refuse("forces good.xyz --cutoff 5.01", &half);
    folder.succeed("neighbors good.xyz --cutoff 5");
    folder.refuse("neighbors good.xyz --cutoff two", &["--cutoff", "two"]);
    folder.refuse("neighbors good.xyz", &["--cutoff"]);
    folder.write("run.toml", RUN);
    for (value, words) in [
        ("0", "must be positive and finite"),
        ("-2.5", "must be positive and finite"),
        ("nan", "must be positive and finite"),
        ("50", "exceeds half the periodic length"),
    ] {
        folder.refuse(&format!("run run.toml --set interaction.cutoff={value}"), &["cutoff", words]);
    }
}

#[test]
fn a_box_must_have_positive_lengths() {
    let folder = Folder::new();
    for lengths in ["0,10,10", "10,-1,10", "10,10,nan", "inf,1,1"] {
        folder.refuse(&format!("generate uniform -n 10 --box {lengths} -o a.xyz"), &["box"]);
        let text = format!("[system.generate]\npositions = \"uniform\"\nn = 10\nbox = [{lengths}]\n");
        folder.write("run.toml", text).refuse("run run.toml", &["box"]);
    }
    folder.refuse("generate uniform -n 10 --box 1,2 -o a.xyz", &["three numbers"]);
    folder.refuse("generate uniform -n 10 -o a.xyz", &["--box"]);
    folder.write(
        "flat.data",
        "flat\n\n1 atoms\n1 atom types\n0 0 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms\n\n1 1 0 0 0\n",
    );
    folder.refuse("neighbors flat.data --cutoff 0.1", &["flat.data", "axis x", "positive length"]);
}

#[test]
fn a_misspelt_key_is_named_with_its_line_and_the_nearest_key() {
    let folder = Folder::new();
    folder.write("run.toml", format!("{RUN}setps = 7\n"));
    folder
        .refuse("run run.toml", &["run.toml: line 12: unknown key \"setps\" in [dynamics]", "did you mean \"steps\"?"]);
    folder.write("run.toml", RUN);
    folder.refuse("run run.toml --set dynamics.td=1", &["--set dynamics.td=1", "unknown key \"td\""]);
    folder.refuse("run run.toml --set dynamics", &["write KEY=VALUE"]);
    folder.refuse("run run.toml --set dynamics.dt=fast", &["--set dynamics.dt=fast", "number"]);
    folder.refuse("run run.toml --set dynamics.dt=-1", &["dynamics.dt = -1"]);
    folder.write("run.toml", "[system\n").refuse("run run.toml", &["run.toml: line 1"]);
    folder.write("run.toml", "").refuse("run run.toml", &["nothing to simulate", "system.input", "[system.generate]"]);
}

#[test]
fn an_unknown_method_device_or_word_lists_those_that_exist() {
    let folder = Folder::new();
    folder.write("good.xyz", GOOD).write("run.toml", RUN);
    let methods = ["brute", "cell", "rt-list", "rt-forces", "rt-perse", "rt-boxes", "rt-spheres", "rt-squares"];
    for line in ["run run.toml", "forces good.xyz", "neighbors good.xyz --cutoff 1"] {
        folder.refuse(&format!("{line} --method cel"), &methods);
        folder.refuse(&format!("{line} --device gpu"), &["gpu", "auto, cpu, cuda, cuda:N"]);
        folder.refuse(&format!("{line} --device cuda:99"), &["device cuda:99 is not available"]);
    }
    folder.refuse("run run.toml --set method.name=cel", &methods);
    folder.refuse("run run.toml --set method.device=gpu", &["method.device", "cpu"]);
    folder.refuse("neighbors good.xyz --cutoff 1 --images mirror", &["gamma, instances, ghosts"]);
    folder.refuse("neighbors good.xyz --cutoff 1 --order hilbert", &["none, morton, cell"]);
    folder.refuse("neighbors good.xyz --cutoff 1 --boundary ppx", &["'x' is none of p (periodic), w (wall), o (open)"]);
    folder.refuse("neighbors good.xyz --cutoff 1 --boundary pp", &["three letters"]);
    folder.refuse("forces good.xyz --truncation none", &["cut, energy, force"]);
    folder.refuse("generate hexagonal -n 10 --density 1 -o a.xyz", &["fcc", "sphere-surface"]);
    folder.refuse("generate fcc -n 4 --density 1 --radii gauss:1,2 -o a.xyz", &["lognormal"]);
    folder.refuse("simulate run.toml", &["simulate"]);
    folder.refuse("run", &["CONFIG"]);
}

#[test]
fn without_a_gpu_cuda_is_refused_with_what_was_looked_for_and_auto_is_the_cpu() {
    let folder = Folder::new();
    folder.write("good.xyz", GOOD);
    let devices: serde_json::Value = serde_json::from_str(&folder.succeed("devices --json").stdout).unwrap();
    let Some(cuda) = devices.as_array().unwrap().iter().find(|device| device["name"] == "cuda") else {
        // Only where there is no GPU is there a device without a number.
        return;
    };
    let reason = cuda["detail"].as_str().unwrap();
    assert!(reason.contains("NVIDIA driver"), "{reason}");
    for device in ["cuda", "cuda:0"] {
        let line = format!("neighbors good.xyz --cutoff 1 --device {device}");
        folder.refuse(&line, &[&format!("device {device} is not available"), reason]);
    }
    let json = folder.succeed("neighbors good.xyz --cutoff 1 --device auto --json").stdout;
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(json["device"].as_str().unwrap().starts_with("cpu"), "{json}");
}

#[test]
fn a_method_that_does_not_support_the_system_says_what_does() {
    let folder = Folder::new();
    let text = "2\nLattice=\"10 0 0 0 10 0 0 0 10\" Properties=pos:R:3:radius:R:1\n1 1 1 1\n2 2 2 2\n";
    folder.write("radii.xyz", text).write("run.toml", "[system]\ninput = \"radii.xyz\"");
    for method in ["rt-perse", "rt-boxes", "rt-spheres", "rt-squares"] {
        let words = [&format!("method {method} does not support this system")[..], "use cell, rt-list or rt-forces"];
        folder.refuse(&format!("neighbors radii.xyz --cutoff 1 --method {method} --output pairs.csv"), &words);
        folder.refuse(&format!("forces radii.xyz --method {method}"), &words);
        folder.refuse(&format!("run run.toml --method {method}"), &words);
    }
}

#[test]
fn a_place_that_cannot_be_written_is_named() {
    let folder = Folder::new();
    folder.write("good.xyz", GOOD).write("run.toml", RUN).write("file", "keep me");
    for trajectory in ["a.data", "sub/a.xyz", "/tmp/a.xyz", "..", ""] {
        folder.refuse(&format!("run run.toml --set output.trajectory={trajectory}"), &["output.trajectory"]);
    }
    folder.refuse("run run.toml --output file/out", &["cannot write file/out"]);
    folder.refuse("run run.toml --output file", &["cannot write file"]);
    folder.refuse("run run.toml --output /proc/nearfield", &["cannot write /proc/nearfield"]);
    folder.refuse("neighbors good.xyz --cutoff 1 --output file/pairs.csv", &["cannot write file/pairs.csv"]);
    folder.refuse("neighbors good.xyz --cutoff 1 --output gone/pairs.npz", &["cannot write gone/pairs.npz"]);
    folder.refuse("neighbors good.xyz --cutoff 1 --output pairs.txt", &["pairs.txt", ".csv or .npz"]);
    folder.refuse("forces good.xyz --output file/forces.csv", &["cannot write file/forces.csv"]);
    folder.refuse("forces good.xyz --output forces.npz", &["forces.npz", ".csv"]);
    folder.refuse("generate fcc -n 4 --density 1 -o file/a.xyz", &["cannot write file/a.xyz"]);
    folder.refuse("generate fcc -n 4 --density 1 -o a.gro", &["a.gro"]);
    folder.refuse("generate fcc -n 4 --density 1 -o a", &["unknown file format"]);
}

#[test]
fn an_empty_system_has_no_neighbours_and_cannot_run() {
    let folder = Folder::new();
    folder.write("empty.xyz", "0\nLattice=\"10 0 0 0 10 0 0 0 10\"\n").write("open.xyz", "0\n\n");
    for file in ["empty.xyz", "open.xyz"] {
        for method in
            ["auto", "brute", "cell", "rt-list", "rt-forces", "rt-perse", "rt-boxes", "rt-spheres", "rt-squares"]
        {
            let line = format!("neighbors {file} --cutoff 1 --json --output pairs.csv --method {method}");
            let json: serde_json::Value = serde_json::from_str(&folder.succeed(&line).stdout).unwrap();
            assert_eq!(
                (json["n"].as_u64(), json["pairs"].as_u64(), json["mean"].as_f64()),
                (Some(0), Some(0), Some(0.0))
            );
            assert_eq!(folder.read("pairs.csv").lines().count(), 1);
        }
        folder
            .write("run.toml", format!("[system]\ninput = \"{file}\"\n[boundary]\nx=\"open\"\ny=\"open\"\nz=\"open\""));
        folder.refuse("run run.toml", &["the system has no particles"]);
        folder.refuse(&format!("forces {file}"), &["the system has no particles"]);
    }
    folder.refuse("run run.toml --set system.generate.n=0", &["system.input and [system.generate]"]);
}

#[test]
fn particles_at_one_place_are_both_named_where_the_potential_diverges() {
    let folder = Folder::new();
    let text = GOOD.replace("A 5 5 5", "A 1 1 1");
    folder.write("twins.xyz", text).write("run.toml", "[system]\ninput = \"twins.xyz\"");
    for method in ["auto", "brute", "cell", "rt-list", "rt-forces", "rt-perse", "rt-boxes", "rt-spheres", "rt-squares"]
    {
        let words = ["particles 0 and 2 are at the same place", "diverges"];
        folder.refuse(&format!("forces twins.xyz --output forces.csv --method {method}"), &words);
        folder.refuse(&format!("run run.toml --method {method}"), &words);
        folder.succeed(&format!(
            "run run.toml --method {method} --output {method} --set dynamics.max_displacement=0.1 --steps 3"
        ));
        folder.succeed(&format!(
            "run run.toml --method {method} --output {method}-soft --set interaction.potential=gaussian --steps 3"
        ));
    }
    let outcome = folder.succeed("neighbors twins.xyz --cutoff 1.5 --json");
    assert!(outcome.stdout.contains("\"pairs\":3"), "{}", outcome.stdout);
}

#[test]
fn forces_too_large_for_single_precision_are_refused_before_anything_is_written() {
    let folder = Folder::new();
    folder.write("close.xyz", GOOD.replace("A 2 1 1", "A 1.00001 1 1"));
    folder.write("run.toml", "[system]\ninput = \"close.xyz\"");
    folder.refuse("run run.toml", &["step 0", "force of particle 0", "dynamics.max_displacement"]);
    folder.refuse("forces close.xyz", &["force of particle 0"]);
}

#[test]
fn a_species_without_a_type_is_named_for_forces_and_means_nothing_for_neighbours() {
    let folder = Folder::new();
    folder.write("mixed.xyz", GOOD.replace("A 5 5 5", "B 5 5 5"));
    folder.refuse("forces mixed.xyz", &["species \"A\"", "[[interaction.type]]"]);
    folder.succeed("neighbors mixed.xyz --cutoff 1.5");
}
