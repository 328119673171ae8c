//! Paper B, figures 9 and 10.

use super::{DeviceNames, by_method, sizes_note};
use crate::{
    bench::{Measurement, Record, Suite},
    report::{
        chart::{Axis, Figure, Panel},
        palette::{Look, Marker},
        results::{distinct, measured, slug, why_not},
        section::Section,
        table::{Cell, Table, number},
    },
};
use nearfield_core::Order;

pub(super) fn section(records: &[&Record]) -> Section {
    let (mut figures, mut tables) = (Vec::new(), Vec::new());
    for (device, name) in DeviceNames::of(records).iter() {
        let of_device: Vec<&Record> = records.iter().copied().filter(|r| r.device_name == *device).collect();
        for (start, number) in [("uniform", 9), ("sphere", 10)] {
            let of_start: Vec<&Record> = of_device.iter().copied().filter(|r| r.case.starts_with(start)).collect();
            figures.push(figure(&of_start, start, name, number));
            tables.push(table(&of_start, start, name));
        }
    }
    let text = [
        "One force evaluation, everything built anew, by the mean number p of particles in a cell. Uniform: p beta³ \
         points in the unit box, cutoff 1/beta. Sphere: p alpha³ points on the unit sphere with about 9p neighbours. Paper \
         B's CUDA grid is cell here; its custom AABB without and with sorting are rt-boxes in random order and sorted. \
         The paper gives its times as figures only.",
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

fn figure(records: &[&Record], start: &str, device: &str, number: u32) -> Figure {
    let names = DeviceNames::of(records);
    let panel = |family: &str| {
        let of_family: Vec<&Record> = records.iter().copied().filter(|record| record.family == family).collect();
        let point = |r: &Record, m: &Measurement| Some((per_cell(r)?, m.time.median * 1e3));
        let mut series = by_method(&of_family, &names, |plan| plan.order != Order::None, point);
        for mut unsorted in by_method(&of_family, &names, |plan| plan.order == Order::None, point) {
            unsorted.name += ", random order";
            unsorted.look = Look { marker: Marker::Cross, ..unsorted.look };
            series.push(unsorted);
        }
        Panel { title: family.into(), x: Axis::log("p"), y: Axis::log("ms"), series, shade: Vec::new() }
    };
    Figure {
        id: format!("primitives-{start}-{}", slug(device)),
        caption: format!("Time of a force evaluation, {start}, on {device} (paper B, figure {number})"),
        columns: 3,
        panels: distinct(records, |record| record.family.as_str()).into_iter().map(panel).collect(),
    }
}

fn table(records: &[&Record], start: &str, device: &str) -> Table {
    let header = ["case", "n", "neighbours", "method", "build, ms", "compute, ms", "total, ms"];
    let row = |record: &&Record| {
        let order = if record.plan.order == Order::None { ", random order" } else { "" };
        let mut row = vec![record.case.clone(), record.n.to_string()];
        match measured(record) {
            Some(m) => {
                row.extend([number(m.neighbors), format!("{}{order}", record.plan.method)]);
                row.extend([m.structure_seconds, m.query_seconds, m.time.median].map(|s| number(s * 1e3)));
            }
            None => {
                row.extend([String::new(), format!("{}{order}", record.plan.method)]);
                row.extend([why_not(&record.outcome).0.to_owned(), String::new(), String::new()]);
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
