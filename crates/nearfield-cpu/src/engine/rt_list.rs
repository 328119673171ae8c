//! The neighbour list of `rt-list`: count, scan, fill through the BVH, kept while the Verlet skin lasts, and
//! processed in batches when it would not fit the memory budget.

use super::{motion::Reference, state::State};
use crate::{
    Input, InputRadii, ListBuilder, Rows, Structure,
    kernel::{Finish, RowSource, ScatterSums, gather_rows, scatter},
    physics::Physics,
};
use nearfield_core::{
    ListKind, ListRequest, NeighborList, Plan, Radii, Report,
    skin::{ListUse, SkinTuner},
};
use rayon::prelude::*;

/// Bytes of an entry, index and image, in a task's buffer and in the list.
const BYTES_PER_ENTRY: u64 = 2 * (4 + 3);

/// Nanoseconds of one thread for each particle of a new list, for each of its entries, and for each of them at each step:
/// fitted to the melt with skins of 0.1 to 0.8 (docs/performance-log.md). Only their ratios matter.
const SORTING: f64 = 60.0;
const LISTING: f64 = 4.4;
const READING: f64 = 9.5;

/// A list of everything within range plus skin, and how far particles have moved since.
pub(super) struct StoredList {
    /// Of the list; zero once one has proved too large.
    skin: f32,
    too_large: bool,
    valid: bool,
    list: NeighborList,
    builder: ListBuilder,
    reference: Reference,
    crossings: Vec<[i8; 3]>,
    /// Per-particle radii plus skin; empty when uniform.
    inflated: Vec<f32>,
    /// Evaluations since the list was built.
    age: u64,
    /// Steps that had been taken when the list was built.
    built_at: Option<u64>,
}

/// What a query of the list needs.
pub(super) struct Around<'a> {
    pub state: &'a State,
    pub physics: &'a Physics,
    pub plan: &'a Plan,
    pub structure: &'a dyn Structure,
    pub sums: &'a mut ScatterSums,
    pub skin: &'a mut SkinTuner,
    pub report: &'a mut Report,
}

/// What came of a query.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    Done,
    /// The list is too large to be kept: the structure must be built again, with less skin or none, for the query to be
    /// asked once more.
    NeedsLessSkin,
}

impl StoredList {
    pub fn new() -> Self {
        Self {
            skin: 0.0,
            too_large: false,
            valid: false,
            list: NeighborList {
                kind: ListKind::Full,
                offsets: vec![0],
                indices: vec![],
                shifts: None,
                distances: None,
            },
            builder: ListBuilder::default(),
            reference: Reference::default(),
            crossings: Vec::new(),
            inflated: Vec::new(),
            age: 0,
            built_at: None,
        }
    }

    /// Whether the list still holds every pair: no two particles can have approached by more than the skin.
    pub fn is_fresh(&mut self, state: &State, physics: &Physics) -> bool {
        self.age += 1;
        // The margin covers the rounding of the measured displacement.
        self.valid
            && self.skin > 0.0
            && 2.0 * self.reference.largest(state, &physics.sim_box) <= f64::from(self.skin) * (1.0 - 1e-5)
    }

    /// Has the skin of the next list chosen, after what the last one was good for.
    pub fn choose_skin(&mut self, skin: &mut SkinTuner, state: &State, dt: f32, steps: u64) {
        if self.too_large {
            return;
        }
        if let Some(built) = self.built_at.replace(steps) {
            let entries = self.list.n_entries() as f64;
            skin.record(ListUse {
                steps: (steps - built) as f64,
                sorting: SORTING * state.len() as f64,
                listing: LISTING * entries,
                reading: READING * entries,
            });
        } else if skin.is_auto() {
            skin.guess(dt * state.velocity.largest_norm());
        }
        self.skin = skin.skin();
    }

    /// Forgets the list: particles were reordered or have moved too far.
    pub fn invalidate(&mut self) {
        self.valid = false;
    }

    /// The radii the structure must cover.
    pub fn radii<'a>(&'a mut self, state: &'a State, physics: &Physics) -> InputRadii<'a> {
        if self.skin > 0.0 {
            self.inflated.clear();
            self.inflated.extend(state.radius.iter().map(|r| r + self.skin));
        }
        search_radii(self.skin, &self.inflated, state, physics)
    }

