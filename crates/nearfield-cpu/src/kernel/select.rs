//! From a system's interaction to a monomorphic pair law and its coefficients.

use nearfield_core::{
    interaction::{PairLaw, Truncated},
    potentials::{Gaussian, LennardJones, Morse, Table, Wca, Yukawa},
};
use std::sync::Arc;

/// A pair law, and whether it is worth a kernel of its own for each way of summing.
pub(super) trait Law: PairLaw {
    /// Lennard-Jones: its arithmetic is so little that everything else shows.
    const FAST: bool = false;
}

impl<const FORCE_SHIFT: bool> Law for Truncated<'_, LennardJones, FORCE_SHIFT> {
    const FAST: bool = true;
}
impl Law for Truncated<'_, Wca, true> {}
impl Law for Truncated<'_, Yukawa, true> {}
impl Law for Truncated<'_, Morse, true> {}
impl Law for Truncated<'_, Gaussian, true> {}
impl Law for Truncated<'_, Arc<Table>, true> {}

/// Runs `$body` with the system's law and coefficients.
macro_rules! with_law {
    ($system:expr, $law:ident, $coefficients:ident => $body:expr) => {{
        use nearfield_core::{Radii, Truncation, interaction::Truncated, potentials::Potential, with_potential};
        let interaction = &$system.interaction;
        match (&interaction.potential, &$system.radii) {
            (Potential::LennardJones(p), Radii::Uniform(r)) if interaction.truncation != Truncation::Force => {
                let $law = &Truncated::<_, false>(p);
                if interaction.types.len() == 1 {
                    let $coefficients = &interaction.single(*r);
                    $body
                } else {
                    let $coefficients = &interaction.typed(*r);
                    $body
                }
            }
            (Potential::LennardJones(p), Radii::PerParticle(_)) if interaction.truncation != Truncation::Force => {
                let $law = &Truncated::<_, false>(p);
                let $coefficients = &interaction.radius_scaled(p);
                $body
            }
            (potential, radii) => with_potential!(potential, p => {
                let $law = &Truncated::<_, true>(p);
                match radii {
                    Radii::Uniform(r) => {
                        let $coefficients = &interaction.typed(*r);
                        $body
                    }
                    Radii::PerParticle(_) => {
                        let $coefficients = &interaction.radius_scaled(p);
                        $body
                    }
                }
            }),
        }
    }};
}
pub(super) use with_law;
