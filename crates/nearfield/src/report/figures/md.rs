//! The Lennard-Jones melt.

use super::{DeviceNames, by_method, sizes_note};
use crate::{
    bench::{Record, Suite},
    report::{
        chart::{Axis, Figure, Panel},
        results::{measured, why_not},
        section::Section,
        table::{Cell, Table, number},
    },
};

pub(super) fn section(records: &[&Record]) -> Section {
    let names = DeviceNames::of(records);
    let panel = |title: &str, deterministic: bool| {
        let point = |r: &Record, m: &crate::bench::Measurement| Some((r.n as f64, r.n as f64 / m.time.median * 1e-6));
        Panel {
            title: title.into(),
            x: Axis::log("particles"),
            y: Axis::log("million particle-steps a second"),
            series: by_method(records, &names, |plan| plan.deterministic == deterministic, point),
            shade: Vec::new(),
        }
    };
    let figure = Figure {
        id: "md".into(),
        caption: "The Lennard-Jones melt: density 0.8442, cutoff 2.5, time step 0.005".into(),
        columns: 2,
        panels: vec![panel("default sums", false), panel("deterministic sums", true)],
    };
    let text = [
        "Whole steps of the benchmark that LAMMPS and others use, with sums as fast as they go, and with sums that are the \
         same bits for any order of pairs. Higher is better. docs/performance.md compares with other programs.",
        &sizes_note(records),
    ];
    Section {
        suite: Suite::Md,
        title: "The melt",
        text: text.map(str::to_owned).to_vec(),
        figures: vec![figure],
        tables: vec![table(records)],
    }
}

fn table(records: &[&Record]) -> Table {
    let header = ["device", "n", "method", "sums", "ms a step", "million particle-steps a second", "bytes a particle"];
    let row = |record: &&Record| {
        let sums = if record.plan.deterministic { "deterministic" } else { "default" };
        let mut row =
            vec![record.device_name.clone(), record.n.to_string(), record.plan.method.to_string(), sums.to_owned()];
        match measured(record) {
            Some(m) => row.extend([
                number(m.time.median * 1e3),
                number(record.n as f64 / m.time.median * 1e-6),
                number(m.bytes_per_particle),
            ]),
            None => row.extend([why_not(&record.outcome).0.to_owned(), String::new(), String::new()]),
        }
        row.into_iter().map(Cell::text).collect()
    };
    Table {
        caption: "Whole steps of the melt".into(),
        header: header.map(str::to_owned).to_vec(),
        rows: records.iter().map(row).collect(),
    }
}
