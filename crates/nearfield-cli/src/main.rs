//! The `nearfield` command: fixed-radius neighbours and short-range particle simulations.

mod arguments;
mod commands;
mod failure;
mod progress;

use arguments::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match arguments.command {
        Command::Run(run) => commands::run::run(&run),
        Command::Forces(forces) => commands::forces::run(&forces),
        Command::Neighbors(neighbors) => commands::neighbors::run(&neighbors),
        Command::Generate(generate) => commands::generate::run(&generate),
        Command::Render(render) => commands::render::run(&render),
        Command::Bench(bench) => commands::bench::run(&bench),
        Command::Plot(plot) => commands::plot::run(&plot),
        Command::Devices(listing) => commands::devices::run(listing.json),
        Command::Methods(listing) => commands::methods::run(listing.json),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
