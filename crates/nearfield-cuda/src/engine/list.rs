//! Neighbour lists of the present positions, by a structure of their own, so that asking does not disturb a run.

use super::{loaded::Loaded, order::INTERVAL, structure::Structure};
use crate::{
    Buffer, DeviceList,
    grid::{self, Candidates, ListQuery},
    tracing::{RowNumbers, RowQuery, Scene},
};
use nearfield_core::{
    ListKind, ListRequest, Method, NeighborList, Particles, Plan, Result, SimBox, maintenance::Action, predicate,
};

/// What lists need beside what forces do.
pub(crate) struct Lister {
    structure: Structure,
    list: DeviceList,
    /// Evaluations done when the structure's choices were made.
    planned_at: Option<u64>,
}

impl Loaded {
    /// Neighbours of all particles, by input index, left on the device.
    pub fn list_on_device(&mut self, request: ListRequest) -> Result<&DeviceList> {
        let images = request.shifts || request.distances;
        self.with_lister(|lister, state_id, scene| {
            let Lister { structure, list, .. } = lister;
            let query = list_query(scene, state_id, request.kind, images);
            let rows = RowQuery { kind: request.kind, numbers: RowNumbers::Input(state_id.ptr()) };
            match structure {
                // SAFETY: the arrays of the scene have n elements, its input indices are a permutation of n.
                Structure::Brute => unsafe { grid::list(&**scene.gpu, all(scene), &query, list) },
                // SAFETY: as above.
                Structure::Cells(grid) => unsafe { grid::list(&**scene.gpu, Candidates::Cells(grid), &query, list) },
                Structure::Clusters(_) => unreachable!("listers have cells instead"),
                Structure::Bodies(bvh) | Structure::List(bvh, _) => bvh.list(scene, rows, images, list),
            }
        })?;
        Ok(&self.lister.as_ref().expect("it was just used").list)
    }

    /// Number of neighbours of all particles, by input index, left on the device.
    pub fn count_on_device(&mut self) -> Result<&Buffer<u32>> {
        self.with_lister(|lister, state_id, scene| {
            let Lister { structure, list, .. } = lister;
            let query = list_query(scene, state_id, ListKind::Full, false);
            let rows = RowQuery { kind: ListKind::Full, numbers: RowNumbers::Input(state_id.ptr()) };
            match structure {
                // SAFETY: the arrays of the scene have n elements, its input indices are a permutation of n.
                Structure::Brute => unsafe { grid::count(&**scene.gpu, all(scene), &query, list) },
                // SAFETY: as above.
                Structure::Cells(grid) => unsafe { grid::count(&**scene.gpu, Candidates::Cells(grid), &query, list) },
                Structure::Clusters(_) => unreachable!("listers have cells instead"),
                Structure::Bodies(bvh) | Structure::List(bvh, _) => bvh.count(scene, rows, list),
            }
        })?;
        Ok(&self.lister.as_ref().expect("it was just used").list.count)
    }

    /// See [`nearfield_core::Engine::neighbor_list`].
    pub fn neighbor_list(&mut self, request: ListRequest) -> Result<NeighborList> {
        let mut particles = Particles::default();
        if request.distances {
            self.state.copy_to(&mut particles)?;
        }
        let sim_box = self.physics.sim_box;
        let list = self.list_on_device(request)?;
        let ends = |i: usize, j: u32| (particles.position.get(i), particles.position.get(j as usize));
        download(list, request, &sim_box, ends)
    }

    /// Brings the lister's structure to the present positions and uses it.
    fn with_lister(&mut self, body: impl FnOnce(&mut Lister, &Buffer<u32>, &Scene) -> Result<()>) -> Result<()> {
        let Self { gpu, plan, physics, state, surveyor, lister, report, .. } = self;
        if lister.is_none() {
            // Clusters find lists as cells do.
            let method = if plan.method == Method::Cluster { Method::Cell } else { plan.method };
            let structure = Structure::new(gpu, &Plan { method, ..*plan }, physics)?;
            *lister = Some(Lister { structure, list: DeviceList::new(gpu), planned_at: None });
        }
        let lister = lister.as_mut().expect("it was just made");
        let planned = lister.planned_at.is_some_and(|then| report.evaluations < then + INTERVAL);
        if lister.structure.takes_plans() && !planned {
            lister.structure.plan(&surveyor.survey(state)?, physics);
            lister.planned_at = Some(report.evaluations);
        }
        let scene = physics.scene(state);
        match &mut lister.structure {
            // Without the skin that forces would want.
            Structure::Bodies(bvh) | Structure::List(bvh, _) => bvh.update(Action::Build, &scene).map(drop)?,
            structure => structure.update_in_place(Action::Build, &scene).map(drop)?,
        }
        body(lister, &state.id, &scene)
    }
}

/// Copies a list to the host; `ends` gives the positions of a row and of a neighbour in it.
pub(super) fn download(
    list: &DeviceList,
    request: ListRequest,
    sim_box: &SimBox,
    ends: impl Fn(usize, u32) -> ([f32; 3], [f32; 3]),
) -> Result<NeighborList> {
    let (offsets, mut indices, mut images) = (list.offset.download()?, list.index.download()?, list.image.download()?);
    if request.sorted {
        sort_rows(&offsets, &mut indices, &mut images);
    }
    let shifts: Vec<[i8; 3]> = images.iter().map(|&code| image_of(code)).collect();
    let row_range = |i: usize| offsets[i] as usize..offsets[i + 1] as usize;
    // By the one definition, on the host: the same bits as everywhere.
    let distance = |i: usize, entry: usize| {
        let (xi, xj) = ends(i, indices[entry]);
        predicate::squared_length(predicate::displacement(xi, xj, sim_box.shift(shifts[entry]))).sqrt()
    };
    let entries = || (0..offsets.len() - 1).flat_map(|i| row_range(i).map(move |entry| (i, entry)));
    let distances = request.distances.then(|| entries().map(|(i, entry)| distance(i, entry)).collect());
    Ok(NeighborList { kind: request.kind, offsets, indices, shifts: request.shifts.then_some(shifts), distances })
}

fn all<'a>(scene: &Scene) -> Candidates<'a> {
    Candidates::All { position: scene.particles.position, n: scene.particles.n as usize }
}

fn list_query(scene: &Scene, id: &Buffer<u32>, kind: ListKind, images: bool) -> ListQuery {
    ListQuery { law: scene.law, space: scene.space, id: id.ptr(), kind, images }
}

/// Sorts each row by neighbour, then image.
fn sort_rows(offsets: &[u64], indices: &mut [u32], images: &mut [u8]) {
    let mut row = Vec::new();
    for ends in offsets.windows(2) {
        let range = ends[0] as usize..ends[1] as usize;
        if images.is_empty() {
            indices[range].sort_unstable();
            continue;
        }
        row.clear();
        row.extend(range.clone().map(|entry| (indices[entry], images[entry])));
        row.sort_unstable();
        for (entry, &(index, image)) in range.zip(&row) {
            (indices[entry], images[entry]) = (index, image);
        }
    }
}

/// Box lengths to the image of a code (see [`DeviceList::image`]).
fn image_of(code: u8) -> [i8; 3] {
    let code = code as i8;
    [code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1]
}
