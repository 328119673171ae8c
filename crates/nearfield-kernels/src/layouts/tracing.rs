//! Rays from particles through boxes around particles.

use super::{
    particles::{Integrator, Particles, Status},
    physics::{Box3, Law, Results},
};
use crate::layout::{Float4, Ptr, layouts};

layouts! {
    /// A mirror particle: a box around a periodic image.
    pub struct Ghost {
        /// Place of the particle.
        pub particle: u32,
        /// Periodic image.
        pub image: u32,
    }

    /// Arguments of `fit_boxes`, `count_ghosts` and `make_ghosts`.
    pub struct BoxesArgs {
        /// The box.
        pub space: Box3,
        /// Positions, with radii in w where they are per particle.
        pub position: Ptr<Float4>,
        /// Low and high corner of a box around each particle, then of each ghost, `[n + n_ghosts][6]`.
        pub boxes: Ptr<f32>,
        /// Mirror particles, `[n_ghosts]`.
        pub ghost: Ptr<Ghost>,
        /// Faces for which each particle has ghosts, `[n]`: bit `2 axis` the lower, bit `2 axis + 1` the upper one.
        /// Null where there are no ghosts.
        pub faces: Ptr<u8>,
        /// Number of ghosts, counted or made; for `fit_boxes` set to 1 where a particle needs one that it lacks.
        pub counter: Ptr<u32>,
        /// Number of particles.
        pub n: u32,
        /// Number of ghosts.
        pub n_ghosts: u32,
        /// The one cutoff; zero where radii are per particle.
        pub cutoff: f32,
        /// Added to radii.
        pub skin: f32,
        /// What roundings of coordinates may amount to.
        pub slack: f32,
        /// How far particles may move before they lack ghosts.
        pub margin: f32,
    }

    /// Spheres or squares around particles and the rays that meet them (paper B), whose origins are not their
    /// particles. Zero where bodies are boxes.
    pub struct Geometry {
        /// Least coordinates that bodies and rays are given, whatever those of particles.
        pub lo: [f32; 3],
        /// Greatest coordinates.
        pub hi: [f32; 3],
        /// Radius of spheres; half the side of squares.
        pub body: f32,
        /// Distance of squares from their particle along x, and of rays from theirs along y and z.
        pub offset: f32,
        /// How far beyond their diagonal the triangles of a square reach.
        pub overlap: f32,
        /// From the particle to the beginning of its rays, along them.
        pub start: f32,
        /// Length of rays.
        pub length: f32,
        /// Zero.
        pub unused: u32,
    }

    /// Arguments of `fit_spheres` and `fit_squares`.
    pub struct BodiesArgs {
        /// As for boxes, of which there are none.
        pub boxes: BoxesArgs,
        /// Sizes and places.
        pub geometry: Geometry,
        /// Centres of spheres around each particle, then each ghost, `[n + n_ghosts]`.
        pub centers: Ptr<Float4>,
        /// Vertices of the triangles of squares, `[n + n_ghosts][2][2][3][3]`: by square, triangle, vertex and axis.
        pub vertices: Ptr<f32>,
    }

    /// What rays need to know.
    pub struct Rays {
        /// The interaction.
        pub law: Law,
        /// The box.
        pub space: Box3,
        /// The particles, each with a ray from its position and a box around it, or what `geometry` says.
        pub particles: Particles,
        /// Bodies other than boxes.
        pub geometry: Geometry,
        /// What rays are traced against.
        pub handle: u64,
        /// Mirror particles, whose bodies follow those of the particles.
        pub ghost: Ptr<Ghost>,
        /// How rays see periodic images: 0 by gamma rays, 1 in instances, 2 as ghosts.
        pub view: u32,
        /// Number of images.
        pub n_images: u32,
        /// The images, in order of instances; the box itself comes first.
        pub image: [u8; 32],
        /// Particles at or below this need gamma rays to image -1.
        pub near_lo: [f32; 3],
        /// Particles at or above this need gamma rays to image +1.
        pub near_hi: [f32; 3],
        /// Added to ranges.
        pub skin: f32,
        /// Place of the particle of the first ray.
        pub first: u32,
    }

    /// Parameters of the programs in `ray_gather`, `axis_gather`, `edge_gather` and `ray_scatter`.
    pub struct ForceRays {
        /// The rays.
        pub rays: Rays,
        /// Where forces go.
        pub results: Results,
    }

    /// Parameters of the programs in `ray_advance`.
    pub struct AdvanceRays {
        /// The rays.
        pub rays: Rays,
        /// Where forces go.
        pub results: Results,
        /// How particles move.
        pub integrator: Integrator,
        /// Where positions go: rays of other particles still need the present ones.
        pub position: Ptr<Float4>,
        /// What went wrong.
        pub status: Ptr<Status>,
        /// The step that the forces belong to.
        pub step: u64,
    }

    /// Parameters of the programs in `ray_list`, `axis_list` and `edge_list`.
    pub struct ListRays {
        /// The rays.
        pub rays: Rays,
        /// Row and number in the list of each particle; null where these are places.
        pub id: Ptr<u32>,
        /// Entries of each row; where radii are per particle zero before they are counted, and counted down while rows
        /// are filled.
        pub count: Ptr<u32>,
        /// Row starts, `[n + 1]`.
        pub offset: Ptr<u64>,
        /// Neighbours.
        pub index: Ptr<u32>,
        /// Periodic image of each neighbour; null where nobody asks.
        pub image: Ptr<u8>,
        /// Entries before the first that is stored.
        pub base: u64,
        /// 1 for half lists: only neighbours of larger number.
        pub half: u32,
        /// Zero.
        pub unused: u32,
    }

    /// Arguments of `rows_*`: forces from stored rows of neighbours, numbered by place.
    pub struct RowsArgs {
        /// The interaction.
        pub law: Law,
        /// The box.
        pub space: Box3,
        /// The particles.
        pub particles: Particles,
        /// Row starts, `[n + 1]`.
        pub offset: Ptr<u64>,
        /// Candidates: they may have left the range since they were listed.
        pub index: Ptr<u32>,
        /// Where forces go.
        pub results: Results,
        /// Entries before the first that is stored.
        pub base: u64,
        /// First row.
        pub first: u32,
        /// Number of rows.
        pub n_rows: u32,
    }
}
