//! How far particles have moved from remembered positions.

use super::state::State;
use nearfield_core::{SimBox, Vec3s};
use rayon::prelude::*;

/// Positions at some earlier time, in today's memory order.
#[derive(Debug, Default)]
pub(super) struct Reference {
    position: Vec3s,
    image: Vec<[i32; 3]>,
}

impl Reference {
    /// Remembers the present.
    pub fn set(&mut self, state: &State) {
        self.position.clone_from(&state.position);
        self.image.clone_from(&state.image);
    }

    /// Squared distance particle `i` has moved, box crossings included.
    #[inline(always)]
    fn moved2(&self, state: &State, sim_box: &SimBox, i: usize) -> f64 {
        let (now, then, lengths) = (state.position.get(i), self.position.get(i), sim_box.lengths());
        (0..3)
            .map(|axis| {
                let crossings = f64::from(state.image[i][axis].wrapping_sub(self.image[i][axis]));
                let d = f64::from(now[axis]) - f64::from(then[axis]) + crossings * f64::from(lengths[axis]);
                d * d
            })
            .sum()
    }

    /// Largest distance moved.
    pub fn largest(&self, state: &State, sim_box: &SimBox) -> f64 {
        let squared = (0..state.len())
            .into_par_iter()
            .with_min_len(4096)
            .map(|i| self.moved2(state, sim_box, i))
            .reduce(|| 0.0, f64::max);
        squared.sqrt()
    }

    /// Mean distance moved over the radius `radius(i)`.
    pub fn mean_over(&self, state: &State, sim_box: &SimBox, radius: impl Fn(usize) -> f32 + Sync) -> f32 {
        let sum: f64 = (0..state.len())
            .into_par_iter()
            .with_min_len(4096)
            .map(|i| self.moved2(state, sim_box, i).sqrt() / f64::from(radius(i)))
            .sum();
        (sum / state.len().max(1) as f64) as f32
    }

    /// Box crossings of each particle since, for image shifts of a stored list.
    pub fn crossings(&self, state: &State, out: &mut Vec<[i8; 3]>) {
        out.clear();
        out.extend(
            state
                .image
                .iter()
                .zip(&self.image)
                .map(|(now, then)| [0, 1, 2].map(|a| now[a].wrapping_sub(then[a]) as i8)),
        );
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        24 * self.image.capacity()
    }
}
