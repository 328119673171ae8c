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
