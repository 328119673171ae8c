//! The compiled sources.

/// A source file and what it was compiled to.
#[derive(Clone, Copy, Debug)]
pub struct Module {
    /// Name of the source without its extension.
    pub name: &'static str,
    /// PTX for compute capability 7.5 and up.
    pub ptx: &'static str,
}

macro_rules! modules {
    ($($name:literal),* $(,)?) => {
        &[$(Module { name: $name, ptx: include_str!(concat!("../ptx/", $name, ".ptx")) }),*]
    };
}

/// CUDA kernels, from `cuda/`.
pub const MODULES: &[Module] = modules![
    "integrate",
    "totals",
    "order",
    "scan",
    "cells",
    "brute",
    "cell_forces",
    "lists",
    "boxes",
    "bodies",
    "ghosts",
    "rows"
];

/// Ray-tracing programs, from `optix/`.
pub const RAY_MODULES: &[Module] = modules![
    "ray_gather",
    "ray_scatter",
    "ray_advance",
    "ray_list",
    "axis_gather",
    "axis_list",
    "edge_gather",
    "edge_list"
];
