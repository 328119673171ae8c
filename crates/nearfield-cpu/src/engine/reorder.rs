//! Memory order: particles that are near in space are kept near in memory.

use super::state::State;
use crate::{Grid, Structure, bvh::CurveOrder, physics::Physics};
use nearfield_core::Order;
use rayon::prelude::*;

/// Steps between reorderings: sorting costs a few evaluations' time, and locality decays slowly.
pub(super) const INTERVAL: u64 = 100;

/// The permutation that puts particle `order[k]` at place k; `None` when the order is to stay.
pub(super) fn order(order: Order, state: &State, physics: &Physics) -> Option<Vec<u32>> {
    let input = state.input(physics, state.radii(physics));
    match order {
        Order::None => None,
        Order::Morton => Some(CurveOrder::default().sort(&input).collect()),
        Order::Cell => {
            let mut grid = Grid::default();
            grid.build(&input);
            Some(grid.slots().particle.iter().copied().filter(|&p| p != u32::MAX).collect())
        }
    }
}
