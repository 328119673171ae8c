//! Paper A, figure 8.

use super::{DeviceNames, sizes_note};
use crate::{
    bench::{self, Record, Suite},
    report::{
        chart::{Axis, Figure, Panel, Series, Style},
        palette::look,
        results::{distinct, measured, sizes, slug, why_not},
        section::Section,
        table::{Cell, Table, mark_least, number},
    },
};

/// Most points of a line, and most marks.
const POINTS: usize = 100;
const MARKS: usize = 60;

pub(super) fn section(records: &[&Record]) -> Section {
    let names = DeviceNames::of(records);
    let (mut figures, mut tables) = (Vec::new(), Vec::new());
    for (device, name) in names.iter() {
        let of_device: Vec<&Record> = records.iter().copied().filter(|r| r.device_name == *device).collect();
        for n in sizes(&of_device) {
            let of_size: Vec<&Record> = of_device.iter().copied().filter(|r| r.n == n).collect();
            figures.push(figure(&of_size, name, n));
            tables.push(table(&of_size, name, n));
            tables.extend(joules(&of_size, name, n));
        }
    }
    let text = [
        "What finding pairs costs by time step, under several rules for when to rebuild the tree instead of refitting it: \
         structure and query of rt-list without a skin, periodic; medians of a few steps. Marks are rebuilds; the shaded area is the number of \
         interactions per particle, its largest value in the title. The paper has gradient, \
         fixed:200 and average; rebuilding at each step is what it does not show, and gradient:joules, which optimises \
         energy where the device has a meter, what it leaves to the future.",
        &sizes_note(records),
    ];
    Section {
        suite: Suite::Policies,
        title: "When to rebuild",
        text: text.map(str::to_owned).to_vec(),
        figures,
        tables,
    }
}

fn policies(records: &[&Record]) -> Vec<String> {
    distinct(records, |record| record.plan.maintenance.to_string())
}

fn figure(records: &[&Record], device: &str, n: usize) -> Figure {
    let policies = policies(records);
    let panel = |case: &str| {
        let of_case: Vec<&Record> = records.iter().copied().filter(|record| record.case == case).collect();
        let series = |record: &&Record| {
            let policy = record.plan.maintenance.to_string();
            let k = policies.iter().position(|other| *other == policy).unwrap_or_default();
            Some(line(measured(record)?.series.as_ref()?, policy, k))
        };
        let shade: Vec<_> = of_case
            .iter()
            .find_map(|record| measured(record)?.series.as_ref())
            .map(|series| series.interactions.iter().map(|&(step, pairs)| (step as f64, pairs)).collect())
            .unwrap_or_default();
        let most = shade.iter().map(|p: &(f64, f64)| p.1).fold(0.0, f64::max);
        let title = case.trim_end_matches(" periodic");
        Panel {
            title: if most > 0.0 { format!("{title}, up to {} per particle", number(most)) } else { title.into() },
            x: Axis::linear("step"),
            y: Axis::linear("ms a step"),
            series: of_case.iter().filter_map(series).collect(),
            shade,
        }
    };
    let shown: Vec<&Record> = records.iter().copied().filter(|record| measured(record).is_some()).collect();
    let mut cases = distinct(&shown, |record| record.case.as_str());
    // As in the paper: a row of positions, a column of radii.
    cases.sort_by_key(|case| ["lattice", "disordered", "cluster"].iter().position(|p| case.starts_with(p)));
    Figure {
        id: format!("policies-{}-{n}", slug(device)),
        caption: format!("Time of structure and query by step on {device}, n = {n} (paper A, figure 8)"),
        columns: match distinct(&shown, |record| record.case.split(' ').nth(1)).len() {
            1 => cases.len(),
            several => several,
        },
        panels: cases.into_iter().map(panel).collect(),
    }
}

