//! `forces` and `neighbors`: their files and JSON against brute force in float64.

use crate::command::Folder;
use nearfield::{
    Boundary, Interaction, Particles, Radii, SimBox, System, Truncation, generate::Generate, io::Configuration,
};
use nearfield_core::oracle;
use std::collections::BTreeSet;

const METHODS: [&str; 9] =
    ["auto", "brute", "cell", "rt-list", "rt-forces", "rt-perse", "rt-boxes", "rt-spheres", "rt-squares"];

/// A disordered periodic fluid that is far from any overlap.
fn fluid(boundary: [Boundary; 3]) -> System {
    let spec = Generate { n: 500, density: Some(0.6), temperature: 1.0, ..Generate::default() };
    let start = spec.build(boundary, 1.0).unwrap();
    let mut particles = start.particles;
    let lengths = start.sim_box.lengths();
    for i in 0..particles.len() {
        let mut at = particles.position.get(i);
        for (axis, x) in at.iter_mut().enumerate() {
            // Velocities are as good as any other noise.
            *x = (*x + 0.1 * particles.velocity.get(i)[axis].clamp(-2.0, 2.0)).clamp(0.0, 0.999 * lengths[axis]);
        }
        particles.position.set(i, at);
    }
    System { sim_box: start.sim_box, particles, radii: Radii::Uniform(2.5), interaction: Interaction::lennard_jones() }
}

