//! `nearfield plot`: figures and a report of what `bench` measured.

use super::{print_line, print_note};
use crate::{arguments::bench::PlotArguments, failure::Failure};

pub fn run(arguments: &PlotArguments) -> Result<(), Failure> {
    let output = arguments.output.as_ref().unwrap_or(&arguments.input);
    let written = nearfield::report::plot(&arguments.input, output)?;
    if let Some((page, figures)) = written.split_first() {
        print_line(&page.display().to_string());
        print_note(&format!("with {} figures as SVG and PNG beside it", figures.len() / 2));
    }
    Ok(())
}
