//! How a system is to be computed: method, images, order, maintenance and their settings.

use crate::{Maintenance, Skin};
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// Names of a closed set of choices: parsing, printing and listing from one table.
macro_rules! named_enum {
    ($(#[$meta:meta])* $name:ident, $what:literal { $($(#[$vmeta:meta])* $variant:ident = $text:literal,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum $name { $($(#[$vmeta])* #[serde(rename = $text)] $variant,)+ }

        impl $name {
            /// Every variant, in the order of the documentation.
            pub const ALL: &[Self] = &[$(Self::$variant,)+];

            /// The name used on the command line and in files.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $text,)+ }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.pad(self.name())
            }
        }

        impl FromStr for $name {
            type Err = String;
            fn from_str(text: &str) -> Result<Self, String> {
                Self::ALL.iter().copied().find(|v| v.name() == text).ok_or_else(|| {
                    let names: Vec<_> = Self::ALL.iter().map(|v| v.name()).collect();
                    format!("unknown {} \"{text}\"; there are {}", $what, names.join(", "))
                })
            }
        }
    };
}

named_enum! {
    /// A way to find and consume pairs: structure, probe and consumer (see ARCHITECTURE.md).
    Method, "method" {
        /// All pairs.
        Brute = "brute",
        /// Grid, cell scan, gather. CPU-CELL and GPU-CELL of paper A, the CUDA grid of paper B.
        Cell = "cell",
        /// BVH over boxes, point ray, neighbour list. RT-REF of paper A.
        RtList = "rt-list",
        /// BVH over boxes, point ray, scatter to both particles. ORCS-forces of paper A.
        RtForces = "rt-forces",
        /// BVH over boxes, point ray, force and integration in one pass. ORCS-persé of paper A; one radius only.
        RtPerse = "rt-perse",
        /// BVH over boxes, point ray, gather. Custom AABB of paper B; one radius only.
        RtBoxes = "rt-boxes",
        /// BVH over spheres, three axis rays, gather. Spheres of paper B; one radius only.
        RtSpheres = "rt-spheres",
        /// BVH over squares, four edge rays, gather. Double squares of paper B; one radius only.
        RtSquares = "rt-squares",
        /// Grid of clusters, cluster pairs, list. The fastest for most systems.
        Cluster = "cluster",
    }
}

impl Method {
    /// Whether it works on a BVH, so that images and maintenance mean something.
    pub fn uses_bvh(self) -> bool {
        !matches!(self, Self::Brute | Self::Cell | Self::Cluster)
    }

    /// Whether it stores a neighbour list, so that a skin means something.
    pub fn uses_list(self) -> bool {
        matches!(self, Self::RtList | Self::Cluster)
    }

    /// Whether particles may differ in search radius. A point ray from i finds the j whose box holds i, that is
    /// d < r_j; a gather that needs max(r_i, r_j) therefore misses pairs unless the radii are equal.
    pub fn supports_variable_radii(self) -> bool {
        !matches!(self, Self::RtPerse | Self::RtBoxes | Self::RtSpheres | Self::RtSquares)
    }
}

named_enum! {
    /// How BVH methods see periodic images.
    Images, "images" {
        /// Extra rays from shifted origins near the faces (paper A, section 3.3).
        Gamma = "gamma",
        /// Translated instances of the one structure under a top level.
        Instances = "instances",
        /// Mirror particles near the faces (tutorial C).
        Ghosts = "ghosts",
    }
}

named_enum! {
    /// Order of particles in an engine's memory. Output always comes in input order.
    Order, "order" {
        /// As given.
        None = "none",
        /// Along a space-filling curve, on the CPU Hilbert's.
        Morton = "morton",
        /// By grid cell.
        Cell = "cell",
    }
}

/// Everything about how to compute, nothing about what.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The method.
    pub method: Method,
    /// Periodic images of BVH methods.
    pub images: Images,
    /// Memory order.
    pub order: Order,
    /// When a BVH is rebuilt rather than refitted.
    pub maintenance: Maintenance,
    /// Verlet skin of list methods.
    pub skin: Skin,
    /// Greatest drift of the energy that pairs missed by a stored list may be expected to cause, for each particle and unit
    /// of time; 0 where no list may miss any. Only `cluster` on a CPU makes use of it: others miss none.
    #[serde(default)]
    pub list_tolerance: f64,
    /// Sum forces independently of order, so that results are bitwise equal across methods and thread counts.
    /// BVH methods always do; `cell` and `brute` are faster without.
    pub deterministic: bool,
    /// Most bytes a stored neighbour list may take; beyond it the list is processed in batches.
    pub memory_budget: u64,
}

impl Plan {
    /// A plan for a method, with the defaults of the command line for the rest.
    pub fn new(method: Method) -> Self {
        Self {
            method,
            images: Images::Gamma,
            order: Order::Morton,
            maintenance: Maintenance::Gradient,
            skin: Skin::Auto,
            list_tolerance: 0.0,
            deterministic: false,
            memory_budget: 4 << 30,
        }
    }
}
