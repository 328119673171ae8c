//! A run that was killed or interrupted ends, after `--resume`, in the same bytes as one that was not.

use crate::{command::Folder, run::MELT};
use nearfield::{io::Frames, run::Checkpoint};
use std::{
    fs,
    process::{Child, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

/// What must be equal to the byte, beside the checkpoint.
const FILES: [&str; 4] = ["thermo.csv", "trajectory.xyz", "msd.csv", "rdf.csv"];
const OUTPUTS: &str = "--set output.msd_every=15 --set output.rdf_every=25 --set output.trajectory_every=40";

fn start(folder: &Folder, line: &str) -> Child {
    let words: Vec<&str> = line.split_whitespace().collect();
    folder.command(&words).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// Waits until the file has so many lines, or the child has ended.
fn wait_for_lines(folder: &Folder, child: &mut Child, file: &str, lines: usize) {
    let start = Instant::now();
    let count = || fs::read_to_string(folder.path(file)).map_or(0, |text| text.lines().count());
    while count() < lines && child.try_wait().unwrap().is_none() {
        assert!(start.elapsed() < Duration::from_secs(60), "{file} does not grow");
        sleep(Duration::from_millis(1));
    }
}

fn assert_same_outputs(folder: &Folder, a: &str, b: &str, what: &str) {
    let checkpoint = |output: &str| Checkpoint::read(&folder.path(output).join("checkpoint.nearfield")).unwrap();
    let (ca, cb) = (checkpoint(a), checkpoint(b));
    assert_eq!(ca.step, cb.step, "{what}");
    assert_eq!(ca.particles, cb.particles, "{what}: the final states differ");
    for file in FILES {
        let read = |output: &str| fs::read(folder.path(output).join(file)).unwrap();
        assert!(read(a) == read(b), "{what}: {file} differs");
    }
    for output in [a, b] {
        assert_eq!(folder.json(&format!("{output}/run.json"))["status"], "finished", "{what}");
    }
}

/// The plans whose paths through a run differ most, and each ensemble.
const CASES: [&str; 6] = [
    "--method cell",
    "--method cell --set dynamics.ensemble=langevin --set method.order=cell",
    "--method rt-list --set dynamics.ensemble=rescale",
    "--method rt-list --set method.skin=0.6 --set dynamics.ensemble=langevin",
    "--method rt-forces --set dynamics.ensemble=rescale",
    "--method rt-perse",
];

#[test]
fn a_killed_run_resumes_to_the_same_bytes() {
    // Checkpoints end the lists of `cluster`: only with the same ones is its run the same.
    let of_cluster = ["", "--set method.skin=0.4", "--set method.list_tolerance=0.01"];
    let of_cluster = of_cluster.map(|case| format!("--method cluster {case}"));
    for case in CASES.map(String::from).into_iter().chain(of_cluster) {
        let folder = Folder::new();
        folder.write("melt.toml", MELT);
        let line = format!("run melt.toml --steps 600 {case} {OUTPUTS} --set output.checkpoint_every=70");
        folder.succeed(&format!("{line} --output whole"));
        let mut child = start(&folder, &format!("{line} --output cut"));
        wait_for_lines(&folder, &mut child, "cut/thermo.csv", 20);
        child.kill().unwrap();
        child.wait().unwrap();
        folder.succeed(&format!("{line} --output cut --resume"));
        assert_same_outputs(&folder, "whole", "cut", &case);
    }
}

#[test]
fn a_longer_run_is_the_shorter_one_continued_whenever_checkpoints_were_written() {
    for case in CASES {
        let folder = Folder::new();
        folder.write("melt.toml", MELT);
        let line = format!("run melt.toml {case} {OUTPUTS}");
        folder.succeed(&format!("{line} --steps 230 --output whole --set output.checkpoint_every=0"));
        folder.succeed(&format!("{line} --steps 130 --output cut --set output.checkpoint_every=33"));
        let outcome = folder.succeed(&format!("{line} --steps 230 --output cut --resume"));
        assert!(outcome.stdout.contains("100 steps of 500 particles"), "{}", outcome.stdout);
        assert_same_outputs(&folder, "whole", "cut", case);
        assert_eq!(folder.json("cut/run.json")["resumed_from"], 130);
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_saves_the_present_step_and_resumes_to_the_same_bytes() {
    for (signal, case) in [("INT", CASES[0]), ("TERM", CASES[3])] {
        let folder = Folder::new();
        folder.write("melt.toml", MELT);
        let line = format!("run melt.toml --steps 2000 {case} {OUTPUTS}");
        folder.succeed(&format!("{line} --output whole"));
        let mut child = start(&folder, &format!("{line} --output cut"));
        wait_for_lines(&folder, &mut child, "cut/thermo.csv", 5);
        let kill = std::process::Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(1), "an interrupted run has not done what was asked");
        let record = folder.json("cut/run.json");
        assert_eq!(record["status"], "interrupted");
        let saved = Checkpoint::read(&folder.path("cut/checkpoint.nearfield")).unwrap().step;
        assert_eq!(record["steps"].as_u64(), Some(saved));
        assert!((40..2000).contains(&saved), "interrupted at step {saved}");
        folder.succeed(&format!("{line} --output cut --resume"));
        assert_same_outputs(&folder, "whole", "cut", case);
    }
}

#[test]
fn a_kill_at_any_moment_leaves_files_that_can_be_read() {
    let folder = Folder::new();
    folder.write("melt.toml", MELT.replace("n = 500", "n = 4000"));
    let line = "run melt.toml --steps 100000 --method cell --set output.thermo_every=1 --set output.trajectory_every=1 \
                --set output.msd_every=1 --set output.rdf_every=5 --set output.checkpoint_every=3";
    let mut frames_seen = 0;
    for attempt in 0..12u64 {
        let mut child = start(&folder, &format!("{line} --output out{attempt}"));
        wait_for_lines(&folder, &mut child, &format!("out{attempt}/run.json"), 1);
        sleep(Duration::from_millis(7 + 23 * attempt));
        child.kill().unwrap();
        child.wait().unwrap();
        let file = |name: &str| format!("out{attempt}/{name}");
        assert_eq!(folder.json(&file("run.json"))["status"], "running");
        for table in ["thermo.csv", "msd.csv", "rdf.csv"] {
            if !folder.path(file(table)).exists() {
                continue;
            }
            let text = folder.read(&file(table));
            let columns = text.lines().next().map_or(0, |header| header.split(',').count());
            // A record is written in one piece; a kill between two pieces of it may cut the last one.
            let whole = text.rfind('\n').map_or("", |end| &text[..end]);
            for row in whole.lines().skip(1) {
                assert_eq!(
                    row.split(',').filter(|value| value.parse::<f64>().is_ok()).count(),
                    columns,
                    "{table}: {row}"
                );
            }
        }
        let Ok(frames) = Frames::open(folder.path(file("trajectory.xyz"))) else { continue };
        let mut frames = frames.peekable();
        while let Some(frame) = frames.next() {
            match frame {
                Ok(frame) => assert_eq!(frame.len(), 4000),
                Err(error) => assert!(frames.peek().is_none(), "only the last frame may be cut: {error}"),
            }
            frames_seen += 1;
        }
        if folder.path(file("checkpoint.nearfield")).exists() {
            let saved = Checkpoint::read(&folder.path(file("checkpoint.nearfield"))).unwrap().step;
            let steps = format!("--steps {}", saved + 2);
            folder.write(&file(".checkpoint.nearfieldAbC.tmp"), "cut short");
            folder.succeed(&format!("{} --output out{attempt} --resume", line.replace("--steps 100000", &steps)));
            let mut names =
                fs::read_dir(folder.path(format!("out{attempt}"))).unwrap().map(|entry| entry.unwrap().file_name());
            assert!(names.all(|name| !name.to_string_lossy().ends_with(".tmp")), "nothing cut short is left");
            let frames = Frames::open(folder.path(file("trajectory.xyz"))).unwrap();
            let steps: Vec<u64> = frames.map(|frame| frame.unwrap().step.unwrap()).collect();
            assert_eq!(steps, (0..=saved + 2).collect::<Vec<_>>(), "a cut frame is replaced");
        }
        fs::remove_dir_all(folder.path(format!("out{attempt}"))).unwrap();
    }
    assert!(frames_seen > 12, "kills came too early to show anything");
}

#[test]
fn a_checkpoint_that_does_not_fit_the_request_is_refused_naming_the_section() {
    let folder = Folder::new();
    folder.write("melt.toml", MELT).succeed("run melt.toml --steps 20 --method cell");
    for (change, section) in [
        ("system.generate.n=108", "[system]"),
        ("boundary.x=wall", "[boundary]"),
        ("interaction.cutoff=2.4", "[interaction]"),
        ("dynamics.dt=0.004", "[dynamics]"),
    ] {
        folder.refuse(&format!("run melt.toml --steps 30 --resume --set {change}"), &["checkpoint.nearfield", section]);
    }
    folder.refuse("run melt.toml --steps 30 --resume --method brute", &["method", "cell"]);
    folder.refuse("run melt.toml --steps 10 --resume", &["it is of step 20, beyond the 10 steps asked for"]);
    folder.refuse("run melt.toml --resume --output gone", &["gone/checkpoint.nearfield", "No such file"]);
    let good = fs::read(folder.path("out/checkpoint.nearfield")).unwrap();
    for (damaged, word) in
        [(&good[..good.len() / 2], "not a checkpoint"), (b"garbage", "not a checkpoint"), (b"", "not a checkpoint")]
    {
        folder.write("out/checkpoint.nearfield", damaged);
        folder.refuse("run melt.toml --steps 30 --resume", &["cannot resume from out/checkpoint.nearfield", word]);
    }
    folder.write("out/checkpoint.nearfield", good).write("out/thermo.csv", "step\n");
    folder.fail(2, "run melt.toml --steps 30 --resume", &["cannot continue out/thermo.csv"]);
}
