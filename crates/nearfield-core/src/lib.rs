//! What every Nearfield crate shares: the box, particles, the one neighbour predicate, neighbour lists, potentials,
//! maintenance policies, the [`Engine`] trait, and the float64 brute-force [`oracle`].
//!
//! No threads, no GPU, no file I/O: an engine adds those. Users want the `nearfield` crate.

pub mod dynamics;
pub mod engine;
mod error;
pub mod interaction;
pub mod maintenance;
mod neighbor_list;
pub mod oracle;
mod particles;
pub mod philox;
mod plan;
pub mod potentials;
pub mod predicate;
mod radii;
mod sim_box;
pub mod skin;
mod system;
mod vec3s;

pub use dynamics::{Dynamics, Ensemble};
pub use engine::{Engine, PerParticle, Quantities, Report, StepCost, Totals};
pub use error::{Error, Result};
pub use interaction::{Interaction, Mixing, ParticleType, Truncation};
pub use maintenance::Maintenance;
pub use neighbor_list::{ListKind, ListRequest, NeighborList};
pub use particles::Particles;
pub use plan::{Images, Method, Order, Plan};
pub use radii::Radii;
pub use sim_box::{Boundary, SimBox};
pub use skin::Skin;
pub use system::System;
pub use vec3s::Vec3s;
