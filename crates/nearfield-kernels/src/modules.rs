//! The compiled sources.

/// A source file and what it was compiled to.
#[derive(Clone, Copy, Debug)]
pub struct Module {
    /// Name of the source without its extension.
    pub name: &'static str,
    /// PTX for compute capability 7.5 and up.
    pub ptx: &'static str,
    /// PTX for 9.0 and up, where that has instructions which matter.
    pub ptx_90: Option<&'static str>,
}

impl Module {
    /// The PTX for a device of this compute capability.
    pub fn ptx_for(&self, compute_capability: (i32, i32)) -> &'static str {
        self.ptx_90.filter(|_| compute_capability >= (9, 0)).unwrap_or(self.ptx)
    }
}

macro_rules! modules {
    ($($name:literal $(and $newer:literal)?),* $(,)?) => {
        &[$(Module {
            name: $name,
            ptx: include_str!(concat!("../ptx/", $name, ".ptx")),
            ptx_90: [$(Some(include_str!(concat!("../ptx/", $newer, ".ptx"))),)? None][0],
        }),*]
    };
}

/// CUDA kernels, from `cuda/`.
pub const MODULES: &[Module] = modules![
    "integrate",
    "totals",
    "order",
    "queries",
    "scan",
    "sparse_list",
    "staged_lists",
    "cells",
    "brute",
    "cell_forces",
    "cell_step",
    "cluster_forces" and "cluster_forces.sm_90",
    "cluster_list",
    "cluster_step",
    "listed_forces",
    "listed_pairs" and "listed_pairs.sm_90",
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
