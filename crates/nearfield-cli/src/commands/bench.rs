//! `nearfield bench`: the papers' experiments.

use super::{print_line, print_note};
use crate::{
    arguments::bench::{BenchArguments, SuiteChoice},
    failure::Failure,
    progress::SuiteBar,
};
use nearfield::bench::{self, Options, Suite, Summary};

pub fn run(arguments: &BenchArguments) -> Result<(), Failure> {
    let suites = match arguments.suite {
        SuiteChoice::All => Suite::ALL.to_vec(),
        SuiteChoice::One(suite) => vec![suite],
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
        stop_after: arguments.stop_after,
    };
    let mut total = Summary::default();
    for suite in suites {
        let bar = SuiteBar::new(suite.name());
        let outcome = bench::run(suite, &arguments.output, &options, &mut |progress| {
            bar.update(progress.done, progress.total, &progress.what);
        });
        bar.clear();
        let summary = outcome?;
        print_line(&format!("{:<12} {}", suite.name(), describe(&summary)));
        total += summary;
    }
    let output = arguments.output.display();
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