fn write(folder: &Folder, name: &str, system: &System) {
    nearfield::io::write(folder.path(name), &Configuration::from(system)).unwrap();
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn keys(value: &serde_json::Value) -> BTreeSet<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

fn rows(text: &str) -> Vec<Vec<f64>> {
    text.lines().skip(1).map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect()
}

#[test]
fn forces_of_every_method_are_those_of_brute_force() {
    let folder = Folder::new();
    for (letters, boundary) in [
        ("ppp", [Boundary::Periodic; 3]),
        ("ooo", [Boundary::Open; 3]),
        ("ppw", [Boundary::Periodic, Boundary::Periodic, Boundary::Wall]),
    ] {
        let system = fluid(boundary);
        write(&folder, "fluid.xyz", &system);
        let expected = oracle::evaluate(&system);
        for method in METHODS {
            let line = format!("forces fluid.xyz --boundary {letters} --method {method} --json --output forces.csv");
            let summary = json(&folder.succeed(&line).stdout);
            assert_eq!(
                keys(&summary),
                BTreeSet::from([
                    "n",
                    "pairs",
                    "potential_energy",
                    "virial",
                    "max_force",
                    "device",
                    "method",
                    "seconds"
                ])
            );
            assert_eq!((summary["n"].as_u64(), summary["pairs"].as_u64()), (Some(500), Some(expected.pairs)), "{line}");
            let near = |key: &str, value: f64, scale: f64| {
                let found = summary[key].as_f64().unwrap();
                assert!((found - value).abs() <= 1e-5 * scale, "{line}: {key} {found}, expected {value}");
            };
            near("potential_energy", expected.potential_energy, expected.energy_magnitude);
            near("virial", expected.virial, expected.virial_magnitude);
            let largest =
                expected.force.iter().map(|f| f.iter().map(|x| x * x).sum::<f64>().sqrt()).fold(0.0, f64::max);
            near("max_force", largest, largest);

            let text = folder.read("forces.csv");
            assert_eq!(text.lines().next(), Some("id,fx,fy,fz,energy,neighbors"));
            let rows = rows(&text);
            assert_eq!(rows.len(), 500);
            for (i, row) in rows.iter().enumerate() {
                assert_eq!((row[0], row[5]), (i as f64, f64::from(expected.neighbors[i])), "{line}");
                assert!((row[4] - expected.energy[i]).abs() < 1e-3, "{line}: energy of particle {i}");
                for axis in 0..3 {
                    let error = (row[1 + axis] - expected.force[i][axis]).abs();
                    assert!(error <= 2e-5 * expected.magnitude[i], "{line}: force on particle {i} off by {error}");
                }
            }
        }
    }
}

#[test]
fn interaction_options_and_configuration_files_mean_the_same() {
    let folder = Folder::new();
    let mut system = fluid([Boundary::Periodic; 3]);
    write(&folder, "fluid.xyz", &system);
    system.radii = Radii::Uniform(3.0);
    system.interaction.truncation = Truncation::Force;
    system.interaction.types[0].epsilon = 0.5;
    system.interaction.types[0].sigma = 0.9;
    let expected = oracle::evaluate(&system);
    let config =
        "[interaction]\ncutoff = 3.0\ntruncation = \"force\"\n[[interaction.type]]\nepsilon = 0.5\nsigma = 0.9\n";
    folder.write("lj.toml", config);
    for options in ["--cutoff 3 --epsilon 0.5 --sigma 0.9 --truncation force", "--config lj.toml"] {
        let summary = json(&folder.succeed(&format!("forces fluid.xyz {options} --json")).stdout);
        let found = summary["potential_energy"].as_f64().unwrap();
        let error = (found - expected.potential_energy).abs();
        assert!(error < 1e-5 * expected.energy_magnitude, "{options}: {found}, expected {}", expected.potential_energy);
    }
}

#[test]
fn pairs_of_every_method_image_and_order_are_those_of_brute_force() {
    let folder = Folder::new();
    let system = fluid([Boundary::Periodic; 3]);
    write(&folder, "fluid.xyz", &system);
    let expected: Vec<Vec<f64>> = oracle::pairs(&system.sim_box, &system.particles, &Radii::Uniform(1.5))
        .iter()
        .map(|pair| [f64::from(pair.i), f64::from(pair.j)].into_iter().chain(pair.image.map(f64::from)).collect())
        .collect();
    for method in METHODS {
        let variants = if method.starts_with("rt-") { &["gamma", "instances", "ghosts"][..] } else { &["auto"] };
        for images in variants {
            for order in ["none", "morton", "cell"] {
                let line = format!(
                    "neighbors fluid.xyz --cutoff 1.5 --half --images {images} --order {order} --method {method} \
                     --output half.csv --json"
                );
                let summary = json(&folder.succeed(&line).stdout);
                assert_eq!(summary["pairs"].as_u64(), Some(expected.len() as u64), "{line}");
                let text = folder.read("half.csv");
                assert_eq!(text.lines().next(), Some("i,j,distance,sx,sy,sz"));
                let mut found = rows(&text);
                let sorted = found.windows(2).all(|w| w[0][..2] < w[1][..2]);
                assert!(sorted, "{line}: rows are in order");
                for row in &mut found {
                    let distance = row.remove(2);
                    assert!((0.0..1.5).contains(&distance), "{line}");
                }
                assert_eq!(found, expected, "{line}");
            }
        }
    }
}

#[test]
fn a_full_list_has_each_pair_both_ways_and_the_summary_counts_it_once() {
    let folder = Folder::new();
    // 0 and 1 are neighbours through the face, 1 and 2 within the box.
    folder.write("four.xyz", "4\nLattice=\"10 0 0 0 10 0 0 0 10\"\nA 0.5 5 5\nA 9.5 5 5\nA 8 5 5\nA 5 1 1\n");
    let full = folder.succeed("neighbors four.xyz --cutoff 2 --output full.csv --json").stdout;
    assert_eq!(
        folder.read("full.csv"),
        "i,j,distance,sx,sy,sz\n0,1,1.0,-1,0,0\n1,0,1.0,1,0,0\n1,2,1.5,0,0,0\n2,1,1.5,0,0,0\n"
    );
    let half = folder.succeed("neighbors four.xyz --cutoff 2 --half --output half.csv --json").stdout;
    assert_eq!(folder.read("half.csv"), "i,j,distance,sx,sy,sz\n0,1,1.0,-1,0,0\n1,2,1.5,0,0,0\n");
    for text in [full, half] {
        let summary = json(&text);
        assert_eq!(keys(&summary), BTreeSet::from(["n", "pairs", "min", "max", "mean", "device", "method", "seconds"]));
        assert_eq!(
            ["n", "pairs", "min", "max", "mean"].map(|key| summary[key].as_f64().unwrap()),
            [4.0, 2.0, 0.0, 2.0, 1.0]
        );
        assert_eq!(summary["method"], "cell");
    }
    let open = "neighbors four.xyz --cutoff 2 --boundary ooo --output open.csv";
    folder.succeed(open);
    assert_eq!(folder.read("open.csv"), "i,j,distance\n1,2,1.5\n2,1,1.5\n");
}

#[test]
fn pairs_are_written_as_arrays_for_numpy() {
    fn array<T: npyz::Deserialize>(folder: &Folder, name: &str) -> (Vec<u64>, Vec<T>) {
        let mut archive = zip::ZipArchive::new(std::fs::File::open(folder.path("pairs.npz")).unwrap()).unwrap();
        let array = npyz::NpyFile::new(archive.by_name(&format!("{name}.npy")).unwrap()).unwrap();
        (array.shape().to_vec(), array.into_vec().unwrap())
    }
    let folder = Folder::new();
    folder.write("three.xyz", "3\nLattice=\"10 0 0 0 10 0 0 0 10\"\nA 0.5 5 5\nA 9.5 5 5\nA 5 1 1\n");
    folder.succeed("neighbors three.xyz --cutoff 2 --output pairs.npz");
    assert_eq!(array::<u32>(&folder, "i"), (vec![2], vec![0, 1]));
    assert_eq!(array::<u32>(&folder, "j"), (vec![2], vec![1, 0]));
    assert_eq!(array::<f32>(&folder, "distance"), (vec![2], vec![1.0, 1.0]));
    assert_eq!(array::<i8>(&folder, "shift"), (vec![2, 3], vec![-1, 0, 0, 1, 0, 0]));
}

#[test]
fn standard_input_is_extended_xyz_and_named_in_errors() {
    let folder = Folder::new();
    let outcome = folder.run_with_input("neighbors - --cutoff 1.5 --json", "2\n\nA 0 0 0\nA 1 0 0\n");
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_eq!(json(&outcome.stdout)["pairs"].as_u64(), Some(1));
    let outcome = folder.run_with_input("forces - --cutoff 1.5", "2\n\nA 0 0 0\nA 1 x 0\n");
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.stderr.contains("standard input:4: y of particle 1: `x` is not a number"), "{}", outcome.stderr);
    let outcome = folder.run_with_input("forces - --cutoff 1.5", "2\n\nA 0 0 0\nA 0 0 0\n");
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.stderr.contains("standard input: particles 0 and 1"), "{}", outcome.stderr);
}

