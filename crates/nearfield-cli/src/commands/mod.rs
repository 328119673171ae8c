//! One file a command.

pub mod bench;
pub mod devices;
pub mod forces;
pub mod generate;
pub mod methods;
pub mod neighbors;
pub mod plot;
pub mod render;
pub mod run;

use nearfield::{
    Radii,
    config::{self, Config},
};
use serde::Serialize;
use std::{
    io::{self, Write},
    path::Path,
};

use crate::failure::Failure;

/// Reads a configuration file; errors within it name it.
fn configuration(path: &Path, overrides: &[String]) -> Result<Config, Failure> {
    Config::load(path, overrides).map_err(|error| {
        let names_its_place = matches!(error, config::Error::Read { .. } | config::Error::NotKeyValue(_));
        let failure = Failure::from(error);
        if names_its_place { failure } else { failure.within(path.display()) }
    })
}

/// Radii of particles take the place of the cutoff. A file may hold some that were meant for pictures, so this is said.
fn note_radii(radii: &Radii) {
    if let Radii::PerParticle(radii) = radii {
        let least = radii.iter().copied().fold(f32::INFINITY, f32::min);
        let largest = radii.iter().copied().fold(0.0, f32::max);
        print_note(&format!("each particle has its own radius, {least} to {largest}; the cutoff is not used"));
    }
}

/// Prints a value as JSON on one line. A closed pipe is not an error: the reader has seen enough.
fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string(value).map_err(Failure::request)?;
    print_line(&text);
    Ok(())
}

fn print_line(line: &str) {
    let _ = writeln!(io::stdout().lock(), "{line}");
}

/// Prints what is no result: to stderr, where a closed pipe is no error either.
pub fn print_note(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}
