//! The neighbour list of `rt-list`: count, scan, fill through the BVH, kept while the Verlet skin lasts, and
//! processed in batches when it would not fit the memory budget.

use super::{motion::Reference, state::State};
use crate::{
    InputRadii, Structure,
    kernel::{Finish, Rows, gather_rows},
    list,
    physics::Physics,
};
use nearfield_core::{ListKind, ListRequest, NeighborList, Plan, Radii, Report};

/// A list of everything within range plus skin, and how far particles have moved since.
pub(super) struct StoredList {
    /// Skin, at most what keeps range plus skin within half a periodic length.
    skin: f32,
    list: Option<NeighborList>,
    reference: Reference,
    crossings: Vec<[i8; 3]>,
    inflated: Vec<f32>,
    /// Evaluations since the list was built.
    age: u64,
}

impl StoredList {
    pub fn new(plan: &Plan, physics: &Physics, radii: &Radii) -> Self {
        let lengths = physics.sim_box.lengths();
        let room = (0..3)
            .filter(|&axis| physics.sim_box.is_periodic(axis))
            .map(|axis| 0.5 * lengths[axis] - radii.largest())
            .fold(f32::INFINITY, f32::min);
        let skin = if plan.method.uses_list() { plan.skin.min(room).max(0.0) } else { 0.0 };
        Self {
            skin,
            list: None,
            reference: Reference::default(),
            crossings: Vec::new(),
            inflated: Vec::new(),
            age: 0,
        }
    }

    /// Whether the list still holds every pair: no two particles can have approached by more than the skin.
    pub fn is_fresh(&mut self, state: &State, physics: &Physics) -> bool {
        self.age += 1;
        // The margin covers the rounding of the measured displacement.
        self.skin > 0.0
            && self.list.is_some()
            && 2.0 * self.reference.largest(state, &physics.sim_box) <= f64::from(self.skin) * (1.0 - 1e-5)
    }

    /// Forgets the list: particles were reordered or have moved too far.
    pub fn invalidate(&mut self) {
        self.list = None;
    }

    /// The radii the structure must cover.
    pub fn inflated_radii<'a>(&'a mut self, state: &'a State, physics: &Physics) -> InputRadii<'a> {
        if self.skin == 0.0 {
            return state.radii(physics);
        }
        match physics.radii {
            Radii::Uniform(r) => InputRadii::Uniform(r + self.skin),
            Radii::PerParticle(_) => {
                self.inflated.clear();
                self.inflated.extend(state.radius.iter().map(|r| r + self.skin));
                InputRadii::PerParticle(&self.inflated)
            }
        }
    }

    /// Sums over the rows of the list, building it first when there is none.
    pub fn gather(
        &mut self,
        structure: &dyn Structure,
        state: &State,
        physics: &Physics,
        plan: &Plan,
        report: &mut Report,
        finish: Finish,
    ) {
        let periodic = physics.sim_box.any_periodic();
        let input = state.input(physics, state.radii(physics));
        if self.list.is_none() {
            report.list_builds += 1;
            if self.age == 1 && self.skin > 0.0 && report.list_builds > 1 {
                report.dangerous_builds += 1;
            }
            self.age = 0;
            self.reference.set(state);
            let search = state.input(physics, self.inflated_radii(state, physics));
            let request = ListRequest { shifts: periodic, ..ListRequest::new(ListKind::Full) };
            match list::within_budget(structure, &search, request, plan.memory_budget) {
                list::Budgeted::Whole(list) => self.list = Some(list),
                list::Budgeted::Batches(batches) => {
                    report.batched_evaluations += 1;
                    batches.for_each(|batch| {
                        let rows = Rows {
                            particles: Some(&batch.particles),
                            offsets: &batch.offsets,
                            indices: &batch.indices,
                            images: &batch.images,
                            crossings: &[],
                        };
                        gather_rows(physics, &input, rows, finish);
                    });
                    return;
                }
            }
        }
        if let Some(list) = &self.list {
            self.crossings.clear();
            if periodic {
                self.reference.crossings(state, &mut self.crossings);
            }
            let rows = Rows {
                particles: None,
                offsets: &list.offsets,
                indices: &list.indices,
                images: list.shifts.as_deref().unwrap_or(&[]),
                crossings: &self.crossings,
            };
            gather_rows(physics, &input, rows, finish);
        }
    }

    pub fn bytes(&self) -> usize {
        let list = self.list.as_ref().map_or(0, |list| {
            8 * list.offsets.capacity() + 4 * list.indices.capacity() + list.shifts.as_ref().map_or(0, |s| 3 * s.capacity())
        });
        list + self.reference.bytes() + 3 * self.crossings.capacity() + 4 * self.inflated.capacity()
    }
}
