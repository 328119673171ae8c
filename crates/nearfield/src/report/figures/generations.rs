//! Paper A, figure 13.

use super::{DeviceNames, inputs, sizes_note};
use crate::{
    bench::{Measurement, Record, Suite},
    report::{
        chart::{Axis, Figure, Panel, Series, Style},
        palette,
        results::{devices, measured, methods},
        section::Section,
    },
};

pub(super) fn section(records: &[&Record]) -> Section {
    let count = devices(records).len();
    let text = [
        "Interactions per second and per joule by device, on the three cases that paper A selects. Put generations.jsonl \
         of several machines into folders below one directory to see them side by side.",
        if count == 1 { "Only one device has results here." } else { "" },
        &sizes_note(records),
    ];
    let rate = |m: &Measurement| m.energy.as_ref().map(|energy| energy.interactions / energy.seconds);
    let per_joule = |m: &Measurement| {
        m.energy.as_ref().filter(|energy| energy.joules > 0.0).map(|energy| energy.interactions / energy.joules)
    };
    let figures = vec![
        figure(records, "generations-performance", "Interactions per second", "interactions a second", rate),
        figure(records, "generations-efficiency", "Interactions per joule", "interactions a joule", per_joule),
    ];
    Section {
        suite: Suite::Generations,
        title: "Across devices",
        text: text.map(str::to_owned).to_vec(),
        figures,
        tables: Vec::new(),
    }
}

fn figure(
    records: &[&Record],
    id: &str,
    what: &str,
    unit: &str,
    value: impl Fn(&Measurement) -> Option<f64> + Copy,
) -> Figure {
    let names = DeviceNames::of(records);
    let labels: Vec<String> = names.iter().map(|(_, name)| name.clone()).collect();
    let panel = |(case, n): (&str, usize)| {
        let of_case: Vec<&Record> = records.iter().copied().filter(|r| r.case == case && r.n == n).collect();
        let of_method = |method| {
            let at = |(k, (device, _)): (usize, &(&str, String))| {
                let is_it = |r: &&&Record| r.plan.method == method && r.device_name == *device;
                Some((k as f64, value(measured(of_case.iter().find(is_it)?)?)?))
            };
            Series {
                name: method.to_string(),
                look: palette::of_method(method),
                style: Style::Line,
                points: names.iter().enumerate().filter_map(at).collect(),
                marked: None,
            }
        };
        Panel {
            title: format!("{case}, n = {n}"),
            x: Axis::names(labels.clone()),
            y: Axis::log(unit),
            series: methods(&of_case).into_iter().map(of_method).filter(|s| !s.points.is_empty()).collect(),
            shade: Vec::new(),
        }
    };
    Figure {
        id: id.into(),
        caption: format!("{what} by device (paper A, figure 13)"),
        columns: 3,
        panels: inputs(records).into_iter().map(panel).collect(),
    }
}
