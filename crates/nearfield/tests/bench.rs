//! Suites on tiny systems: what they record, and how they go on.

use nearfield::{
    Device, Error, Maintenance, Method, Plan,
    bench::{self, Options, Outcome, Record, Suite, read_records, results_file},
};
use std::{fs, path::Path};
use tempfile::tempdir;

fn tiny() -> Options {
    Options { quick: true, device: Device::Cpu, n: vec![200], seconds: Some(1e-3), ..Options::default() }
}

fn run(suite: Suite, folder: &Path, options: &Options) -> bench::Summary {
    bench::run(suite, folder, options, &mut |_| {}).unwrap()
}

fn records(suite: Suite, folder: &Path) -> Vec<Record> {
    read_records(&results_file(folder, suite)).unwrap()
}

/// Measurements that came to an end, be it that the device cannot make them.
fn settled(summary: &bench::Summary) -> usize {
    summary.measured + summary.impossible
}

fn pairs(record: &Record) -> Option<u64> {
    match &record.outcome {
        Outcome::Measured(measurement) => Some(measurement.pairs),
        _ => None,
    }
}

#[test]
fn every_suite_measures_and_all_methods_of_a_case_find_the_same_pairs() {
    let folder = tempdir().unwrap();
    for suite in Suite::ALL {
        let summary = run(suite, folder.path(), &tiny());
        assert!(summary.measured > 0, "{suite}");
        assert_eq!((summary.wrong, summary.left, summary.skipped), (0, 0, 0), "{suite}");
        let records = records(suite, folder.path());
        assert_eq!(records.len(), summary.measured + summary.impossible);
        for record in &records {
            let same_input = |r: &&Record| r.case == record.case && r.n == record.n;
            let found: Vec<u64> = records.iter().filter(same_input).filter_map(pairs).collect();
            assert!(found.iter().all(|&pairs| pairs == found[0]), "{suite} {}: {found:?}", record.case);
            assert!(record.machine.cores > 0 && record.input.generate.n == record.n);
        }
    }
}

#[test]
fn methods_that_cannot_compute_a_case_are_recorded_as_unsupported() {
    let folder = tempdir().unwrap();
    let options = Options { filter: "lattice r=U".into(), ..tiny() };
    run(Suite::Methods, folder.path(), &options);
    let engine = nearfield::engine(Device::Cpu).unwrap();
    let records = records(Suite::Methods, folder.path());
    for &method in Method::ALL {
        let of_method: Vec<_> = records.iter().filter(|record| record.plan.method == method).collect();
        assert_eq!(of_method.len(), 2, "{method}: walls and periodic");
        for record in of_method {
            let supported = engine.supports(&record.input.build().unwrap(), &record.plan).is_ok();
            assert_eq!(matches!(record.outcome, Outcome::Unsupported { .. }), !supported, "{method}");
        }
    }
    let boxes = records.iter().find(|record| record.plan.method == Method::RtBoxes).unwrap();
    assert!(matches!(boxes.outcome, Outcome::Unsupported { .. }), "radii differ");
}

#[test]
fn a_suite_that_was_cut_short_goes_on_where_it_stopped() {
    let folder = tempdir().unwrap();
    let total = settled(&run(Suite::Md, folder.path(), &tiny()));
    let file = results_file(folder.path(), Suite::Md);
    assert_eq!(run(Suite::Md, folder.path(), &tiny()).skipped, total);
    // A kill in the middle of the last line.
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, &text[..text.len() - 20]).unwrap();
    let summary = run(Suite::Md, folder.path(), &tiny());
    assert_eq!((settled(&summary), summary.skipped), (1, total - 1));
    assert_eq!(records(Suite::Md, folder.path()).len(), total);
    // Nor does opening a file change the last digit of a number in it.
    let text = fs::read_to_string(&file).unwrap().replace("\"least\":", "\"least\":0.0014669260000000001,\"was\":");
    fs::write(&file, &text).unwrap();
    run(Suite::Md, folder.path(), &tiny());
    assert_eq!(fs::read_to_string(&file).unwrap().matches("\"least\":0.0014669260000000001,").count(), total);
    // Another size is another measurement, and a fresh start measures everything again.
    let both = Options { n: vec![200, 500], ..tiny() };
    assert_eq!(settled(&run(Suite::Md, folder.path(), &both)), total);
    let fresh = Options { fresh: true, ..tiny() };
    assert_eq!(settled(&run(Suite::Md, folder.path(), &fresh)), total);
    assert_eq!(records(Suite::Md, folder.path()).len(), 2 * total);
}

#[test]
fn a_run_of_steps_is_a_measurement_of_its_own() {
    let folder = tempdir().unwrap();
    let options = Options { filter: "lattice r=1 wall".into(), methods: vec![Method::Cell], ..tiny() };
    run(Suite::Methods, folder.path(), &options);
    let long = Options { steps: Some(30), ..options };
    assert_eq!(run(Suite::Methods, folder.path(), &long).measured, 1);
    let records = records(Suite::Methods, folder.path());
    let names: Vec<_> = records.iter().map(|record| record.case.as_str()).collect();
    assert_eq!(names, ["lattice r=1 wall", "lattice r=1 wall, 30 steps"]);
    let Outcome::Measured(measurement) = &records[1].outcome else { panic!("{:?}", records[1].outcome) };
    assert_eq!((measurement.steps, measurement.time.repetitions), (30, 1));
    assert!(measurement.builds >= 30, "{measurement:?}");
}

