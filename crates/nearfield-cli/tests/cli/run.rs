//! `run`: its files, its record, and how it stops.

use crate::command::Folder;
use nearfield::io::Frames;
use std::fs;

/// 500 particles of a liquid.
pub const MELT: &str = "[system.generate]\npositions = \"fcc\"\nn = 500\ndensity = 0.8442\ntemperature = 1.44\n\
                        [output]\nthermo_every = 10\ntrajectory_every = 20\n";

fn thermo(folder: &Folder, name: &str) -> Vec<Vec<f64>> {
    let text = folder.read(name);
    let mut lines = text.lines();
    assert!(
        lines
            .next()
            .unwrap()
            .starts_with("step,time,temperature,kinetic_energy,potential_energy,total_energy,pressure")
    );
    lines.map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect()
}

#[test]
fn a_run_writes_what_the_contract_says() {
    let folder = Folder::new();
    folder.write("melt.toml", MELT);
    let outcome = folder.succeed("run melt.toml --steps 60 --set output.msd_every=20 --set output.rdf_every=20");
    assert!(outcome.stdout.contains("60 steps of 500 particles"), "{}", outcome.stdout);
    assert!(outcome.stderr.contains("steps 0 to 60, output in out"), "{}", outcome.stderr);
    for file in ["thermo.csv", "trajectory.xyz", "run.json", "checkpoint.nearfield"] {
        assert!(outcome.stdout.contains(file), "the summary names {file}: {}", outcome.stdout);
    }
    let rows = thermo(&folder, "out/thermo.csv");
    let steps: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(steps, [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0]);
    assert!(rows.iter().all(|row| (row[5] - row[3] - row[4]).abs() < 1e-9 && row[1] == row[0] * 0.005));

    let frames: Vec<_> = Frames::open(folder.path("out/trajectory.xyz")).unwrap().map(Result::unwrap).collect();
    assert_eq!(frames.iter().map(|frame| frame.step.unwrap()).collect::<Vec<_>>(), [0, 20, 40, 60]);
    assert!(frames.iter().all(|frame| frame.len() == 500 && frame.id.as_ref().unwrap().is_sorted()));

    let record = folder.json("out/run.json");
    assert_eq!(record["status"], "finished");
    assert_eq!(record["n_particles"], 500);
    assert_eq!(record["steps"], 60);
    assert_eq!(record["config"]["dynamics"]["dt"], 0.005);
    assert_eq!(record["config"]["interaction"]["cutoff"], 2.5);
    assert_eq!(record["config"]["dynamics"]["steps"], 60);
    assert_eq!(record["report"]["evaluations"].as_u64(), Some(61));
    for key in ["versions", "device", "method", "plan", "wall_seconds", "energy_joules", "thermo"] {
        assert!(record.get(key).is_some(), "run.json has no {key}: {record}");
    }
    assert!(record["method"]["reason"].as_str().unwrap().contains("predicted to be the fastest"), "{record}");
    assert_eq!(folder.read("out/msd.csv").lines().count(), 5);
    assert_eq!(folder.read("out/rdf.csv").lines().count(), 201);
    let files = fs::read_dir(folder.path("out")).unwrap().count();
    assert_eq!(files, 6, "nothing temporary is left");
}

#[test]
fn the_profile_of_the_machine_decides_and_explain_shows_what_it_says() {
    let folder = Folder::new();
    let profile = |method: &str, pair: f64| {
        let cost = |pair: f64| format!("{{ step = 1e-6, particle = 1e-9, pair = {pair:e} }}");
        format!("[[device]]\nname = \"cpu\"\n[device.method]\ncell = {}\n{method} = {}\n", cost(1e-9), cost(pair))
    };
    folder.write("melt.toml", MELT).write("profile.toml", profile("rt-boxes", 1e-10));
    let outcome = folder.succeed("run melt.toml --device cpu --steps 5 --explain");
    for word in ["method rt-boxes: predicted to be the fastest", "500 particles, one radius", "predicted ms", "cell"] {
        assert!(outcome.stderr.contains(word), "expected `{word}` in {}", outcome.stderr);
    }
    assert_eq!(folder.json("out/run.json")["method"]["candidates"].as_array().unwrap().len(), 2);
    folder.write("profile.toml", profile("octree", 1e-10));
    folder.refuse("run melt.toml --device cpu --steps 5", &["profile.toml", "octree", "nearfield bench auto"]);
}

