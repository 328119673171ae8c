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
}

/// Every method on every device of this version.
pub fn methods() -> Vec<MethodSupport> {
    Method::ALL
        .iter()
        .map(|&method| {
            let (sentence, paper_name) = match method {
                Method::Brute => ("no structure, all pairs, gather", "the oracle"),
                Method::Cell => ("grid, cell scan, gather", "CPU-CELL (A)"),
                Method::RtList => ("boxes, point ray, list", "RT-REF (A)"),
                Method::RtForces => ("boxes, point ray, scatter", "ORCS-forces (A)"),
                Method::RtPerse => ("boxes, point ray, advance", "ORCS-perse (A)"),
                Method::RtBoxes => ("boxes, point ray, gather", "custom AABB (B)"),
            };
            MethodSupport {
                method,
                device: "cpu",
                sentence,
                paper_name,
                variable_radii: method.supports_variable_radii(),
                bvh: method.uses_bvh(),
                list: method.uses_list(),
            }
        })
        .collect()
}