/// Medians over a few steps, and marks where the structure was built.
fn line(series: &bench::Series, name: String, k: usize) -> Series {
    let total: Vec<f64> = series.structure.iter().zip(&series.query).map(|(s, q)| (s + q) * 1e-3).collect();
    let width = total.len().div_ceil(POINTS).max(1);
    let median = |(k, chunk): (usize, &[f64])| {
        let mut sorted = chunk.to_vec();
        sorted.sort_by(f64::total_cmp);
        ((k * width) as f64 + 0.5 * chunk.len() as f64, sorted[chunk.len() / 2])
    };
    let points: Vec<_> = total.chunks(width).enumerate().map(median).collect();
    let at = |&step: &usize| points.get(step / width).map(|p| (step as f64, p.1));
    let marked = if series.builds.len() > MARKS { Vec::new() } else { series.builds.iter().filter_map(at).collect() };
    Series { name, look: look(k + 1), style: Style::Line, points, marked: Some(marked) }
}

fn table(records: &[&Record], device: &str, n: usize) -> Table {
    let policies = policies(records);
    let mut header = vec!["case".to_owned()];
    header.extend(policies.iter().map(|policy| format!("{policy}, s (rebuilds)")));
    header.push("gradient against the best of the paper's others".into());
    let rows = distinct(records, |record| record.case.as_str()).into_iter().map(|case| {
        let total = |policy: &str| {
            let record = records.iter().find(|r| r.case == case && r.plan.maintenance.to_string() == policy)?;
            let series = measured(record)?.series.as_ref()?;
            Some((series.structure.iter().chain(&series.query).sum::<f64>() * 1e-6, series.builds.len()))
        };
        let mut cells: Vec<_> = policies
            .iter()
            .map(|policy| match total(policy) {
                Some((seconds, builds)) => (Some(seconds), Cell::text(format!("{} ({builds})", number(seconds)))),
                None => {
                    let is_it = |r: &&&Record| r.case == case && r.plan.maintenance.to_string() == **policy;
                    let (text, hint) = records.iter().find(is_it).map_or(("", String::new()), |r| why_not(&r.outcome));
                    (None, Cell { text: text.into(), is_best: false, hint })
                }
            })
            .collect();
        mark_least(&mut cells);
        let others = ["fixed:200", "average"].into_iter().filter_map(total).map(|(s, _)| s);
        let second = others.fold(f64::INFINITY, f64::min);
        let ratio = total("gradient").filter(|_| second.is_finite());
        let ratio = ratio.map_or("–".into(), |(s, _)| format!("{:.2}x", second / s));
        let cells = cells.into_iter().map(|(_, cell)| cell);
        [Cell::text(case)].into_iter().chain(cells).chain([Cell::text(ratio)]).collect()
    });
    Table {
        caption: format!("Structure and query seconds of the whole run on {device}, n = {n}"),
        header,
        rows: rows.collect(),
    }
}

/// Energy of the runs, where there was a meter.
fn joules(records: &[&Record], device: &str, n: usize) -> Option<Table> {
    let policies = policies(records);
    let energy = |case: &str, policy: &str| {
        let record = records.iter().find(|r| r.case == case && r.plan.maintenance.to_string() == policy)?;
        measured(record)?.energy.as_ref().filter(|energy| energy.meter.is_some())
    };
    let row = |case: &str| {
        let cell = |policy: &String| match energy(case, policy) {
            Some(energy) => (Some(energy.joules), Cell::number(energy.joules)),
            None => (None, Cell::text("–")),
        };
        let mut cells: Vec<_> = policies.iter().map(cell).collect();
        mark_least(&mut cells);
        [Cell::text(case)].into_iter().chain(cells.into_iter().map(|(_, cell)| cell)).collect()
    };
    let cases = distinct(records, |record| record.case.as_str());
    let has_meter = cases.iter().any(|case| policies.iter().any(|policy| energy(case, policy).is_some()));
    has_meter.then(|| Table {
        caption: format!("Energy of the whole run on {device}, n = {n}"),
        header: ["case".to_owned()].into_iter().chain(policies.iter().map(|policy| format!("{policy}, J"))).collect(),
        rows: cases.into_iter().map(row).collect(),
    })
}