#[test]
fn a_printed_configuration_runs() {
    let folder = Folder::new();
    folder.write("melt.toml", MELT);
    let text = folder.succeed("run melt.toml --print-config --steps 3 --method cell").stdout;
    assert!(!folder.path("out").exists());
    folder.write("full.toml", &text).succeed("run full.toml");
    assert_eq!(folder.json("out/run.json")["steps"], 3);
    assert_eq!(folder.json("out/run.json")["method"]["method"], "cell");
    assert!(folder.succeed("run --print-config").stdout.contains("[system.generate]"));
}

#[test]
fn an_earlier_run_is_kept_under_another_name() {
    let folder = Folder::new();
    folder.write("melt.toml", MELT).succeed("run melt.toml --steps 1 --method cell");
    let first = folder.read("out/run.json");
    let outcome = folder.succeed("run melt.toml --steps 2 --method cell");
    assert!(outcome.stderr.contains("an earlier run in out was moved to out.1"), "{}", outcome.stderr);
    assert_eq!(folder.read("out.1/run.json"), first);
    folder.succeed("run melt.toml --steps 1 --method cell --output out");
    assert_eq!(folder.json("out.2/run.json")["steps"], 2);
}

#[test]
fn a_run_in_the_present_directory_never_moves_it() {
    let folder = Folder::new();
    folder.write("melt.toml", MELT).succeed("run melt.toml --steps 1 --method cell --output .");
    folder.refuse("run melt.toml --steps 1 --method cell --output .", &["holds an earlier run", "another"]);
    folder.refuse("run melt.toml --steps 1 --method cell --output ./.", &["holds an earlier run"]);
    folder.succeed("run melt.toml --steps 2 --method cell --output . --resume");
}

#[test]
fn files_that_are_no_earlier_run_are_never_overwritten() {
    let folder = Folder::new();
    folder.write("melt.toml", MELT).write("trajectory.xyz", "the user's own");
    folder.refuse("run melt.toml --method cell --output .", &["holds trajectory.xyz", "another output directory"]);
    folder.succeed("run melt.toml --method cell --steps 1 --output . --set output.trajectory=t.xyz");
    assert_eq!(folder.read("trajectory.xyz"), "the user's own");
}

#[test]
fn a_run_that_blows_up_names_step_particle_and_checkpoint_and_leaves_readable_files() {
    for method in ["brute", "cell", "rt-list", "rt-forces", "rt-perse", "rt-boxes", "rt-spheres", "rt-squares"] {
        let folder = Folder::new();
        folder.write("melt.toml", MELT);
        let line = format!("run melt.toml --method {method} --steps 500");
        let options = "--set dynamics.dt=0.04 --set output.thermo_every=1 --set output.checkpoint_every=1 \
                       --set output.trajectory_every=1";
        let outcome = folder.fail(1, &format!("{line} {options}"), &["step ", "particle ", "checkpoint is of step"]);
        let number_after = |word: &str| -> u64 {
            let rest = outcome.stderr.split(word).last().unwrap();
            rest.split(|c: char| !c.is_ascii_digit()).next().unwrap().parse().unwrap()
        };
        let saved = number_after("checkpoint is of step ");
        let record = folder.json("out/run.json");
        assert_eq!(record["status"], "failed", "{method}");
        assert!(outcome.stderr.contains(record["error"].as_str().unwrap()), "{method}: {record}");
        let rows = thermo(&folder, "out/thermo.csv");
        assert!(rows.iter().flatten().all(|value| value.is_finite()), "{method}");
        assert_eq!(rows.last().unwrap()[0] as u64, saved, "{method}: {}", outcome.stderr);
        let frames = Frames::open(folder.path("out/trajectory.xyz")).unwrap().map(Result::unwrap);
        assert_eq!(frames.last().unwrap().step, Some(saved), "{method}");
        // The checkpoint is good: a smaller step goes on from there as a new run would, the same step fails again.
        let again = folder.fail(1, &format!("{line} {options} --resume"), &["checkpoint is of step"]);
        let message = |text: &str| text.lines().last().unwrap().to_owned();
        assert_eq!(message(&again.stderr), message(&outcome.stderr), "{method}");
    }
    let folder = Folder::new();
    folder.write("melt.toml", MELT);
    folder.fail(1, "run melt.toml --set dynamics.dt=0.1 --method cell", &["no checkpoint had been written"]);
}

