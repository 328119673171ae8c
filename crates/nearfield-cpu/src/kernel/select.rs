//! From a system's interaction to a monomorphic pair law and its coefficients.

use nearfield_core::{
    interaction::{PairLaw, Truncated},
    potentials::{Gaussian, LennardJones, Morse, Table, Wca, Yukawa},
};
use std::sync::Arc;

/// A pair law and how it is best compiled.
pub(crate) trait Law: PairLaw {
    /// Whether it is worth a kernel of its own for each way of summing: its arithmetic is so little that everything
    /// else shows.
    const FAST: bool = false;
    /// Whether lanes can be computed together. Otherwise (exponentials, tables) only neighbours are computed, one by
    /// one.
    const VECTORISES: bool = false;
}

impl<const FORCE_SHIFT: bool> Law for Truncated<'_, LennardJones, FORCE_SHIFT> {
    const FAST: bool = true;
    const VECTORISES: bool = true;
}
impl Law for Truncated<'_, Wca, true> {
    const VECTORISES: bool = true;
}
impl Law for Truncated<'_, Yukawa, true> {}
impl Law for Truncated<'_, Morse, true> {}
impl Law for Truncated<'_, Gaussian, true> {}
impl Law for Truncated<'_, Arc<Table>, true> {}

/// Runs `$body` with the system's law and coefficients.
macro_rules! with_law {
    ($physics:expr, $law:ident, $coefficients:ident => $body:expr) => {{
        use nearfield_core::{Truncation, interaction::Truncated, potentials::Potential, with_potential};
        let interaction = &$physics.interaction;
        match &interaction.potential {
            Potential::LennardJones(p) if interaction.truncation != Truncation::Force => {
                let $law = &Truncated::<_, false>(p);
                $crate::kernel::select::with_coefficients!($physics, p, $coefficients => $body)
            }
            potential => with_potential!(potential, p => {
                let $law = &Truncated::<_, true>(p);
                $crate::kernel::select::with_coefficients!($physics, p, $coefficients => $body)
            }),
        }
    }};
}
pub(crate) use with_law;

/// Runs `$body` with the coefficients that the system's types and radii ask for.
macro_rules! with_coefficients {
    ($physics:expr, $potential:ident, $coefficients:ident => $body:expr) => {{
        use nearfield_core::{Radii, interaction::Typed};
        let interaction = &$physics.interaction;
        match $physics.radii {
            Radii::Uniform(cutoff) if interaction.types.len() == 1 => {
                let $coefficients = interaction.single(cutoff);
                $body
            }
            Radii::Uniform(cutoff) => {
                let table = interaction.typed_table(cutoff);
                let $coefficients = Typed::new(&table);
                $body
            }
            Radii::PerParticle(_) if let Some($coefficients) = interaction.scaled_cut() => $body,
            Radii::PerParticle(_) => {
                let epsilon = interaction.epsilon_table();
                let $coefficients = interaction.radius_scaled($potential, &epsilon);
                $body
            }
        }
    }};
}
pub(crate) use with_coefficients;
