//! Fixed-radius neighbour search and short-range particle simulation.
//!
//! | to | use |
//! |---|---|
//! | find neighbours | [`NeighborSearch`] |
//! | simulate in a program | [`Simulation`] |
//! | run a configuration file as the command does | [`run`] |
//! | make initial conditions | [`generate`] |
//! | read and write files | [`io`] |
//! | draw pictures | [`render`] |
//! | repeat the papers' experiments | [`mod@bench`] |
//!
//! ```
//! use nearfield::{Boundary, ListKind, ListRequest, NeighborSearch, SimBox};
//! let sim_box = SimBox::cubic(10.0, Boundary::Periodic)?;
//! let points = [[0.5, 5.0, 5.0], [9.5, 5.0, 5.0], [5.0, 5.0, 5.0]];
//! let search = NeighborSearch::new(sim_box, points, 2.0)?;
//! let list = search.neighbor_list(ListRequest::new(ListKind::Full));
//! assert_eq!(list.row(0), [1]); // through the periodic face
//! # Ok::<(), nearfield::Error>(())
//! ```

pub mod auto;
pub mod bench;
pub mod config;
mod device;
mod energy;
mod error;
pub mod generate;
pub mod io;
mod methods;
pub mod observe;
pub mod render;
pub mod report;
pub mod run;
mod search;
mod setup;
mod simulation;
mod thermo;

pub use config::Device;
pub use device::{DeviceStatus, GpuStatus, devices, engine};
pub use error::{Error, Result};
pub use methods::{MethodSupport, methods};
pub use nearfield_core::{
    Boundary, Dynamics, Engine, Ensemble, Error as CoreError, Images, Interaction, ListKind, ListRequest, Maintenance,
    Method, Mixing, NeighborList, Order, ParticleType, Particles, PerParticle, Plan, Quantities, Radii, Report, SimBox,
    Skin, System, Totals, Truncation, Vec3s, interaction, potentials,
};
pub use search::{NeighborSearch, Neighbors, Pair};
pub use setup::{configuration_system, file_points, file_system, system};
pub use simulation::{Progress, Simulation, SimulationBuilder};
pub use thermo::Thermo;

/// The examples of the README, tested.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
