//! `nearfield bench` and `nearfield plot`.

use crate::command::Folder;

const TINY: &str = "bench md --quick --device cpu -n 108 --seconds 0.001 -o out";

#[test]
fn a_suite_is_measured_once_and_drawn() {
    let folder = Folder::new();
    let first = folder.succeed(TINY);
    assert!(first.stdout.starts_with("md ") && first.stdout.contains("measured"), "{}", first.stdout);
    let second = folder.succeed(TINY);
    assert!(second.stdout.contains("in the file already") && !second.stdout.contains("measured"), "{}", second.stdout);
    let plot = folder.succeed("plot out -o report");
    assert!(plot.stdout.lines().next().unwrap().ends_with("report.html"), "{}", plot.stdout);
    assert!(folder.read("report/report.html").contains("figure-md"));
    assert!(folder.path("report/md.png").is_file());
}

#[test]
fn a_method_that_finds_other_pairs_fails_the_command() {
    let folder = Folder::new();
    folder.succeed(&format!("{TINY} --method cell"));
    let text = folder.read("out/md.jsonl");
    let mut record: serde_json::Value = serde_json::from_str(text.lines().next().unwrap()).unwrap();
    record["pairs"] = 1.into();
    folder.write("out/md.jsonl", format!("{record}\n"));
    let outcome = folder.run(&format!("{TINY} --method cell"));
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("another number of pairs"), "{}", outcome.stderr);
}

#[test]
fn unknown_suites_and_empty_folders_are_refused() {
    let folder = Folder::new();
    let outcome = folder.run("bench fast -o out");
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.stderr.contains("policies") && outcome.stderr.contains("all"), "{}", outcome.stderr);
    let outcome = folder.run("plot .");
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.stderr.contains("no results"), "{}", outcome.stderr);
}

#[test]
fn the_cost_model_is_fitted_to_this_machine_and_serves_the_next_run() {
    let folder = Folder::new();
    let outcome = folder.succeed("bench auto --quick --device cpu");
    for method in ["brute", "cell", "cluster", "rt-list", "rt-boxes"] {
        assert!(outcome.stdout.contains(method), "{}", outcome.stdout);
    }
    // What `NEARFIELD_PROFILE` names.
    let profile = folder.read("profile.toml");
    assert!(profile.contains("[device.method.cell]") && profile.contains("per_thread = true"), "{profile}");
    folder.write("start.toml", "[system.generate]\nn = 500\ndensity = 0.8442\n");
    folder.succeed("run start.toml --device cpu --steps 2");
    folder.succeed("bench auto --quick --device cpu -o elsewhere");
    assert!(folder.path("elsewhere/profile.toml").is_file());
}

#[test]
fn suites_need_a_folder_for_their_results() {
    Folder::new().refuse("bench md --quick --device cpu", &["--output"]);
}
