//! `nearfield bench`: the papers' experiments, and the constants of the cost model.

use super::{print_line, print_note};
use crate::{
    arguments::bench::{BenchArguments, SuiteChoice},
    failure::Failure,
    progress::SuiteBar,
};
use nearfield::{
    Method,
    auto::{Profile, calibrate as measure},
    bench::{self, Options, Suite, Summary},
};
use std::time::Instant;

pub fn run(arguments: &BenchArguments) -> Result<(), Failure> {
    let suites = match arguments.suite {
        SuiteChoice::All => Suite::ALL.to_vec(),
        SuiteChoice::One(suite) => vec![suite],
        SuiteChoice::Auto => return calibrate(arguments),
    };
    let Some(directory) = &arguments.output else {
        return Err(Failure::request("where are the results to go? --output DIR is missing"));
    };
    let options = Options {
        quick: arguments.quick,
        device: arguments.device,
        fresh: arguments.fresh,
        n: arguments.n.clone(),
        methods: arguments.method.clone(),
        filter: arguments.filter.clone(),
        seconds: arguments.seconds,
        patience: arguments.patience,
        steps: arguments.steps,
        stop_after: arguments.stop_after,
    };
    let mut total = Summary::default();
    for suite in suites {
        let bar = SuiteBar::new(suite.name());
        let begin = Instant::now();
        let outcome = bench::run(suite, directory, &options, &mut |progress| {
            bar.update(progress.done, progress.total, &progress.what);
        });
        bar.clear();
        let summary = outcome?;
        print_line(&format!("{:<12} {}, {:.0} s", suite.name(), describe(&summary), begin.elapsed().as_secs_f64()));
        total += summary;
    }
    let output = directory.display();
    if total.left > 0 {
        print_note(&format!("the time is over; the same command goes on with the {} measurements left", total.left));
    }
    print_note(&format!("results in {output}; nearfield plot {output} draws them"));
    if total.wrong > 0 {
        let what = "measurements failed or found another number of pairs than other methods did";
        return Err(Failure::execution(format!("{} {what}; the files say which", total.wrong)));
    }
    Ok(())
}

/// Measures the constants of the cost model and writes them.
fn calibrate(arguments: &BenchArguments) -> Result<(), Failure> {
    let own =
        || Profile::path().ok_or_else(|| Failure::request("there is no folder for configurations; name one by -o"));
    let path = match &arguments.output {
        Some(directory) => directory.join("profile.toml"),
        None => own()?,
    };
    let bar = SuiteBar::new("auto");
    let outcome = measure(arguments.device, arguments.quick, &mut |what, fraction| {
        bar.update((100.0 * fraction) as usize, 100, what);
    });
    bar.clear();
    let calibration = outcome?;
    print_line(&format!("{:<12} {:>12} {:>14} {:>12} {:>8}", "", "step µs", "particle ns", "pair ns", "worst x"));
    for (name, cost) in &calibration.profile.method {
        let method: Method = name.parse().map_err(Failure::request)?;
        let (step, particle, pair) = (cost.step * 1e6, cost.particle * 1e9, cost.pair * 1e9);
        let worst = calibration.worst_error(method);
        print_line(&format!("{name:<12} {step:>12.3} {particle:>14.4} {pair:>12.5} {worst:>8.2}"));
    }
    // A file that cannot be read is what this command is to repair.
    let mut profile = if path.exists() { Profile::read(&path).unwrap_or_default() } else { Profile::default() };
    profile.put(calibration.profile);
    profile.write(&path)?;
    print_note(&format!("written to {}", path.display()));
    Ok(())
}

fn describe(summary: &Summary) -> String {
    let parts = [
        (summary.measured, "measured"),
        (summary.skipped, "in the file already"),
        (summary.impossible, "unsupported, too slow or out of memory"),
        (summary.wrong, "failed or wrong"),
        (summary.left, "left"),
    ];
    let text: Vec<String> =
        parts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
    if text.is_empty() { "nothing to measure".into() } else { text.join(", ") }
}
