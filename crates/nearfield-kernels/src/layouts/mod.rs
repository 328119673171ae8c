//! The structures that kernels take, one file a subject.

mod clusters;
mod grid;
mod particles;
mod physics;
mod tracing;

pub use clusters::*;
pub use grid::*;
pub use particles::*;
pub use physics::*;
pub use tracing::*;

use crate::layout::Definition;

/// The generated header `layouts.cuh`.
pub fn header() -> String {
    let mut text = String::from(
        "// Generated from nearfield-kernels/src/layouts by `cargo xtask ptx`; edit there.\n\n#pragma once\n\n\
         #include \"base.cuh\"\n",
    );
    let files = [
        physics::definitions(),
        particles::definitions(),
        grid::definitions(),
        clusters::definitions(),
        tracing::definitions(),
    ];
    for Definition { text: definition } in files.iter().flatten() {
        text.push('\n');
        text.push_str(definition);
    }
    text
}
