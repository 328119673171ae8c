//! Paper A, table 2.

use super::{DeviceNames, by_method, sizes_note};
use crate::{
    bench::{Record, Suite, paper_a_names},
    report::{
        chart::{Axis, Figure, Panel, Series, Style},
        palette::{Look, Marker},
        papers::{CPU_CELL, name_in_paper_a, papers},
        results::{distinct, measured, methods, sizes, slug, why_not},
        section::Section,
        table::{Cell, Table, mark_least, number},
    },
};
use nearfield_core::Method;

pub(super) fn section(records: &[&Record]) -> Section {
    let (mut figures, mut tables) = (Vec::new(), Vec::new());
    // Suites may have been measured in parts, in any order; runs of so many steps come after the table's own cases.
    let order = paper_a_names();
    let mut records = records.to_vec();
    records.sort_by_key(|record| order.iter().position(|name| *name == record.case).unwrap_or(order.len()));
    let records = &records[..];
    for (device, name) in DeviceNames::of(records).iter() {
        let of_device: Vec<&Record> = records.iter().copied().filter(|r| r.device_name == *device).collect();
        for n in sizes(&of_device) {
            let of_size: Vec<&Record> = of_device.iter().copied().filter(|r| r.n == n).collect();
            figures.push(figure(&of_size, name, n));
            tables.push(table(&of_size, name, n));
        }
    }
    let text = [
        "Milliseconds of a whole step: upkeep of the structure, forces, integration. The box is 1000 in all directions, \
         so that r = 160 means many neighbours and r = 1 hardly any. The paper's numbers are from an RTX PRO 6000 \
         Blackwell with RT cores (and CPU-CELL on 64 cores); where the sizes differ, its 50,000 particles stand beside \
         ours for orientation only.",
        &*format!("Where the paper's numbers are from: {}.", papers().table2.source),
        &sizes_note(records),
    ];
    Section {
        suite: Suite::Methods,
        title: "Every method on every input",
        text: text.map(str::to_owned).to_vec(),
        figures,
        tables,
    }
}

/// The size of the paper that is nearest to ours.
fn paper_size(n: usize) -> usize {
    if n >= 500_000 { 1_000_000 } else { 50_000 }
}

fn figure(records: &[&Record], device: &str, n: usize) -> Figure {
    let panels = ["wall", "periodic"].map(|boundary| {
        let of_panel: Vec<&Record> = records.iter().copied().filter(|r| r.case.ends_with(boundary)).collect();
        let cases = distinct(&of_panel, |record| record.case.as_str());
        let place = |case: &str| cases.iter().position(|other| *other == case).map(|k| k as f64);
        let names = DeviceNames::of(&of_panel);
        let point = |r: &Record, m: &crate::bench::Measurement| Some((place(&r.case)?, m.time.median * 1e3));
        let mut series = by_method(&of_panel, &names, |_| true, point);
        for one in &mut series {
            one.style = Style::Points;
        }
        if n == paper_size(n) {
            let best = |case: &&str| Some((place(case)?, papers().table2.best(case, n)?.1));
            series.push(Series {
                name: "paper A, best of five".into(),
                look: Look { color: (0, 0, 0), marker: Marker::Diamond },
                style: Style::Hollow,
                points: cases.iter().filter_map(best).collect(),
                marked: None,
            });
        }
        let brief = |case: &&str| {
            let words: Vec<&str> = case.split(' ').collect();
            format!("{} {}", &words[0][..1].to_uppercase(), words.get(1).map_or("", |r| r.trim_start_matches("r=")))
        };
        Panel {
            title: format!("{boundary}: L lattice, D disordered, C cluster"),
            x: Axis::names(cases.iter().map(brief).collect()),
            y: Axis::log("ms a step"),
            series,
            shade: Vec::new(),
        }
    });
    Figure {
        id: format!("methods-{}-{n}", slug(device)),
        caption: format!("Time of a step on {device}, n = {n} (paper A, table 2)"),
        columns: 1,
        panels: panels.to_vec(),
    }
}

fn table(records: &[&Record], device: &str, n: usize) -> Table {
    let methods = methods(records);
    let mut header = vec!["case".to_owned(), "neighbours".to_owned()];
    header.extend(methods.iter().map(|method| method.to_string()));
    let size = paper_size(n);
    header.push(format!("paper A's best at n = {size}"));
    if size == n {
        header.push("paper A / ours".into());
    }
    let rows = distinct(records, |record| record.case.as_str()).into_iter().map(|case| {
        let of_case = || records.iter().filter(move |record| record.case == case);
        let mut cells: Vec<_> = methods
            .iter()
            .map(|&method| {
                of_case().find(|r| r.plan.method == method).map_or((None, Cell::text("")), |r| cell(r, size == n))
            })
            .collect();
        mark_least(&mut cells);
        let ours = cells.iter().filter_map(|(ms, _)| *ms).fold(f64::INFINITY, f64::min);
        let neighbors = of_case().find_map(|record| Some(measured(record)?.neighbors));
        let mut row = vec![Cell::text(case), neighbors.map_or(Cell::default(), Cell::number)];
        row.extend(cells.into_iter().map(|(_, cell)| cell));
        let best = papers().table2.best(case, size);
        row.push(best.map_or(Cell::default(), |(name, ms)| Cell::text(format!("{} {name}", number(ms)))));
        if size == n {
            row.push(best.map_or(Cell::default(), |(_, ms)| Cell::text(format!("{}x", number(ms / ours)))));
        }
        row
    });
    let brackets = if size == n { "; in brackets paper A's own" } else { "" };
    Table { caption: format!("Milliseconds a step on {device}, n = {n}{brackets}"), header, rows: rows.collect() }
}

/// Milliseconds of a step; `*` where one evaluation of the start had to do. In brackets the paper's, where it is asked for.
fn cell(record: &Record, with_papers: bool) -> (Option<f64>, Cell) {
    let name = if record.device == "cpu" && record.plan.method == Method::Cell {
        Some(CPU_CELL)
    } else {
        name_in_paper_a(record.plan.method).filter(|_| record.device != "cpu")
    };
    let of_paper = name.filter(|_| with_papers).and_then(|name| papers().table2.ms(&record.case, record.n, name));
    let brackets = of_paper.map_or(String::new(), |ms| format!(" ({})", number(ms)));
    let (ms, cell) = own_cell(record);
    (ms, Cell { text: format!("{}{brackets}", cell.text), ..cell })
}

fn own_cell(record: &Record) -> (Option<f64>, Cell) {
    match measured(record) {
        Some(measurement) => {
            let ms = measurement.time.median * 1e3;
            let mark = if measurement.steps == 0 { "*" } else { "" };
            let [least, most] = [measurement.time.least, measurement.time.most].map(|s| number(s * 1e3));
            let hint = match measurement.steps {
                0 => "one force evaluation at the start; steps take too long here".into(),
                steps => format!("{least} to {most} ms in {} times {steps} steps", measurement.time.repetitions),
            };
            (Some(ms), Cell { text: format!("{}{mark}", number(ms)), is_best: false, hint })
        }
        None => {
            let (text, hint) = why_not(&record.outcome);
            (None, Cell { text: text.into(), is_best: false, hint })
        }
    }
}
