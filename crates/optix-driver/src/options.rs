//! Options that modules and the pipelines linked from them share.

use std::ffi::CString;
use std::ops::BitOr;

use crate::sys;

/// What programs of a pipeline may use. A pipeline and its modules are made with equal options.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PipelineOptions {
    /// Kinds of traversables that rays may start in.
    pub graph: TraversableGraph,
    /// 32-bit payload words of a ray, at most 32.
    pub payload_words: u32,
    /// 32-bit attribute words that an intersection program reports; built-in primitives need 2.
    pub attribute_words: u32,
    /// Kinds of primitives that are traced.
    pub primitives: Primitives,
    /// Name of the `__constant__` variable that holds the launch parameters.
    pub params_name: CString,
}

impl PipelineOptions {
    /// For the driver; points into `self`.
    pub(crate) fn lower(&self) -> sys::PipelineOptions {
        sys::PipelineOptions {
            uses_motion: 0,
            graph_flags: self.graph.flags(),
            num_payload: self.payload_words,
            num_attributes: self.attribute_words,
            exception_flags: 0,
            params_name: self.params_name.as_ptr(),
            primitive_flags: self.primitives.0,
            uses_micromaps: 0,
        }
    }
}

impl Default for PipelineOptions {
    /// Custom primitives in one geometry acceleration structure, no payload, 2 attribute words, parameters `params`.
    fn default() -> Self {
        Self {
            graph: TraversableGraph::SingleGas,
            payload_words: 0,
            attribute_words: 2,
            primitives: Primitives::CUSTOM,
            params_name: c"params".to_owned(),
        }
    }
}

/// Kinds of traversables that rays may start in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraversableGraph {
    /// A geometry acceleration structure (GAS).
    SingleGas,
    /// An instance acceleration structure (IAS) over geometry.
    SingleLevelInstancing,
    /// Either; costs nothing against [`SingleGas`](Self::SingleGas).
    Both,
}

impl TraversableGraph {
    fn flags(self) -> u32 {
        match self {
            Self::SingleGas => sys::GRAPH_SINGLE_GAS,
            Self::SingleLevelInstancing => sys::GRAPH_SINGLE_LEVEL_INSTANCING,
            Self::Both => sys::GRAPH_SINGLE_GAS | sys::GRAPH_SINGLE_LEVEL_INSTANCING,
        }
    }

    /// Most traversables that a ray passes through on its way to a primitive.
    pub(crate) fn depth(self) -> u32 {
        match self {
            Self::SingleGas => 1,
            Self::SingleLevelInstancing | Self::Both => 2,
        }
    }
}

/// Set of kinds of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Primitives(u32);

impl Primitives {
    /// Boxes with an intersection program of the user.
    pub const CUSTOM: Self = Self(sys::PRIMITIVE_CUSTOM);
    /// Built-in spheres.
    pub const SPHERES: Self = Self(sys::PRIMITIVE_SPHERE);
    /// Built-in triangles.
    pub const TRIANGLES: Self = Self(sys::PRIMITIVE_TRIANGLE);
}

impl BitOr for Primitives {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// Options of one module. The driver chooses optimisation and debug information.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ModuleOptions {
    /// Most registers of a thread; 0 leaves the choice to the driver.
    pub max_registers: u32,
}

impl ModuleOptions {
    pub(crate) fn lower(self) -> sys::ModuleOptions {
        sys::ModuleOptions {
            max_registers: self.max_registers,
            optimization_level: 0,
            debug_level: 0,
            bound_values: std::ptr::null(),
            num_bound_values: 0,
            num_payload_types: 0,
            payload_types: std::ptr::null(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_of_primitives_are_unions_of_the_drivers_flags() {
        let all = Primitives::CUSTOM | Primitives::SPHERES | Primitives::TRIANGLES;
        assert_eq!(PipelineOptions { primitives: all, ..Default::default() }.lower().primitive_flags, 0x8000_0041);
    }

    #[test]
    fn only_instancing_makes_the_graph_deeper_than_one() {
        use TraversableGraph::{Both, SingleGas, SingleLevelInstancing};
        let graphs = [SingleGas, SingleLevelInstancing, Both];
        assert_eq!(graphs.map(TraversableGraph::flags), [1, 2, 3]);
        assert_eq!(graphs.map(TraversableGraph::depth), [1, 2, 2]);
    }
}