#[test]
fn nothing_begins_after_the_time_is_over() {
    let folder = tempdir().unwrap();
    let options = Options { stop_after: Some(0.0), ..tiny() };
    let summary = run(Suite::Scaling, folder.path(), &options);
    assert!(summary.left > 0 && summary.measured == 0);
    assert_eq!(settled(&run(Suite::Scaling, folder.path(), &tiny())), summary.left);
}

#[test]
fn a_method_that_finds_other_pairs_is_recorded_as_wrong() {
    let folder = tempdir().unwrap();
    let options = Options { methods: vec![Method::Cell], ..tiny() };
    run(Suite::Md, folder.path(), &options);
    let mut record = records(Suite::Md, folder.path()).remove(0);
    let Outcome::Measured(measurement) = &mut record.outcome else { panic!("{:?}", record.outcome) };
    measurement.pairs += 1;
    record.plan = Plan { memory_budget: 1, ..record.plan };
    fs::write(results_file(folder.path(), Suite::Md), serde_json::to_string(&record).unwrap() + "\n").unwrap();
    let summary = run(Suite::Md, folder.path(), &options);
    assert_eq!(summary.wrong, 2, "default and deterministic sums");
    let last = records(Suite::Md, folder.path()).pop().unwrap();
    assert!(matches!(last.outcome, Outcome::Mismatch { pairs, expected } if expected == pairs + 1));
}

#[test]
fn what_the_smaller_cases_predict_to_take_too_long_is_not_begun() {
    let folder = tempdir().unwrap();
    let options = Options { n: vec![200, 400], patience: Some(0.0), methods: vec![Method::Cell], ..tiny() };
    let summary = run(Suite::Scaling, folder.path(), &options);
    assert_eq!((summary.measured, summary.impossible), (1, 1));
    let last = records(Suite::Scaling, folder.path()).pop().unwrap();
    assert!(matches!(last.outcome, Outcome::TooSlow { predicted_seconds, .. } if predicted_seconds > 0.0));
    assert_eq!(last.n, 400);
    // With more patience it is measured after all.
    let patient = Options { patience: Some(100.0), ..options };
    let summary = run(Suite::Scaling, folder.path(), &patient);
    assert_eq!((summary.measured, summary.skipped), (1, 1));
}

#[test]
fn energy_is_measured_or_its_absence_explained() {
    let folder = tempdir().unwrap();
    run(Suite::Energy, folder.path(), &Options { filter: "cluster r=LN[1,330] wall".into(), ..tiny() });
    let mut measured = 0;
    for record in records(Suite::Energy, folder.path()) {
        let measurement = match record.outcome {
            Outcome::Measured(measurement) => measurement,
            Outcome::Unsupported { .. } => continue,
            other => panic!("{other:?}"),
        };
        measured += 1;
        let energy = measurement.energy.unwrap();
        assert!(energy.steps > 0 && energy.seconds > 0.0 && energy.interactions > 0.0);
        assert_ne!(energy.meter.is_some(), energy.no_meter.is_some());
        assert_eq!(energy.power.is_empty(), energy.meter.is_none());
    }
    assert!(measured > 0);
}

#[test]
fn the_series_of_a_run_has_each_step_and_its_first_build() {
    let folder = tempdir().unwrap();
    run(Suite::Policies, folder.path(), &Options { filter: "lattice r=1 ".into(), ..tiny() });
    let records = records(Suite::Policies, folder.path());
    assert_eq!(records.len(), 5);
    for record in records {
        let measurement = match record.outcome {
            Outcome::Measured(measurement) => measurement,
            Outcome::Unsupported { reason } => {
                assert!(record.plan.maintenance == Maintenance::GradientJoules && reason.contains("meter"), "{reason}");
                continue;
            }
            other => panic!("{other:?}"),
        };
        let series = measurement.series.unwrap();
        assert_eq!(series.structure.len() as u64, measurement.steps);
        assert_eq!(series.query.len() as u64, measurement.steps);
        assert_eq!(series.interactions.last().unwrap().0, measurement.steps);
        if record.plan.maintenance.to_string() == "every" {
            assert_eq!(series.builds.len() as u64, measurement.steps);
        }
    }
}

#[test]
fn a_line_that_is_no_record_is_named() {
    let folder = tempdir().unwrap();
    fs::write(results_file(folder.path(), Suite::Md), "{\"suite\":\"md\"}\n").unwrap();
    let error = bench::run(Suite::Md, folder.path(), &tiny(), &mut |_| {}).unwrap_err();
    assert!(matches!(&error, Error::Results { line: 1, .. }), "{error}");
    assert!(error.is_request());
}

#[test]
fn a_device_that_is_not_there_is_an_error() {
    let folder = tempdir().unwrap();
    let options = Options { device: Device::Cuda(Some(999)), ..tiny() };
    let error = bench::run(Suite::Md, folder.path(), &options, &mut |_| {}).unwrap_err();
    assert!(matches!(error, Error::DeviceUnavailable { .. }), "{error}");
}