#[test]
fn lists_that_last_one_step_only_are_warned_of() {
    let folder = Folder::new();
    folder.write("melt.toml", MELT);
    let line = "run melt.toml --method rt-list --steps 20 --set method.skin=0.001";
    let outcome = folder.succeed(line);
    assert!(outcome.stderr.contains("a larger method.skin would be faster"), "{}", outcome.stderr);
    assert!(folder.json("out/run.json")["report"]["dangerous_builds"].as_u64().unwrap() > 0);
}

#[test]
fn the_skin_is_chosen_and_reported() {
    let folder = Folder::new();
    folder.write("melt.toml", MELT);
    for method in ["cluster", "rt-list"] {
        let line = format!("run melt.toml --method {method} --steps 100 --device cpu --explain --output {method}");
        let outcome = folder.succeed(&line);
        assert!(outcome.stderr.contains("chosen from what the lists before cost"), "{}", outcome.stderr);
        let record = folder.json(&format!("{method}/run.json"));
        assert_eq!(record["plan"]["skin"], "auto");
        let (skin, steps) = (record["report"]["skin"].as_f64().unwrap(), record["steps_per_list"].as_f64().unwrap());
        assert!(skin > 0.0 && skin < 1.5 && steps > 1.0, "{method}: {skin} {steps}");
        assert!(outcome.stdout.contains(&format!("lists of {steps:.1} steps")), "{}", outcome.stdout);
    }
    folder.succeed("run melt.toml --method cluster --steps 20 --device cpu --set method.skin=0.25 --output fixed");
    let record = folder.json("fixed/run.json");
    assert_eq!((&record["plan"]["skin"], &record["config"]["method"]["skin"]), (&0.25.into(), &0.25.into()));
    assert_eq!(record["report"]["skin"], 0.25);
}

#[test]
fn lists_that_may_miss_pairs_are_reported_and_others_are_stricter() {
    let folder = Folder::new();
    folder.write("melt.toml", MELT);
    let line = "run melt.toml --device cpu --steps 200 --explain --set method.list_tolerance=0.01";
    let outcome = folder.succeed(&format!("{line} --method cluster --output loose"));
    assert!(outcome.stderr.contains("lists that may miss pairs: reach "), "{}", outcome.stderr);
    let record = folder.json("loose/run.json");
    let lists = &record["report"]["tolerant_lists"];
    assert!(lists["prune_every"].as_u64().unwrap() > 1, "{lists}");
    assert!(lists["rebuild_every"].as_u64() >= lists["prune_every"].as_u64(), "{lists}");
    assert!(lists["outer_reach"].as_f64().unwrap() >= lists["inner_reach"].as_f64().unwrap(), "{lists}");
    assert!((0.0..=0.01).contains(&lists["expected_drift"].as_f64().unwrap()), "{lists}");
    for (case, output) in [("--method cell", "cell"), ("--method cluster --set method.deterministic=true", "exact")] {
        let outcome = folder.succeed(&format!("{line} {case} --output {output}"));
        assert!(!outcome.stderr.contains("may miss pairs"), "{}", outcome.stderr);
        let record = folder.json(&format!("{output}/run.json"));
        assert_eq!(record["plan"]["list_tolerance"], 0.01);
        assert!(record["report"]["tolerant_lists"].is_null());
    }
}

#[test]
fn every_example_runs() {
    let folder = Folder::new();
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    let mut names = Vec::new();
    for entry in fs::read_dir(examples).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        folder.succeed(&format!("run {} --steps 4 --output {name} --set output.thermo_every=2", path.display()));
        let rows = thermo(&folder, &format!("{name}/thermo.csv"));
        assert_eq!(rows.iter().map(|row| row[0]).collect::<Vec<_>>(), [0.0, 2.0, 4.0], "{name}");
        assert!(rows.iter().flatten().all(|value| value.is_finite()), "{name}");
        let frame = Frames::open(folder.path(format!("{name}/trajectory.xyz"))).unwrap().next().unwrap().unwrap();
        assert_eq!(frame.len() as u64, folder.json(&format!("{name}/run.json"))["n_particles"].as_u64().unwrap());
        names.push(name);
    }
    names.sort();
    assert_eq!(names, ["droplet", "melt", "polydisperse", "slab"]);
}
