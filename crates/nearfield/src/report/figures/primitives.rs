//! Paper B, figures 9 and 10.

use super::{DeviceNames, by_method, sizes_note};
use crate::{
    bench::{Measurement, Record, Suite},
    report::{
        chart::{Axis, Figure, Panel, Series, Style},
        palette::{Look, Marker},
        results::{distinct, measured, slug, why_not},
        section::Section,
        table::{Cell, Table, number},
    },
};
use nearfield_core::Order;

/// What is shown of an evaluation: end of the figure's name, what it is, and the number, \[s\].
type Part = (&'static str, &'static str, fn(&Measurement) -> f64);

const PARTS: [Part; 3] = [
    ("", "Time of a force evaluation", |m| m.time.median),
    ("-build", "Time to build everything anew", |m| m.structure_seconds),
    ("-compute", "Time to find and use the pairs", |m| m.query_seconds),
];

pub(super) fn section(records: &[&Record]) -> Section {
    let (mut figures, mut tables) = (Vec::new(), Vec::new());
    for (device, name) in DeviceNames::of(records).iter() {
        let of_device: Vec<&Record> = records.iter().copied().filter(|r| r.device_name == *device).collect();
        for (start, number) in [("uniform", 9), ("sphere", 10)] {
            let of_start: Vec<&Record> = of_device.iter().copied().filter(|r| r.case.starts_with(start)).collect();
            figures.extend(PARTS.iter().map(|part| figure(&of_start, start, name, number, part)));
            tables.push(table(&of_start, start, name));
        }
        figures.push(memory(&of_device, name));
    }
    let text = [
        "One force evaluation, everything built anew, by the mean number p of particles in a cell. Uniform: p beta³ \
         points in the unit box, cutoff 1/beta. Sphere: p alpha³ points on the unit sphere with about 9p neighbours. Paper \
         B's CUDA grid is cell here; its custom AABB without and with sorting are rt-boxes in random order and sorted. \
         Medians of five repetitions or more, fewer where one takes long. The paper gives its times as figures only.",
        &sizes_note(records),
    ];
    Section {
        suite: Suite::Primitives,
        title: "What rays hit",
        text: text.map(str::to_owned).to_vec(),
        figures,
        tables,
    }
}

fn per_cell(record: &Record) -> Option<f64> {
    record.case.rsplit_once("p=")?.1.parse().ok()
}

/// A series for each method, and one for boxes around particles in random order.
fn series(records: &[&Record], point: impl Fn(&Record, &Measurement) -> Option<(f64, f64)> + Copy) -> Vec<Series> {
    let names = DeviceNames::of(records);
    let mut series = by_method(records, &names, |plan| plan.order != Order::None, point);
    for mut unsorted in by_method(records, &names, |plan| plan.order == Order::None, point) {
        unsorted.name += ", random order";
        unsorted.look = Look { marker: Marker::Cross, ..unsorted.look };
        series.push(unsorted);
    }
    series
}

fn figure(records: &[&Record], start: &str, device: &str, number: u32, (suffix, what, seconds): &Part) -> Figure {
    let panel = |family: &str| {
        let of_family: Vec<&Record> = records.iter().copied().filter(|record| record.family == family).collect();
        let point = |r: &Record, m: &Measurement| {
            let ms = seconds(m) * 1e3;
            (ms > 0.0).then_some((per_cell(r)?, ms))
        };
        let title = family.to_owned();
        Panel {
            title,
            x: Axis::log("p, particles a cell"),
            y: Axis::log("ms"),
            series: series(&of_family, point),
            shade: Vec::new(),
        }
    };
    Figure {
        id: format!("primitives-{start}{suffix}-{}", slug(device)),
        caption: format!("{what}, {start}, on {device} (paper B, figure {number})"),
        columns: 3,
        panels: distinct(records, |record| record.family.as_str()).into_iter().map(panel).collect(),
    }
}

/// Memory of the structures by number of particles.
fn memory(records: &[&Record], device: &str) -> Figure {
    let panel = |start: &str| {
        let of_start: Vec<&Record> = records.iter().copied().filter(|record| record.case.starts_with(start)).collect();
        let point = |r: &Record, m: &Measurement| Some((r.n as f64, m.structure_bytes_per_particle));
        let mut series = series(&of_start, point);
        for one in &mut series {
            // Several cases have the same n.
            one.style = Style::Points;
        }
        Panel {
            title: start.into(),
            x: Axis::log("particles"),
            y: Axis::log("bytes a particle"),
            series,
            shade: Vec::new(),
        }
    };
    Figure {
        id: format!("primitives-memory-{}", slug(device)),
        caption: format!("Memory of the structure on {device}"),
        columns: 2,
        panels: ["uniform", "sphere"].map(panel).to_vec(),
    }
}

fn table(records: &[&Record], start: &str, device: &str) -> Table {
    let header =
        ["case", "n", "neighbours", "method", "build, ms", "compute, ms", "total, ms", "structure, bytes a particle"];
    let row = |record: &&Record| {
        let order = if record.plan.order == Order::None { ", random order" } else { "" };
        let mut row = vec![record.case.clone(), record.n.to_string()];
        match measured(record) {
            Some(m) => {
                row.extend([number(m.neighbors), format!("{}{order}", record.plan.method)]);
                row.extend([m.structure_seconds, m.query_seconds, m.time.median].map(|s| number(s * 1e3)));
                row.push(number(m.structure_bytes_per_particle));
            }
            None => {
                row.extend([String::new(), format!("{}{order}", record.plan.method)]);
                row.extend([why_not(&record.outcome).0.to_owned(), String::new(), String::new(), String::new()]);
            }
        }
        row.into_iter().map(Cell::text).collect()
    };
    Table {
        caption: format!("Build and compute, {start}, on {device}"),
        header: header.map(str::to_owned).to_vec(),
        rows: records.iter().map(row).collect(),
    }
}