    /// Sums over the rows of the list, building it first when there is none.
    pub fn gather(&mut self, around: Around, finish: Finish) -> Outcome {
        let Around { state, physics, plan, structure, sums, skin, report } = around;
        let input = state.input(physics, state.radii(physics));
        if !self.valid {
            let radii = search_radii(self.skin, &self.inflated, state, physics);
            let search = state.input(physics, radii);
            if let Some(batches) = batches(&self.list, &mut self.builder, structure, &search, plan.memory_budget) {
                if self.skin > 0.0 {
                    self.too_large = !skin.shrink();
                    self.skin = if self.too_large { 0.0 } else { skin.skin() };
                    return Outcome::NeedsLessSkin;
                }
                report.batched_evaluations += 1;
                if structure.complete() {
                    gather_batches(structure, physics, &input, batches, finish);
                } else {
                    // Rows hold each pair on one side only: both sides are summed where the pair is found.
                    sums.reset(state.len());
                    scatter(physics, structure, sums);
                    sums.for_each(finish);
                }
                return Outcome::Done;
            }
            (report.skin, report.list_builds) = (self.skin, report.list_builds + 1);
            if self.age == 1 && self.skin > 0.0 && report.list_builds > 1 {
                report.dangerous_builds += 1;
            }
            self.age = 0;
            self.reference.set(state);
            let request = ListRequest { shifts: physics.sim_box.any_periodic(), ..ListRequest::new(ListKind::Full) };
            self.builder.build(structure, &search, request, &mut self.list);
            self.valid = true;
        }
        self.reference.crossings(state, &mut self.crossings);
        gather_rows(physics, &input, RowSource::List { list: &self.list, crossings: &self.crossings }, finish);
        Outcome::Done
    }

    pub fn bytes(&self) -> usize {
        let shifts = self.list.shifts.as_ref().map_or(0, |shifts| 3 * shifts.capacity());
        8 * self.list.offsets.capacity()
            + 4 * self.list.indices.capacity()
            + shifts
            + self.reference.bytes()
            + 3 * self.crossings.capacity()
            + 4 * self.inflated.capacity()
    }
}

fn search_radii<'a>(skin: f32, inflated: &'a [f32], state: &'a State, physics: &Physics) -> InputRadii<'a> {
    match physics.radii {
        _ if skin == 0.0 => state.radii(physics),
        Radii::Uniform(r) => InputRadii::Uniform(r + skin),
        Radii::PerParticle(_) => InputRadii::PerParticle(inflated),
    }
}

/// How many batches the list must be processed in; `None` when it fits the budget. Counting is left out while the
/// last list had but half of what would fit.
fn batches(
    last: &NeighborList,
    builder: &mut ListBuilder,
    structure: &dyn Structure,
    search: &Input,
    budget: u64,
) -> Option<u64> {
    let fits = |entries: u64| entries.saturating_mul(BYTES_PER_ENTRY) <= budget;
    if !last.indices.is_empty() && fits(2 * last.n_entries() as u64) {
        return None;
    }
    let entries = 2 * builder.count(structure, search, &mut Vec::new());
    (!fits(entries)).then(|| entries * BYTES_PER_ENTRY / budget.max(1) + 1)
}

/// Lists and consumes a batch of groups at a time; all threads' batches together stay within the budget.
fn gather_batches(structure: &dyn Structure, physics: &Physics, input: &Input, batches: u64, finish: Finish) {
    let n_groups = structure.n_groups();
    let batches = batches.saturating_mul(rayon::current_num_threads() as u64).min(n_groups as u64) as usize;
    let size = n_groups.div_ceil(batches.max(1)).max(1);
    let images = physics.sim_box.any_periodic();
    (0..n_groups.div_ceil(size)).into_par_iter().for_each_init(Rows::default, |rows, batch| {
        let groups = batch * size..((batch + 1) * size).min(n_groups);
        rows.list(structure, input, groups, ListKind::Full, images, false);
        gather_rows(physics, input, RowSource::Batch(rows), finish);
    });
}