#[test]
fn radii_of_the_input_replace_the_cutoff() {
    let folder = Folder::new();
    let particles = Particles::at([[1.0; 3], [2.0, 1.0, 1.0], [4.0, 1.0, 1.0]]);
    let radii = Radii::PerParticle(vec![0.5, 0.9, 3.1]);
    let sim_box = SimBox::cubic(10.0, Boundary::Periodic).unwrap();
    let system = System { sim_box, particles, radii, interaction: Interaction::lennard_jones() };
    write(&folder, "radii.xyz", &system);
    let outcome = folder.succeed("neighbors radii.xyz --cutoff 0.1 --half --output pairs.csv");
    assert!(outcome.stderr.contains("own radius, 0.5 to 3.1; the cutoff is not used"), "{}", outcome.stderr);
    assert_eq!(folder.read("pairs.csv"), "i,j,distance,sx,sy,sz\n0,2,3.0,0,0,0\n1,2,2.0,0,0,0\n");
    let summary = json(&folder.succeed("forces radii.xyz --json").stdout);
    let expected = oracle::evaluate(&system);
    let found = summary["potential_energy"].as_f64().unwrap();
    assert!((found - expected.potential_energy).abs() < 1e-5 * expected.energy_magnitude, "{found}");
}

#[test]
fn every_generator_writes_a_file_that_reads_back() {
    let folder = Folder::new();
    for (kind, options) in [
        ("fcc", "-n 32 --density 0.8 -o a.data"),
        ("lattice", "-n 27 --box 6,6,6 --boundary www -o a.xyz"),
        ("disordered", "-n 50 --box 6,6,8 --seed 3 -o a.extxyz"),
        ("cluster", "-n 50 --box 60,60,60 --spread 4 --center 30,30,30 --radii lognormal:0,1,0.5,9,clamp -o a.xyz"),
        ("uniform", "-n 50 --box 60,60,60 --radii uniform:1,5 --temperature 2 -o a.xyz"),
        ("sphere-surface", "-n 64 --box 4,4,4 --boundary ooo -o a.lmp"),
    ] {
        let file = options.rsplit(' ').next().unwrap();
        let outcome = folder.succeed(&format!("generate {kind} {options}"));
        assert!(outcome.stderr.contains("particles to"), "{}", outcome.stderr);
        let summary = json(&folder.succeed(&format!("neighbors {file} --cutoff 1 --json")).stdout);
        let n: u64 = options.split_whitespace().nth(1).unwrap().parse().unwrap();
        assert_eq!(summary["n"].as_u64(), Some(n), "{kind}");
        let first = folder.read(file);
        folder.succeed(&format!("generate {kind} {options}"));
        assert_eq!(folder.read(file), first, "{kind}: the same seed gives the same file");
    }
}

/// On a machine without one of them its name falls back to the best there is, and the comparison is trivial.
#[test]
fn every_instruction_set_gives_the_same_bits() {
    let folder = Folder::new();
    write(&folder, "fluid.xyz", &fluid([Boundary::Periodic; 3]));
    for method in METHODS {
        let mut outputs = Vec::new();
        for simd in ["AVX-512", "AVX2", "portable"] {
            let line = format!("forces fluid.xyz --method {method} --output {simd}.csv");
            let words: Vec<&str> = line.split(' ').collect();
            let status = folder.command(&words).env("NEARFIELD_SIMD", simd).output().unwrap().status;
            assert!(status.success(), "{method} {simd}");
            outputs.push(folder.read(&format!("{simd}.csv")));
        }
        assert!(outputs.iter().all(|output| *output == outputs[0]), "{method}");
    }
}
