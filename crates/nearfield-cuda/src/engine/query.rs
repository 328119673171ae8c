//! Neighbours of other points among the particles, where these are now.

use super::{list::download, loaded::Loaded, survey::Sample};
use crate::{
    Buffer, DeviceList, Gpu,
    grid::{self, Grid, PointQuery, Survey},
};
use nearfield_core::{ListKind, ListRequest, NeighborList, Particles, Radii, Result, Vec3s};
use nearfield_kernels::Float4;
use std::sync::Arc;

/// Most queries that are looked at to choose cells.
const SAMPLE: usize = 8192;

/// Cells of particles and of queries, and the last answer.
pub(crate) struct Answers {
    points: Grid,
    queries: Grid,
    position: Buffer<Float4>,
    list: DeviceList,
}

impl Answers {
    fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self {
            points: Grid::new(gpu),
            queries: Grid::new(gpu),
            position: Buffer::new(gpu, "queries"),
            list: DeviceList::new(gpu),
        }
    }
}

/// Other points, each with the radius it looks within; inside the box along periodic axes.
pub(crate) struct Queries {
    position: Vec3s,
    radii: Radii,
}

impl Loaded {
    /// Queries that are finite, within walls, wrapped, and do not see a particle twice.
    pub fn queries(&self, points: impl IntoIterator<Item = [f32; 3]>, radii: Radii) -> Result<Queries> {
        let sim_box = &self.physics.sim_box;
        let mut position: Vec3s = points.into_iter().collect();
        Particles::validate_positions(&position, sim_box)?;
        radii.validate(position.len(), sim_box)?;
        for i in 0..position.len() {
            position.set(i, sim_box.wrap(position.get(i)).0);
        }
        Ok(Queries { position, radii })
    }

    /// Particles within the radius of each query, left on the device.
    pub fn list_queries_on_device(&mut self, queries: &Queries, images: bool) -> Result<&DeviceList> {
        // SAFETY: input indices are a permutation of the particles'.
        self.answer(queries, |gpu, query, list| unsafe { grid::list_queries(gpu, query, images, list) })
    }

    /// How many there are, left on the device.
    pub fn count_queries_on_device(&mut self, queries: &Queries) -> Result<&Buffer<u32>> {
        // SAFETY: as above.
        self.answer(queries, |gpu, query, list| unsafe { grid::count_queries(gpu, query, list) })
            .map(|list| &list.count)
    }

    /// Particles within the radius of each query.
    pub fn list_queries(&mut self, queries: &Queries, request: ListRequest) -> Result<NeighborList> {
        let mut particles = Particles::default();
        if request.distances {
            self.state.copy_to(&mut particles)?;
        }
        let sim_box = self.physics.sim_box;
        let list = self.list_queries_on_device(queries, request.shifts || request.distances)?;
        let ends = |row: usize, j: u32| (queries.position.get(row), particles.position.get(j as usize));
        download(list, ListRequest { kind: ListKind::Full, ..request }, &sim_box, ends)
    }

    /// Sorts queries and particles into cells, and answers by those.
    fn answer(
        &mut self,
        queries: &Queries,
        body: impl FnOnce(&dyn Gpu, &PointQuery, &mut DeviceList) -> Result<()>,
    ) -> Result<&DeviceList> {
        let Self { gpu, physics, state, surveyor, answers, .. } = self;
        let Answers { points, queries: order, position, list } = answers.get_or_insert_with(|| Answers::new(gpu));
        let n = queries.position.len();
        let at = |i: usize| {
            let [x, y, z] = queries.position.get(i);
            Float4::new(x, y, z, queries.radii.get(i))
        };
        position.upload(&(0..n).map(at).collect::<Vec<_>>())?;
        let some = n.min(SAMPLE);
        let sample = (0..some).map(|k| at(k * n / some)).collect::<Vec<_>>();
        let largest = if n == 0 { 0.0 } else { queries.radii.largest() };
        let sim_box = &physics.sim_box;
        let cutoff = queries.radii.is_uniform().then_some(largest);
        order.plan(&Survey { n, sample: &sample, sim_box, cutoff, largest });
        let Sample { n: n_points, positions, .. } = surveyor.survey(state)?;
        points.plan(&Survey { n: n_points, sample: &positions, sim_box, cutoff: Some(largest), largest });
        // SAFETY: positions of the queries are n, and those of the state as many as it has.
        unsafe {
            order.build(&**gpu, position.ptr(), n, cutoff.is_none())?;
            points.build(&**gpu, state.moving.position.ptr(), n_points, false)?;
        }
        let query = PointQuery { points, id: state.id.ptr(), queries: order, space: physics.space };
        body(&**gpu, &query, list)?;
        Ok(list)
    }
}
