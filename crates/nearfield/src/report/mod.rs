//! Figures, tables and a page of what [`mod@crate::bench`] measured, beside the papers' values: what `nearfield plot` does,
//! for programs.
//!
//! [`plot`] reads the results, each suite's file in `figures/` says what is shown of them, `draw.rs` draws that, and
//! `page.rs` writes the page.

mod chart;
mod draw;
mod figures;
mod page;
mod palette;
mod papers;
mod results;
mod section;
mod table;
mod ticks;

use crate::{Result, io::IoError, io::atomic_write};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// File name of the page.
pub const PAGE: &str = "report.html";

/// Draws the results of `nearfield bench` that are in `input` and in the folders directly below it. Each figure is
/// written to `output` as SVG and PNG; all of them, with tables, are in a page that needs no network. Gives the files
/// that were written, the page first.
///
/// # Errors
/// [`crate::Error::NoResults`], [`crate::Error::Results`], and when a file cannot be written.
pub fn plot(input: &Path, output: &Path) -> Result<Vec<PathBuf>> {
    let results = results::Results::read(input)?;
    let sections = figures::sections(&results);
    fs::create_dir_all(output).map_err(|source| IoError::Write { path: output.to_owned(), source })?;
    let mut written = vec![output.join(PAGE)];
    let mut pictures = Vec::new();
    for figure in sections.iter().flat_map(|section| &section.figures) {
        let svg = draw::svg(figure)?;
        for (extension, content) in [("svg", svg.as_bytes()), ("png", &draw::png(figure)?)] {
            let path = output.join(format!("{}.{extension}", figure.id));
            atomic_write(&path, |out| out.write_all(content))?;
            written.push(path);
        }
        pictures.push(svg);
    }
    let page = page::page(&results, &sections, &pictures);
    atomic_write(&written[0], |out| out.write_all(page.as_bytes()))?;
    Ok(written)
}
