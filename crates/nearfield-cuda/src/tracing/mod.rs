//! Ray-traced methods: an acceleration structure over bodies around particles, and rays from each.
//!
//! By [`Probe::Point`], bodies are boxes and rays infinitesimal. The box of particle j has its radius as half width, so
//! the ray of i meets exactly the j with `|x_i - x_j| < r_j` on each axis, the rest of which the predicate refuses in the
//! intersection program. That program also consumes the pair: nothing is reported, and no other program runs.
//!
//! Other probes have spheres or triangles, which the device intersects itself. Their any-hit program applies the
//! predicate, consumes the pair if the hit is the one of the pair that counts, and lets the ray go on.

mod bodies;
mod bvh;
mod ghosts;
mod probe;
mod query;
mod rows;
mod scene;
mod stored_list;
mod view;

pub use bvh::Bvh;
pub use probe::Probe;
pub use query::Step;
pub use rows::{RowNumbers, RowQuery};
pub use scene::{Scene, Sums, Updated};
pub use stored_list::{Outcome, StoredList};
