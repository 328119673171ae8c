//! Every method by mean number of neighbours.

use super::{DeviceNames, by_method, sizes_note};
use crate::{
    bench::{Record, Suite},
    report::{
        chart::{Axis, Figure, Panel},
        results::{distinct, measured, methods, why_not},
        section::Section,
        table::{Cell, Table, mark_least, number},
    },
};

pub(super) fn section(records: &[&Record]) -> Section {
    let names = DeviceNames::of(records);
    let panel = |(device, name): &(&str, String)| {
        let of_device: Vec<&Record> = records.iter().copied().filter(|r| r.device_name == *device).collect();
        let of_one = DeviceNames::of(&of_device);
        let n = of_device.first().map_or(0, |record| record.n);
        Panel {
            title: format!("{name}, n = {n}"),
            x: Axis::log("mean number of neighbours"),
            y: Axis::log("ns a particle"),
            series: by_method(
                &of_device,
                &of_one,
                |_| true,
                |r, m| {
                    // Where none was found, what was asked for.
                    let asked = r.case.strip_prefix("k=")?.parse().ok()?;
                    Some((if m.neighbors > 0.0 { m.neighbors } else { asked }, m.time.median * 1e9 / r.n as f64))
                },
            ),
            shade: Vec::new(),
        }
    };
    let panels: Vec<Panel> = names.iter().map(panel).collect();
    let figure = Figure {
        id: "neighbors".into(),
        caption: "Time of one force evaluation from scratch by mean number of neighbours".into(),
        columns: panels.len().min(2),
        panels,
    };
    let text = [
        "Uniform periodic points at unit density, the cutoff chosen for the number of neighbours: where each method wins. \
         Everything is built anew for each evaluation, so lists and trees that would last many steps show their full \
         price.",
        &sizes_note(records),
    ];
    Section {
        suite: Suite::Neighbors,
        title: "Where each method wins",
        text: text.map(str::to_owned).to_vec(),
        figures: vec![figure],
        tables: names.iter().map(|(device, name)| table(records, device, name)).collect(),
    }
}

fn table(records: &[&Record], device: &str, name: &str) -> Table {
    let of_device: Vec<&Record> = records.iter().copied().filter(|r| r.device_name == device).collect();
    let methods = methods(&of_device);
    let mut header = vec!["k".to_owned(), "n".to_owned()];
    header.extend(methods.iter().map(|method| method.to_string()));
    let inputs = distinct(&of_device, |record| (record.case.as_str(), record.n));
    let rows = inputs.into_iter().map(|(case, n)| {
        let mut cells: Vec<_> = methods
            .iter()
            .map(|&method| {
                let record = of_device.iter().find(|r| r.case == case && r.n == n && r.plan.method == method);
                match record.map(|record| (measured(record), record)) {
                    Some((Some(m), _)) => (Some(m.time.median), Cell::text(number(m.time.median * 1e3))),
                    Some((None, record)) => {
                        let (text, hint) = why_not(&record.outcome);
                        (None, Cell { text: text.into(), is_best: false, hint })
                    }
                    None => (None, Cell::default()),
                }
            })
            .collect();
        mark_least(&mut cells);
        let cells = cells.into_iter().map(|(_, cell)| cell);
        [Cell::text(case.trim_start_matches("k=")), Cell::text(n.to_string())].into_iter().chain(cells).collect()
    });
    Table { caption: format!("Milliseconds of one force evaluation on {name}"), header, rows: rows.collect() }
}
