//! One file a command.

pub mod devices;
pub mod forces;
pub mod generate;
pub mod methods;
pub mod neighbors;
pub mod run;

use serde::Serialize;
use std::io::{self, Write};

use crate::failure::Failure;

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
