//! Initial conditions: positions, search radii and velocities from a few numbers and a seed.
//!
//! One file per arrangement. Positions, radii and velocities draw from separate random streams, so changing one of
//! them leaves the others as they were. A seed means the same start everywhere: generation is sequential, and every
//! operation rounds alike on all platforms. (One exception: normal draws beyond 3.65 sigma, one in 3900, and some
//! rejection tests take the platform's f64 `ln` and `exp`; a different last bit rarely survives rounding to f32.)

mod cluster;
mod disordered;
mod error;
mod fcc;
mod lattice;
mod paper_b;
mod radii;
mod random;
mod spec;
mod sphere_surface;
mod velocities;

pub use cluster::cluster;
pub use disordered::disordered;
pub use error::{Error, Result};
pub use fcc::fcc;
pub use lattice::lattice;
pub use paper_b::Workload;
pub use radii::{Distribution, Outside, RadiiSpec};
pub use spec::{Generate, Generated, Positions};
pub use sphere_surface::{sphere_surface, sphere_surface_cutoff};
pub use velocities::{temperature, velocities};

use nearfield_core::SimBox;

/// `value` in f32, moved into `[lo, hi)` of the axis where it lies outside or rounding put it there.
fn inside(sim_box: &SimBox, axis: usize, value: f64) -> f32 {
    (value as f32).clamp(sim_box.lo()[axis], sim_box.hi()[axis].next_down())
}
