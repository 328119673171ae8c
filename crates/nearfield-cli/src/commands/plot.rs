//! `nearfield plot`: figures and a report of what `bench` measured.

use super::print_line;
use crate::{arguments::bench::PlotArguments, failure::Failure};

pub fn run(arguments: &PlotArguments) -> Result<(), Failure> {
    let output = arguments.output.as_ref().unwrap_or(&arguments.input);
    let written = nearfield::report::plot(&arguments.input, output)?;
    for path in written {
        print_line(&path.display().to_string());
    }
    Ok(())
}
