//! The number that a particle is coloured by, and the range of numbers that the colours span.

use super::ColorBy;
use crate::{NeighborSearch, Result};
use nearfield_core::{Engine, Method, PerParticle, Plan, Quantities, Radii, Skin, System};
use nearfield_cpu::CpuEngine;

/// Part of the particles that may lie outside the colours' range, on each side.
const OUTLIERS: f64 = 0.005;

/// The numbers, `[N]`; none for types.
///
/// # Errors
/// What the engine or the search gives.
pub(super) fn of(system: &System, by: ColorBy) -> Result<Option<Vec<f64>>> {
    Ok(match by {
        ColorBy::Type => None,
        ColorBy::Speed => {
            let speed = |v: [f32; 3]| v.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>().sqrt();
            Some(system.particles.velocity.iter().map(speed).collect())
        }
        ColorBy::Energy => {
            let mut engine = CpuEngine::new();
            engine.load(system, &Plan { skin: Skin::NONE, ..Plan::new(Method::Cell) })?;
            engine.evaluate(Quantities::ALL)?;
            let mut results = PerParticle::default();
            engine.per_particle(&mut results)?;
            Some(results.energy)
        }
        ColorBy::Neighbors => {
            let positions = system.particles.position.iter();
            let search = NeighborSearch::with_radii(system.sim_box, positions, system.radii.clone())?;
            Some(search.counts().neighbors.into_iter().map(f64::from).collect())
        }
    })
}

/// The range of the numbers but for a few outliers; of positive width, at least 1 for counts.
pub(super) fn range(values: &[f64], by: ColorBy) -> [f64; 2] {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return [0.0, 1.0] };
    let outliers = (OUTLIERS * last as f64) as usize;
    let (lo, hi) = (sorted[outliers], sorted[last - outliers]);
    let margin = if by == ColorBy::Neighbors { 1.0 } else { 1e-3 * lo.abs().max(hi.abs()).max(1e-3) };
    if hi - lo > 1e-6 * margin { [lo, hi] } else { [lo - margin, hi + margin] }
}

/// What a legend calls the numbers. No unit system is imposed, so units are dimensions.
pub(super) fn title(by: ColorBy, radii: &Radii) -> String {
    match (by, radii) {
        (ColorBy::Type, _) => "type".into(),
        (ColorBy::Speed, _) => "speed [length/time]".into(),
        (ColorBy::Energy, _) => "potential energy [energy]".into(),
        (ColorBy::Neighbors, Radii::Uniform(cutoff)) => format!("neighbours within {cutoff}"),
        (ColorBy::Neighbors, Radii::PerParticle(_)) => "neighbours".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_outliers_do_not_stretch_the_range() {
        let mut values: Vec<f64> = (0..=1000).map(f64::from).collect();
        values[0] = -1e9;
        values.push(f64::NAN);
        assert_eq!(range(&values, ColorBy::Speed), [5.0, 995.0]);
        assert_eq!(range(&[3.0, 4.0], ColorBy::Neighbors), [3.0, 4.0]);
    }

    #[test]
    fn the_range_of_equal_numbers_has_a_width() {
        for values in [vec![], vec![0.0; 3], vec![7.0], vec![-1e9; 2]] {
            let [lo, hi] = range(&values, ColorBy::Energy);
            assert!(lo < hi, "{values:?}");
        }
        assert_eq!(range(&[12.0; 3], ColorBy::Neighbors), [11.0, 13.0]);
    }
}
