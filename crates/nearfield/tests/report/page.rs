//! Files and page.

use crate::fixture::CPU;
use nearfield::{
    Error,
    bench::{Energy, Outcome, Record, Suite},
    report,
};
use std::fs;

/// Figures that a run on one device without a meter has.
const FIGURES: [&str; 17] = [
    "policies-cpu-200",
    "methods-cpu-200",
    "speedup-wall",
    "speedup-periodic",
    "energy-rate",
    "primitives-uniform-cpu",
    "primitives-uniform-build-cpu",
    "primitives-uniform-compute-cpu",
    "primitives-sphere-cpu",
    "primitives-sphere-build-cpu",
    "primitives-sphere-compute-cpu",
    "primitives-memory-cpu",
    "neighbors",
    "scaling",
    "scaling-images-cpu",
    "md",
    "generations-performance",
];

pub fn each_suite_has_its_figures_as_svg_and_png() {
    for name in FIGURES {
        let svg = fs::read_to_string(CPU.folder.path().join(format!("{name}.svg"))).expect(name);
        let document = roxmltree::Document::parse(&svg).expect(name);
        assert_eq!(document.root_element().tag_name().name(), "svg");
        let shapes =
            document.descendants().filter(|node| node.has_tag_name("polyline") || node.has_tag_name("polygon"));
        assert!(shapes.count() > 5 || name.starts_with("energy"), "{name} shows something");
        let file = fs::File::open(CPU.folder.path().join(format!("{name}.png"))).expect(name);
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect(name);
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).expect(name);
        let width: u32 = document.root_element().attribute("width").unwrap().parse().unwrap();
        assert_eq!(info.width, 2 * width);
        let dark = pixels.chunks(3).filter(|rgb| rgb.iter().all(|&value| value < 80)).count();
        assert!(dark > 500, "{name}: letters and axes are drawn");
    }
    assert!(CPU.written.iter().all(|path| path.is_file()));
}

pub fn the_page_is_well_formed_and_holds_every_figure() {
    let page = CPU.page();
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(&page, options).unwrap();
    for name in FIGURES {
        let id = format!("figure-{name}");
        let figure = document.descendants().find(|node| node.attribute("id") == Some(id.as_str())).expect(name);
        assert!(figure.descendants().any(|node| node.tag_name().name() == "svg"), "{name}");
    }
    for suite in Suite::ALL {
        let section = document.descendants().find(|node| node.attribute("id") == Some(suite.name()));
        assert!(section.is_some(), "{suite}");
        assert!(page.contains(&format!("nearfield bench {suite} --quick --device cpu -o out")), "{suite}");
    }
    assert!(page.contains("all methods on all devices found the same number of pairs"));
    assert!(page.contains("paper A, table 2"));
}

pub fn the_page_needs_no_network() {
    let page = CPU.page().replace("http://www.w3.org/2000/svg", "").replace("http://www.w3.org/1999/xlink", "");
    for reference in ["http:", "https:", "<script", "<link", "@import", "url("] {
        assert!(!page.contains(reference), "{reference}");
    }
}

/// Makes a record one of a GPU with a meter, twice as fast.
fn on_gpu(record: &mut Record) {
    record.device = "cuda:0".into();
    record.device_name = "NVIDIA H200".into();
    if let Outcome::Measured(measurement) = &mut record.outcome {
        measurement.time.median *= 0.5;
        if let Some(energy) = &mut measurement.energy {
            *energy = Energy {
                meter: Some("NVML, GPU board".into()),
                no_meter: None,
                joules: 100.0,
                power: vec![(0.5, 90.0), (1.0, 110.0)],
                ..energy.clone()
            };
        }
    }
}

pub fn results_of_two_devices_are_drawn_together() {
    let folder = tempfile::tempdir().unwrap();
    for suite in Suite::ALL {
        CPU.copy(suite, folder.path(), |_| {});
        CPU.copy(suite, &folder.path().join("h200"), on_gpu);
    }
    let output = folder.path().join("report");
    let written = report::plot(folder.path(), &output).unwrap();
    let page = fs::read_to_string(&written[0]).unwrap();
    assert!(page.contains("cell, H200") && page.contains("cell, cpu"));
    for figure in ["energy-power", "energy-efficiency", "generations-efficiency", "policies-h200-200"] {
        assert!(page.contains(&format!("figure-{figure}")), "{figure}");
        assert!(output.join(format!("{figure}.svg")).is_file(), "{figure}");
    }
    assert!(page.contains("H200 was read by NVML, GPU board."));
}

pub fn full_results_take_the_place_of_quick_ones() {
    let folder = tempfile::tempdir().unwrap();
    CPU.copy(Suite::Md, folder.path(), |_| {});
    CPU.copy(Suite::Md, &folder.path().join("full"), |record| {
        record.quick = false;
        record.n = 50_000;
    });
    let written = report::plot(folder.path(), folder.path()).unwrap();
    let page = fs::read_to_string(&written[0]).unwrap();
    assert!(page.contains("<td>50000</td><td>cell</td>") && !page.contains("<td>256</td><td>cell</td>"));
    assert!(!page.contains("--quick"));
}

pub fn wrong_results_are_named_on_the_page() {
    let folder = tempfile::tempdir().unwrap();
    CPU.copy(Suite::Md, folder.path(), |record| record.outcome = Outcome::Mismatch { pairs: 41, expected: 42 });
    let written = report::plot(folder.path(), folder.path()).unwrap();
    let page = fs::read_to_string(&written[0]).unwrap();
    assert!(page.contains("41 pairs instead of 42"));
    assert!(!page.contains("found the same number of pairs"));
}

pub fn a_folder_without_results_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let error = report::plot(folder.path(), folder.path()).unwrap_err();
    assert!(matches!(error, Error::NoResults { .. }), "{error}");
    assert!(report::plot(&folder.path().join("absent"), folder.path()).is_err());
}
