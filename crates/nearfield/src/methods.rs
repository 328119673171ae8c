//! The table of methods: what each supports on each device.

use nearfield_core::Method;
use serde::Serialize;

/// What a method supports on a device.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodSupport {
    /// The method.
    pub method: Method,
    /// The device.
    pub device: &'static str,
    /// Structure, probe and consumer.
    pub sentence: &'static str,
    /// Its name in the papers.
    pub paper_name: &'static str,
    /// Whether particles may differ in search radius.
    pub variable_radii: bool,
    /// Whether `images` and `maintenance` apply.
    pub bvh: bool,
    /// Whether `skin` applies.
    pub list: bool,
    /// Whether `list_tolerance` applies; without, lists miss no pair.
    pub list_tolerance: bool,
}

/// Names of the devices that have the methods, without numbers.
const DEVICES: [&str; 2] = ["cpu", "cuda"];

/// Every method on every kind of device, whether this machine has one or not ([`crate::devices`] says so).
pub fn methods() -> Vec<MethodSupport> {
    let everywhere = |device| Method::ALL.iter().map(move |&method| support(method, device));
    DEVICES.iter().flat_map(|&device| everywhere(device)).collect()
}

fn support(method: Method, device: &'static str) -> MethodSupport {
    let (sentence, paper_name) = match method {
        Method::Brute => ("no structure, all pairs, gather", "the oracle"),
        Method::Cell if device == "cpu" => ("grid, cell scan, gather", "CPU-CELL (A)"),
        Method::Cell => ("grid, cell scan, gather", "GPU-CELL (A)"),
        Method::RtList => ("boxes, point ray, list", "RT-REF (A)"),
        Method::RtForces => ("boxes, point ray, scatter", "ORCS-forces (A)"),
        Method::RtPerse => ("boxes, point ray, advance", "ORCS-perse (A)"),
        Method::Cluster => ("cluster grid, cluster pairs, list", "ours"),
        Method::RtBoxes => ("boxes, point ray, gather", "custom AABB (B)"),
        Method::RtSpheres => ("spheres, axis rays, gather", "spheres (B)"),
        Method::RtSquares => ("squares, edge rays, gather", "double squares (B)"),
    };
    MethodSupport {
        method,
        device,
        sentence,
        paper_name,
        variable_radii: method.supports_variable_radii(),
        bvh: method.uses_bvh(),
        list: method.uses_list(),
        list_tolerance: method == Method::Cluster && device == "cpu",
    }
}
