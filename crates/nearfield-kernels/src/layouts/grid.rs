//! Cells and the kernels that scan them.

use super::{
    particles::{Integrator, Particles, Status},
    physics::{Box3, Law, Results},
};
use crate::layout::{Float4, Ptr, layouts};

layouts! {
    /// The cells of one class of radii: rows of `n[0]` cells along x, `n[1]` rows to a plane, `n[2]` planes. Rows run
    /// backwards in odd rows and planes (snake order), so that consecutive particles are near each other.
    pub struct CellClass {
        /// Where cells begin; the outermost extend to infinity.
        pub lo: [f32; 3],
        /// Cells per length.
        pub per_length: [f32; 3],
        /// Lengths of a cell.
        pub width: [f32; 3],
        /// Cells along each axis.
        pub n: [u32; 3],
        /// Zero.
        pub unused: u32,
        /// Index of the first cell among those of all classes.
        pub first_cell: u32,
        /// Upper limit of the radii of the class; infinite for the last.
        pub limit: f32,
        /// Largest radius of the class now, the cutoff where there is one for all.
        pub largest: f32,
    }

    /// All classes, by ascending radius.
    pub struct Grid {
        /// The classes.
        pub classes: [CellClass; 8],
        /// How many there are.
        pub n_classes: u32,
        /// Cells of all classes.
        pub n_cells: u32,
        /// First slot of each cell, `[n_cells + 1]`.
        pub cell_start: Ptr<u32>,
        /// Particles in cell order: position, and radius in w.
        pub slot: Ptr<Float4>,
        /// Place of each slot's particle; null where slots are places.
        pub particle: Ptr<u32>,
    }

    /// Arguments of `cell_count` and `cell_scatter`.
    pub struct SortArgs {
        /// Cells to sort into.
        pub grid: Grid,
        /// Particles in each cell: counted from zero, and zero again once all have their slots.
        pub count: Ptr<u32>,
        /// State of the scan between the two, zeroed by the count, `[n_tiles]`.
        pub tiles: Ptr<u64>,
        /// Positions, with radii in w where `variable`.
        pub position: Ptr<Float4>,
        /// Cell of each particle, written by the count.
        pub cell: Ptr<u32>,
        /// Its number within the cell.
        pub rank: Ptr<u32>,
        /// Number of particles.
        pub n: u32,
        /// 1 where radii are per particle.
        pub variable: u32,
        /// Length of that state.
        pub n_tiles: u32,
        /// Zero.
        pub unused: u32,
    }

    /// Arguments of `scan_u32` and `scan_u64`: exclusive prefix sums in one pass with look-back.
    pub struct ScanArgs {
        /// Counts, `[n]` of u32.
        pub input: Ptr<u32>,
        /// Sums, `[n + 1]` of u32 or u64.
        pub output: Ptr<u8>,
        /// State of each tile, zeroed, `[tiles + 1]`; the last is the ticket counter.
        pub tiles: Ptr<u64>,
        /// Number of counts.
        pub n: u32,
        /// Zero.
        pub unused: u32,
    }

    /// Arguments of `brute_*` and `cell_*`: forces of all particles.
    pub struct GatherArgs {
        /// The interaction.
        pub law: Law,
        /// The box.
        pub space: Box3,
        /// The cells; only `slot` and `particle` for `brute`.
        pub grid: Grid,
        /// Velocities, for types in w.
        pub velocity: Ptr<Float4>,
        /// Where results go.
        pub results: Results,
        /// Number of particles.
        pub n: u32,
        /// Added to ranges so that roundings lose no candidate.
        pub slack: f32,
    }

    /// Arguments of `cell_step_*`: forces, and with them a step of all particles.
    pub struct CellStepArgs {
        /// Where forces come from; results are not stored.
        pub gather: GatherArgs,
        /// How particles move.
        pub integrator: Integrator,
        /// The particles, at the positions that were sorted.
        pub particles: Particles,
        /// What went wrong.
        pub status: Ptr<Status>,
        /// The step that the present launches begin with.
        pub first: Ptr<u64>,
        /// The step that the forces belong to, from that on.
        pub index: u32,
        /// Zero.
        pub unused: u32,
    }

    /// Arguments of `begin_cell_steps`.
    pub struct FirstStepArgs {
        /// Where [`CellStepArgs`] find it.
        pub first: Ptr<u64>,
        /// The step.
        pub step: u64,
    }

    /// Arguments of `number_slots`.
    pub struct NumberArgs {
        /// Place of each slot's particle.
        pub particle: Ptr<u32>,
        /// Input index of each place.
        pub id: Ptr<u32>,
        /// Input index of each slot's particle.
        pub number: Ptr<u32>,
        /// Number of particles.
        pub n: u32,
        /// Zero.
        pub unused: u32,
    }

    /// Arguments of the kernels that list neighbours.
    pub struct ListArgs {
        /// The interaction, for ranges.
        pub law: Law,
        /// The box.
        pub space: Box3,
        /// The cells; only `slot` and `particle` for `brute`.
        pub grid: Grid,
        /// Input index of each slot's particle.
        pub id: Ptr<u32>,
        /// Entries of each row, by input index; counted, or counted down while rows are filled.
        pub count: Ptr<u32>,
        /// Row starts, `[n + 1]`.
        pub offset: Ptr<u64>,
        /// Neighbours, by input index.
        pub index: Ptr<u32>,
        /// Periodic image of each neighbour.
        pub image: Ptr<u8>,
        /// Number of particles.
        pub n: u32,
        /// 1 for half lists: only neighbours of larger input index.
        pub half: u32,
        /// Added to ranges so that roundings lose no candidate.
        pub slack: f32,
        /// Zero.
        pub unused: u32,
    }

    /// What is known of rows that were listed before their places were.
    pub struct StagingControl {
        /// Entries of all rows.
        pub entries: u64,
        /// 1 where a row or all of them had too little room.
        pub overflow: u32,
        /// Zero.
        pub unused: u32,
    }

    /// Arguments of `cell_list_stage`: rows wherever there is room.
    pub struct StageArgs {
        /// What is listed; rows are counted too.
        pub list: ListArgs,
        /// Neighbours, by input index, those of a row together.
        pub staged: Ptr<u32>,
        /// Where each row begins there, by input index.
        pub start: Ptr<u64>,
        /// Zeroed before.
        pub control: Ptr<StagingControl>,
        /// Entries that there is room for.
        pub capacity: u64,
    }

    /// Arguments of `copy_rows`: rows to their places.
    pub struct CopyRowsArgs {
        /// Row starts, `[n + 1]`.
        pub offset: Ptr<u64>,
        /// See [`StageArgs`].
        pub start: Ptr<u64>,
        /// See [`StageArgs`].
        pub staged: Ptr<u32>,
        /// Neighbours, by input index.
        pub index: Ptr<u32>,
        /// See [`StageArgs`].
        pub control: Ptr<StagingControl>,
        /// Neighbours that there is room for: where there are more, nothing is copied.
        pub room: u64,
        /// Number of rows.
        pub n: u32,
        /// Zero.
        pub unused: u32,
    }

    /// Arguments of `query_*`: lists of queries among points of another set.
    pub struct QueryArgs {
        /// The points, in cells of one class, with rows by query; [`ListArgs::n`] is the number of queries. Radii are per
        /// query, whatever the law says.
        pub list: ListArgs,
        /// Queries in an order that keeps near ones together, with radii in w.
        pub query: Ptr<Float4>,
        /// Row of each of these.
        pub row: Ptr<u32>,
    }
}
