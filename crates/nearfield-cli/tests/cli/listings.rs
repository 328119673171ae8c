//! `devices`, `methods`, help, and pipes that close early.

use crate::command::Folder;
use std::{collections::BTreeSet, io::Read, process::Stdio};

fn keys(value: &serde_json::Value) -> BTreeSet<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn every_method_is_listed_with_what_it_supports() {
    let folder = Folder::new();
    let text = folder.succeed("methods").stdout;
    let json: serde_json::Value = serde_json::from_str(&folder.succeed("methods --json").stdout).unwrap();
    let names: Vec<&str> = json.as_array().unwrap().iter().map(|m| m["method"].as_str().unwrap()).collect();
    let all: Vec<&str> = nearfield_core::Method::ALL.iter().map(|method| method.name()).collect();
    assert_eq!(names, [&all[..], &all[..]].concat(), "on the CPU, then on CUDA");
    for method in json.as_array().unwrap() {
        let words = ["method", "device"].map(|key| method[key].as_str().unwrap());
        assert!(text.lines().any(|line| line.split_whitespace().take(2).eq(words)), "{words:?} in {text}");
        assert!(keys(method).is_superset(&BTreeSet::from(["method", "device", "sentence", "variable_radii"])));
    }
}

#[test]
fn every_device_is_listed_usable_or_with_a_reason() {
    let folder = Folder::new();
    let json: serde_json::Value = serde_json::from_str(&folder.succeed("devices --json").stdout).unwrap();
    let devices = json.as_array().unwrap();
    assert!(devices.iter().any(|device| device["name"] == "cpu" && device["usable"] == true));
    assert!(devices.iter().all(|device| !device["detail"].as_str().unwrap().is_empty()));
    for device in devices.iter().filter(|device| device["name"].as_str().unwrap().starts_with("cuda")) {
        if device["usable"] == true {
            assert!(keys(device).is_superset(&BTreeSet::from([
                "model",
                "memory",
                "compute_capability",
                "ray_tracing"
            ])));
        } else {
            assert!(device["detail"].as_str().unwrap().contains("NVIDIA driver"), "what was looked for: {device}");
        }
    }
    let text = folder.succeed("devices").stdout;
    assert_eq!(text.lines().count(), devices.len(), "one line each: {text}");
}

#[test]
fn help_names_every_option_of_the_contract() {
    let folder = Folder::new();
    let options = [
        ("run", "CONFIG --set KEY=VALUE --device --method --steps --output DIR --resume --print-config"),
        (
            "forces",
            "INPUT --config --cutoff --epsilon --sigma --truncation cut energy force --boundary --images --order \
             --device --method --output forces.csv --json",
        ),
        (
            "neighbors",
            "INPUT --cutoff --half --boundary --images --order --device --method --output pairs.csv pairs.npz --json",
        ),
        (
            "generate",
            "KIND -n --box X,Y,Z --radii DIST --seed -o fcc lattice disordered cluster uniform sphere-surface",
        ),
        ("devices", "--json"),
        ("methods", "--json"),
    ];
    let all = folder.succeed("--help").stdout;
    for (command, words) in options {
        assert!(all.contains(command), "{all}");
        let help = folder.succeed(&format!("{command} --help")).stdout;
        for word in words.split_whitespace() {
            assert!(help.contains(word), "{command} --help does not mention {word}:\n{help}");
        }
    }
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let folder = Folder::new();
    for line in [&["methods"][..], &["methods", "--json"], &["run", "--print-config"], &["--help"]] {
        let mut child = folder.command(line).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let mut stderr = String::new();
        child.stderr.take().unwrap().read_to_string(&mut stderr).unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(0), "{line:?}: {stderr}");
        assert_eq!(stderr, "", "{line:?}");
    }
}

#[test]
fn closed_error_output_changes_no_exit_code() {
    let folder = Folder::new();
    folder.write("run.toml", "[system.generate]\npositions = \"fcc\"\nn = 108\ndensity = 0.8\n[dynamics]\nsteps = 2\n");
    folder.write("two.xyz", "2\n\nA 0 0 0\nA 1 0 0\n");
    for (line, code) in [
        (&["run", "run.toml", "--set", "interaction.cutoff=2.0"][..], 0),
        (&["run", "run.toml", "--set", "interaction.cutoff=20.0"], 2),
        (&["generate", "fcc", "-n", "4", "--density", "1", "-o", "a.xyz"], 0),
        (&["neighbors", "gone.xyz", "--cutoff", "1"], 2),
    ] {
        let mut child = folder.command(line).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stderr.take());
        assert_eq!(child.wait().unwrap().code(), Some(code), "{line:?}");
    }
}
