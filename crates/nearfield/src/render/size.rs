//! How large particles are drawn.

use glam::Vec3;
use nearfield_core::Vec3s;
use rayon::prelude::*;

/// Particles that are asked for their nearest other.
const ASKED: usize = 256;

/// Half of the median distance from a particle to its nearest other, so that particles in contact look it; of a few
/// particles, evenly chosen. None where there is no distance to speak of.
pub(super) fn typical_radius(position: &Vec3s) -> Option<f32> {
    let n = position.len();
    let asked: Vec<usize> = (0..n.min(ASKED)).map(|k| k * n / n.min(ASKED)).collect();
    let nearest = |&i: &usize| {
        let at = Vec3::from(position.get(i));
        let squares = position.iter().map(|other| at.distance_squared(other.into()));
        squares.filter(|&square| square > 0.0).fold(f32::INFINITY, f32::min)
    };
    let mut nearest: Vec<f32> = asked.par_iter().map(nearest).filter(|square| square.is_finite()).collect();
    nearest.sort_unstable_by(f32::total_cmp);
    nearest.get(nearest.len() / 2).map(|square| 0.5 * square.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particles_of_a_lattice_touch() {
        let position: Vec3s = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|c| 1.5 * c as f32)).collect();
        assert_eq!(typical_radius(&position), Some(0.75));
    }

    #[test]
    fn a_single_place_gives_no_size() {
        assert_eq!(typical_radius(&Vec3s::zeros(1)), None);
        assert_eq!(typical_radius(&Vec3s::zeros(5)), None);
    }
}
