//! Paper A, figures 9 and 10.

use super::{DeviceNames, by_method, sizes_note};
use crate::{
    bench::{Record, Suite},
    report::{
        chart::{Axis, Figure, Panel, Series, Style},
        palette,
        papers::{CPU_CELL, name_in_paper_a, papers},
        results::{distinct, measured, methods},
        section::Section,
    },
};
use nearfield_core::Method;

pub(super) fn section(records: &[&Record]) -> Section {
    let figures = [("wall", 9), ("periodic", 10)].map(|(boundary, number)| figure(records, boundary, number)).to_vec();
    let base = if has_cpu(records) { "the CPU" } else { "the same device" };
    let text = [
        &*format!(
            "How many times faster a step is than with cell on {base}, by number of particles in a box of 1000. Hollow \
             markers: paper A on an RTX PRO 6000 Blackwell over its CPU-CELL on 64 cores, at the two sizes of its table \
             2; its figures hold more sizes, but no numbers to read off."
        ),
        &sizes_note(records),
    ];
    Section {
        suite: Suite::Speedup,
        title: "Speedup by size",
        text: text.map(str::to_owned).to_vec(),
        figures,
        tables: Vec::new(),
    }
}

fn has_cpu(records: &[&Record]) -> bool {
    records.iter().any(|record| record.device == "cpu" && record.plan.method == Method::Cell)
}

fn figure(records: &[&Record], boundary: &str, number: u32) -> Figure {
    let names = DeviceNames::of(records);
    let on_cpu = has_cpu(records);
    let of_boundary: Vec<&Record> = records.iter().copied().filter(|r| r.case.ends_with(boundary)).collect();
    let mut cases = distinct(&of_boundary, |record| record.case.as_str());
    cases.sort_by_key(|case| ["lattice", "disordered", "cluster"].iter().position(|p| case.starts_with(p)));
    let panel = |case: &str| {
        let of_case: Vec<&Record> = of_boundary.iter().copied().filter(|record| record.case == case).collect();
        let base = |record: &Record| {
            let is_base = |r: &&&Record| {
                let device = if on_cpu { r.device == "cpu" } else { r.device_name == record.device_name };
                r.n == record.n && r.plan.method == Method::Cell && device
            };
            Some(measured(of_case.iter().find(is_base)?)?.time.median)
        };
        let mut series = by_method(&of_case, &names, |_| true, |r, m| Some((r.n as f64, base(r)? / m.time.median)));
        series.extend(methods(&of_case).into_iter().filter_map(|method| paper(case, method, &of_case)));
        Panel {
            title: case.trim_end_matches(boundary).trim().into(),
            x: Axis::log("particles"),
            y: Axis::log("speedup"),
            series,
            shade: Vec::new(),
        }
    };
    Figure {
        id: format!("speedup-{boundary}"),
        caption: format!("Speedup over cell by number of particles, {boundary} boundaries (paper A, figure {number})"),
        columns: 4,
        panels: cases.into_iter().map(panel).collect(),
    }
}

/// The paper's speedups at the sizes of its table 2, where ours come near them.
fn paper(case: &str, method: Method, records: &[&Record]) -> Option<Series> {
    let name = name_in_paper_a(method)?;
    let table = &papers().table2;
    let largest = records.iter().map(|record| record.n).max()?;
    let at = |&n: &usize| Some((n as f64, table.ms(case, n, CPU_CELL)? / table.ms(case, n, name)?));
    let points: Vec<_> = [50_000, 1_000_000].iter().filter(|&&n| n <= 2 * largest).filter_map(at).collect();
    let look = palette::of_method(method);
    (!points.is_empty()).then(|| Series {
        name: format!("paper A: {name}"),
        look,
        style: Style::Hollow,
        points,
        marked: None,
    })
}
