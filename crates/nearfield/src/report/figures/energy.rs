//! Paper A, figures 11 and 12.

use super::{DeviceNames, by_method, curves_by_method, inputs, sizes_note};
use crate::{
    bench::{Energy, Measurement, Record, Suite},
    report::{
        chart::{Axis, Figure, Panel, Style},
        results::{measured, why_not},
        section::Section,
        table::{Cell, Table, number},
    },
};

pub(super) fn section(records: &[&Record]) -> Section {
    let text = [
        &*format!(
            "Power by time, and interactions (pairs within range, each once a step) per joule, on the three cases that \
             paper A selects. {}",
            meters(records)
        ),
        "A meter counts all that its device does, other programs included, and a GPU's counts nothing of the processor \
         that feeds it.",
        &sizes_note(records),
    ];
    let figures = vec![power(records), efficiency(records), rate(records)];
    Section {
        suite: Suite::Energy,
        title: "Power and energy",
        text: text.map(str::to_owned).to_vec(),
        figures,
        tables: vec![table(records)],
    }
}

/// Least seconds over which power is averaged: counters of GPUs are refreshed each 20 to 100 ms, so that shorter readings
/// show the refreshing.
const AVERAGED: f64 = 0.25;

fn energy(record: &Record) -> Option<&Energy> {
    measured(record)?.energy.as_ref()
}

/// What was read on each device, or that nothing was.
fn meters(records: &[&Record]) -> String {
    let names = DeviceNames::of(records);
    let of_device = |(device, name): &(&str, String)| {
        let energy = records.iter().filter(|r| r.device_name == *device).find_map(|record| energy(record))?;
        Some(match (&energy.meter, &energy.no_meter) {
            (Some(meter), _) => format!("{name} was read by {meter}."),
            (None, reason) => {
                format!(
                    "{name} has no meter: {}. Its energy is not known, and not estimated.",
                    reason.as_deref().unwrap_or("")
                )
            }
        })
    };
    names.iter().filter_map(of_device).collect::<Vec<_>>().join(" ")
}

fn panels(records: &[&Record], y: Axis, point: impl Fn(&Measurement) -> Option<f64>) -> Vec<Panel> {
    let names = DeviceNames::of(records);
    let panel = |(case, n): (&str, usize)| {
        let of_case: Vec<&Record> = records.iter().copied().filter(|r| r.case == case && r.n == n).collect();
        let mut series = by_method(&of_case, &names, |_| true, |_, m| Some((0.0, point(m)?)));
        let step = 1.0 / series.len().max(1) as f64;
        for (k, one) in series.iter_mut().enumerate() {
            one.style = Style::Bar;
            one.points[0].0 = (k as f64 + 0.5) * 0.8 * step - 0.4;
        }
        Panel {
            title: format!("{case}, n = {n}"),
            x: Axis::names(vec![String::new()]),
            y: y.clone(),
            series,
            shade: Vec::new(),
        }
    };
    inputs(records).into_iter().map(panel).filter(is_shown).collect()
}

fn is_shown(panel: &Panel) -> bool {
    panel.series.iter().flat_map(|series| &series.points).any(|point| point.1 > 0.0)
}

fn efficiency(records: &[&Record]) -> Figure {
    let per_joule = |m: &Measurement| {
        let energy = m.energy.as_ref()?;
        (energy.joules > 0.0).then(|| energy.interactions / energy.joules)
    };
    Figure {
        id: "energy-efficiency".into(),
        caption: "Interactions per joule (paper A, figure 12)".into(),
        columns: 3,
        panels: panels(records, Axis::linear("interactions a joule"), per_joule),
    }
}

fn rate(records: &[&Record]) -> Figure {
    let per_second = |m: &Measurement| m.energy.as_ref().map(|energy| energy.interactions / energy.seconds);
    Figure {
        id: "energy-rate".into(),
        caption: "Interactions per second in the same runs".into(),
        columns: 3,
        panels: panels(records, Axis::linear("interactions a second"), per_second),
    }
}

fn power(records: &[&Record]) -> Figure {
    let names = DeviceNames::of(records);
    let panel = |(case, n): (&str, usize)| {
        let of_case: Vec<&Record> = records.iter().copied().filter(|r| r.case == case && r.n == n).collect();
        let curve =
            |_: &Record, m: &Measurement| m.energy.as_ref().map_or_else(Vec::new, |energy| averaged(&energy.power));
        let mut series = curves_by_method(&of_case, &names, |_| true, curve);
        for one in &mut series {
            one.marked = Some(Vec::new());
        }
        let title = format!("{case}, n = {n}");
        Panel { title, x: Axis::linear("s"), y: Axis::linear("W"), series, shade: Vec::new() }
    };
    Figure {
        id: "energy-power".into(),
        caption: "Power by time (paper A, figure 11)".into(),
        columns: 3,
        panels: inputs(records).into_iter().map(panel).filter(is_shown).collect(),
    }
}

/// Power over longer intervals; each point is at the end of its interval, as it is in the record.
fn averaged(power: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let (mut points, mut begin, mut last, mut joules) = (Vec::new(), 0.0, 0.0, 0.0);
    for &(seconds, watts) in power {
        joules += watts * (seconds - last);
        last = seconds;
        if seconds - begin >= AVERAGED {
            points.push((seconds, joules / (seconds - begin)));
            (begin, joules) = (seconds, 0.0);
        }
    }
    points
}

fn table(records: &[&Record]) -> Table {
    let header = ["case", "n", "device", "method", "ms a step", "mean power, W", "mJ a step", "interactions a joule"];
    let row = |record: &&Record| {
        let mut row =
            vec![record.case.clone(), record.n.to_string(), record.device_name.clone(), record.plan.method.to_string()];
        match energy(record) {
            Some(energy) => {
                let known = |value: f64| if energy.meter.is_some() { number(value) } else { "no meter".into() };
                row.push(number(energy.seconds / energy.steps.max(1) as f64 * 1e3));
                row.push(known(energy.joules / energy.seconds));
                row.push(known(energy.joules / energy.steps.max(1) as f64 * 1e3));
                row.push(known(energy.interactions / energy.joules));
            }
            None => row.extend([why_not(&record.outcome).0.to_owned(), String::new(), String::new(), String::new()]),
        }
        row.into_iter().map(Cell::text).collect()
    };
    Table {
        caption: "Energy".into(),
        header: header.map(str::to_owned).to_vec(),
        rows: records.iter().map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averaging_keeps_the_energy_of_short_readings() {
        let power = [(0.01, 2000.0), (0.05, 0.0), (0.3, 400.0), (0.6, 300.0), (0.7, 900.0)];
        let points = averaged(&power);
        assert_eq!(points.len(), 2, "what is left at the end is too short");
        assert!((points[0].1 - (20.0 + 100.0) / 0.3).abs() < 1e-9 && (points[1].1 - 300.0).abs() < 1e-9);
    }
}
