//! Fixed-radius neighbour search and short-range particle simulation.

pub mod io;
