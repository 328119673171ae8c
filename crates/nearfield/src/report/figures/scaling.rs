//! Time and memory of a particle by system size.

use super::{DeviceNames, by_method, sizes_note};
use crate::{
    bench::{Measurement, Record, Suite},
    report::{
        chart::{Axis, Figure, Panel, Style},
        section::Section,
    },
};
use nearfield_core::Images;

pub(super) fn section(records: &[&Record]) -> Section {
    let names = DeviceNames::of(records);
    let panel = |title: &str, unit: &str, value: fn(&Measurement, f64) -> f64| {
        let point = move |r: &Record, m: &Measurement| Some((r.n as f64, value(m, r.n as f64)));
        let series = by_method(records, &names, |plan| plan.images == Images::Gamma, point);
        Panel { title: title.into(), x: Axis::log("particles"), y: Axis::log(unit), series, shade: Vec::new() }
    };
    let basic = vec![
        panel("time of a step", "ns a particle", |m, n| m.time.median * 1e9 / n),
        panel("memory of the engine", "bytes a particle", |m, _| m.bytes_per_particle),
    ];
    let images = names.iter().map(|(device, name)| images(records, device, name));
    let mut figures = vec![Figure {
        id: "scaling".into(),
        caption: "A Lennard-Jones gas of density 0.4, cutoff 2.5, periodic".into(),
        columns: 2,
        panels: basic,
    }];
    figures.extend(images);
    let text = [
        "Whole steps at one density: a method that scales has flat lines. Below, the treatments of periodic images of the \
         methods on trees: rays from shifted origins (gamma, paper A's), instances of the tree, and ghost particles \
         (tutorial C's).",
        &sizes_note(records),
    ];
    Section {
        suite: Suite::Scaling,
        title: "Scaling",
        text: text.map(str::to_owned).to_vec(),
        figures,
        tables: Vec::new(),
    }
}

fn images(records: &[&Record], device: &str, name: &str) -> Figure {
    let of_device: Vec<&Record> = records.iter().copied().filter(|r| r.device_name == device).collect();
    let names = DeviceNames::of(&of_device);
    let panel = |&images: &Images| {
        let wanted = |plan: &nearfield_core::Plan| plan.images == images && plan.method.uses_bvh();
        let mut series =
            by_method(&of_device, &names, wanted, |r, m| Some((r.n as f64, m.time.median * 1e9 / r.n as f64)));
        for one in &mut series {
            one.style = Style::Line;
        }
        Panel {
            title: images.to_string(),
            x: Axis::log("particles"),
            y: Axis::log("ns a particle"),
            series,
            shade: Vec::new(),
        }
    };
    Figure {
        id: format!("scaling-images-{}", crate::report::results::slug(name)),
        caption: format!("Time of a step by treatment of periodic images on {name}"),
        columns: 3,
        panels: Images::ALL.iter().map(panel).collect(),
    }
}
