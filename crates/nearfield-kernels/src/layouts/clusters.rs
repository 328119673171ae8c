//! Lists of what is near clusters of consecutive particles, and steps by them.

use super::{
    grid::{GatherArgs, Grid, SortArgs},
    particles::{Integrator, Particles, Status},
    physics::{Box3, Law},
};
use crate::layout::{Float4, Ptr, layouts};

layouts! {
    /// Consecutive chunks of 32 entries of a cluster's list.
    pub struct Segment {
        /// First chunk.
        pub begin: u32,
        /// The chunk after the last.
        pub end: u32,
        /// The segment where the list goes on; all ones where it ends.
        pub next: u32,
        /// 1 where each pair needs an image of its own, 0 where one serves a candidate and the whole cluster.
        pub by_pair: u32,
    }

    /// What kernels tell each other and the host about a list.
    pub struct ClusterControl {
        /// The first step whose positions the list may not serve; all ones while none is known, zero where there was no
        /// room for the list.
        pub rebuild_at: u64,
        /// The step that the present launches of steps begin with.
        pub first: u64,
        /// The step that the positions belong to, which is to be computed next.
        pub next: u64,
        /// The first step that is not to be computed.
        pub end: u64,
        /// Chunks of all lists.
        pub chunks: u32,
        /// Segments beyond the first of each cluster.
        pub segments: u32,
        /// Lists made since `begin_steps` after others that had served.
        pub lists: u32,
        /// Most steps that one of those others has served for since then.
        pub longest: u32,
        /// How many of them did not serve for a second step.
        pub dangerous: u32,
        /// Zero.
        pub unused: u32,
    }

    /// Arguments of `begin_steps` and `begin_list`.
    pub struct ClusterControlArgs {
        /// The list.
        pub control: Ptr<ClusterControl>,
        /// The step that the positions belong to.
        pub step: u64,
        /// The first step that is not to be computed.
        pub end: u64,
    }

    /// Arguments of `sort_particles`.
    pub struct SortParticlesArgs {
        /// The sort, counted and scanned.
        pub sort: SortArgs,
        /// The particles.
        pub from: Particles,
        /// The particles in the order of the cells.
        pub to: Particles,
        /// Place of each input index.
        pub place: Ptr<u32>,
        /// The list there has been; there is none then.
        pub control: Ptr<ClusterControl>,
    }

    /// Arguments of `list_clusters` and `list_sparse`.
    pub struct ClusterListArgs {
        /// The interaction, its cutoff longer by the skin.
        pub law: Law,
        /// The box.
        pub space: Box3,
        /// Cells of particles in memory order.
        pub grid: Grid,
        /// One for each cluster, then those that follow, `[segment_capacity]`.
        pub segment: Ptr<Segment>,
        /// Entries, `[capacity][32]`.
        pub entry: Ptr<u32>,
        /// Chunks and segments are counted from zero, beyond what there is room for.
        pub control: Ptr<ClusterControl>,
        /// Number of particles.
        pub n: u32,
        /// Number of clusters.
        pub n_clusters: u32,
        /// Chunks that there is room for.
        pub capacity: u32,
        /// Segments that there is room for.
        pub segment_capacity: u32,
        /// Added to ranges so that roundings lose no candidate.
        pub slack: f32,
        /// How near a periodic face a particle may cross it while the list serves.
        pub margin: f32,
        /// 1 where pairs are listed once: by the cluster whose slots come first, those within a cluster from both sides.
        pub once: u32,
        /// Zero.
        pub unused: u32,
    }

    /// Arguments of `listed_*` and `pairs_*`: forces of all particles.
    pub struct ListedArgs {
        /// As for all kernels that gather forces, of particles in memory order.
        pub gather: GatherArgs,
        /// See [`ClusterListArgs`].
        pub segment: Ptr<Segment>,
        /// See [`ClusterListArgs`].
        pub entry: Ptr<u32>,
        /// Nothing is done unless the list serves; null where that is known.
        pub control: Ptr<ClusterControl>,
        /// The step that the forces belong to, from [`ClusterControl::first`] on.
        pub index: u32,
        /// Clusters that a warp of `pairs_*` takes, one after another.
        pub clusters_per_warp: u32,
    }

    /// Arguments of `step_*` and `move_listed`: a step of all particles by forces that are computed or read.
    pub struct ClusterStepArgs {
        /// Where forces come from. In `step_*` results are not stored, in `move_listed` they are zeroed once read.
        pub listed: ListedArgs,
        /// How particles move.
        pub integrator: Integrator,
        /// The particles.
        pub particles: Particles,
        /// Where positions go: in `step_*` not to where they are.
        pub next: Ptr<Float4>,
        /// Positions that the list was made for.
        pub reference: Ptr<Float4>,
        /// What went wrong.
        pub status: Ptr<Status>,
        /// Square of the distance that particles may move while the list serves.
        pub limit2: f32,
        /// Zero.
        pub unused: u32,
    }

    /// Arguments of `clusters_moved`: whether a list serves the present positions.
    pub struct ClustersMovedArgs {
        /// The box.
        pub space: Box3,
        /// Positions.
        pub position: Ptr<Float4>,
        /// Positions that the list was made for.
        pub reference: Ptr<Float4>,
        /// `rebuild_at` becomes zero where the list does not serve.
        pub control: Ptr<ClusterControl>,
        /// Number of particles.
        pub n: u32,
        /// Square of the distance that particles may move.
        pub limit2: f32,
    }
}
