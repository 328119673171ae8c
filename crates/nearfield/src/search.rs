//! Neighbour search for programs: points in, pairs out.

use crate::Result;
use nearfield_core::{ListRequest, NeighborList, Particles, Radii, SimBox, Vec3s};
pub use nearfield_cpu::{Counts as Neighbors, Pair};
use nearfield_cpu::{Grid, Input, InputRadii, bipartite_list, count_neighbors, for_each_pair, neighbor_list};
use std::ops::ControlFlow;

/// Points indexed for fixed-radius queries, on the CPU's cell grid.
///
/// The range of a pair is the cutoff, or max(r_i, r_j) where points have radii. Coincident points are neighbours, a
/// point is never its own. Points are wrapped into the box on periodic axes.
///
/// ```
/// use nearfield::{Boundary, NeighborSearch, SimBox};
/// use std::ops::ControlFlow;
/// let sim_box = SimBox::cubic(10.0, Boundary::Periodic)?;
/// let search = NeighborSearch::new(sim_box, [[0.5; 3], [9.5; 3], [5.0; 3]], 2.0)?;
/// assert_eq!(search.counts().neighbors, [1, 1, 0]);
///
/// // Visit pairs without storing them, and stop at the first.
/// let first = search.for_each_pair(|pair| ControlFlow::Break((pair.i, pair.j, pair.image)));
/// assert_eq!(first, ControlFlow::Break((0, 1, [-1, -1, -1])));
/// # Ok::<(), nearfield::Error>(())
/// ```
#[derive(Debug)]
pub struct NeighborSearch {
    sim_box: SimBox,
    position: Vec3s,
    radii: Radii,
    grid: Grid,
}

impl NeighborSearch {
    /// Indexes points with one cutoff for all pairs, \[length\].
    ///
    /// # Errors
    /// [`nearfield_core::Error`]: a coordinate that is not finite or outside walls (named by the point's index), a
    /// cutoff that is not positive or beyond half a periodic length.
    pub fn new(sim_box: SimBox, points: impl IntoIterator<Item = [f32; 3]>, cutoff: f32) -> Result<Self> {
        Self::with_radii(sim_box, points, Radii::Uniform(cutoff))
    }

    /// Indexes points with one cutoff or a radius each.
    ///
    /// # Errors
    /// As [`NeighborSearch::new`], naming the point whose radius is wrong.
    pub fn with_radii(sim_box: SimBox, points: impl IntoIterator<Item = [f32; 3]>, radii: Radii) -> Result<Self> {
        let position = checked(&sim_box, points)?;
        radii.validate(position.len(), &sim_box)?;
        let mut search = Self { sim_box, position, radii, grid: Grid::new() };
        let mut grid = std::mem::take(&mut search.grid);
        grid.build(&search.input());
        search.grid = grid;
        Ok(search)
    }

    /// Number of points.
    pub fn n_points(&self) -> usize {
        self.position.len()
    }

    fn input(&self) -> Input<'_> {
        input(&self.sim_box, &self.position, &self.radii)
    }

    /// The neighbour list.
    pub fn neighbor_list(&self, request: ListRequest) -> NeighborList {
        neighbor_list(&self.grid, &self.input(), request)
    }

    /// The number of neighbours of each point, and of pairs; nothing else is stored.
    pub fn counts(&self) -> Neighbors {
        count_neighbors(&self.grid, &self.input())
    }

    /// Calls `visit` once for each pair, on this thread and in no particular order, until it breaks.
    pub fn for_each_pair<B>(&self, visit: impl FnMut(Pair) -> ControlFlow<B>) -> ControlFlow<B> {
        for_each_pair(&self.grid, &self.input(), visit)
    }

    /// For each of other points, the indexed points within `radii` of it: a full list with a row per query. The radii
    /// of the indexed points mean nothing here.
    ///
    /// ```
    /// use nearfield::{Boundary, ListKind, ListRequest, NeighborSearch, Radii, SimBox};
    /// let sim_box = SimBox::cubic(10.0, Boundary::Open)?;
    /// let search = NeighborSearch::new(sim_box, [[1.0; 3], [2.0; 3], [9.0; 3]], 1.0)?;
    /// let near = search.query([[1.5; 3]], Radii::Uniform(1.0), ListRequest::new(ListKind::Full))?;
    /// assert_eq!(near.n_entries(), 2);
    /// # Ok::<(), nearfield::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`NeighborSearch::with_radii`], naming the query.
    pub fn query(
        &self,
        points: impl IntoIterator<Item = [f32; 3]>,
        radii: Radii,
        request: ListRequest,
    ) -> Result<NeighborList> {
        let position = checked(&self.sim_box, points)?;
        radii.validate(position.len(), &self.sim_box)?;
        Ok(bipartite_list(&self.grid, &input(&self.sim_box, &position, &radii), request))
    }
}

fn input<'a>(sim_box: &'a SimBox, position: &'a Vec3s, radii: &'a Radii) -> Input<'a> {
    let radii = match radii {
        Radii::Uniform(r) => InputRadii::Uniform(*r),
        Radii::PerParticle(radii) => InputRadii::PerParticle(radii),
    };
    Input { sim_box, position: position.axes().map(Vec::as_slice), radii, kind: &[] }
}

/// Points that are finite and within walls, wrapped.
fn checked(sim_box: &SimBox, points: impl IntoIterator<Item = [f32; 3]>) -> Result<Vec3s> {
    let mut position: Vec3s = points.into_iter().collect();
    Particles::validate_positions(&position, sim_box)?;
    for i in 0..position.len() {
        position.set(i, sim_box.wrap(position.get(i)).0);
    }
    Ok(position)
}
