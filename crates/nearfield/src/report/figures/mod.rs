//! What is shown of each suite, one file each.

mod energy;
mod generations;
mod md;
mod methods;
mod neighbors;
mod policies;
mod primitives;
mod scaling;
mod speedup;

use super::{
    chart::{Series, Style},
    palette,
    results::{Results, devices, distinct, measured, methods as methods_of},
    section::Section,
};
use crate::bench::{Measurement, Record, Suite};
use nearfield_core::Plan;

/// The sections of the suites that have results.
pub(super) fn sections(results: &Results) -> Vec<Section> {
    let mut sections = Vec::new();
    for suite in Suite::ALL {
        let records = results.of(suite);
        if records.is_empty() {
            continue;
        }
        let mut section = match suite {
            Suite::Policies => policies::section(&records),
            Suite::Methods => methods::section(&records),
            Suite::Speedup => speedup::section(&records),
            Suite::Energy => energy::section(&records),
            Suite::Primitives => primitives::section(&records),
            Suite::Neighbors => neighbors::section(&records),
            Suite::Scaling => scaling::section(&records),
            Suite::Md => md::section(&records),
            Suite::Generations => generations::section(&records),
        };
        section.figures.retain(|figure| !figure.is_empty());
        sections.push(section);
    }
    sections
}

/// Names of devices in a legend: short, unless two would be alike.
struct DeviceNames<'a>(Vec<(&'a str, String)>);

impl<'a> DeviceNames<'a> {
    fn of(records: &[&'a Record]) -> Self {
        let names = devices(records);
        let is_unique = |name: &str| names.iter().filter(|other| short(other) == short(name)).count() == 1;
        Self(names.iter().map(|&name| (name, if is_unique(name) { short(name) } else { name.to_owned() })).collect())
    }

    fn iter(&self) -> impl Iterator<Item = &(&'a str, String)> {
        self.0.iter()
    }

    fn is_single(&self) -> bool {
        self.0.len() == 1
    }
}

/// `cpu (2 threads, AVX2)` as `cpu`, `NVIDIA H200` as `H200`.
fn short(device: &str) -> String {
    device.split(" (").next().unwrap_or(device).trim_start_matches("NVIDIA ").to_owned()
}

/// One series for each method and device, of a point for each measurement.
fn by_method(
    records: &[&Record],
    names: &DeviceNames<'_>,
    wanted: impl Fn(&Plan) -> bool,
    point: impl Fn(&Record, &Measurement) -> Option<(f64, f64)>,
) -> Vec<Series> {
    curves_by_method(records, names, wanted, |record, measurement| point(record, measurement).into_iter().collect())
}

/// One series for each method and device. The first device has solid lines, the others dashed ones.
fn curves_by_method(
    records: &[&Record],
    names: &DeviceNames<'_>,
    wanted: impl Fn(&Plan) -> bool,
    curve: impl Fn(&Record, &Measurement) -> Vec<(f64, f64)>,
) -> Vec<Series> {
    let mut all = Vec::new();
    for method in methods_of(records) {
        for (k, (device, short)) in names.iter().enumerate() {
            let of_series = |r: &&&Record| r.plan.method == method && r.device_name == *device && wanted(&r.plan);
            let curve = |record: &&Record| measured(record).map_or_else(Vec::new, |m| curve(record, m));
            let mut points: Vec<_> = records.iter().filter(of_series).flat_map(curve).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            if !points.is_empty() {
                let name = if names.is_single() { method.to_string() } else { format!("{method}, {short}") };
                let style = if k == 0 { Style::Line } else { Style::Dashed };
                all.push(Series { name, look: palette::of_method(method), style, points, marked: None });
            }
        }
    }
    all
}

/// Cases with the number of particles: devices may have been measured at different ones.
fn inputs<'a>(records: &[&'a Record]) -> Vec<(&'a str, usize)> {
    distinct(records, |record| (record.case.as_str(), record.n))
}

/// `quick` sizes are said wherever numbers are shown.
fn sizes_note(records: &[&Record]) -> String {
    let quick = records.iter().filter(|record| record.quick).count();
    match quick {
        0 => String::new(),
        _ if quick == records.len() => "These are the small sizes of a quick run, not the papers'.".into(),
        _ => "Some devices have results of a quick run only, whose sizes are smaller than the papers'.".into(),
    }
}
