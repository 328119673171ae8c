//! Ghosts (tutorial C): particles that are seen over a face appear once more on the other side, as slots of their
//! own behind the real ones. Queries then need no second ray.
//!
//! The set is frozen between builds, so it is drawn with a margin for motion. A particle within the margin of a face
//! may also be wrapped to the other side, where it needs the opposite images: those stand by from the start, in
//! leaves of their own, because until then they lie a box length away from the ghosts in use.

use super::Aabb;
use crate::bvh::tree::{Tree, half_width};
use crate::{Input, InputRadii, LANES, Slots};
use nearfield_core::{SimBox, predicate::conservative_range};
use rayon::prelude::*;

/// How far particles may move before ghosts run out, in mean radii. Wider margins mean fewer builds and more slots.
const MARGIN: f32 = 0.2;

/// Which images of each particle exist.
#[derive(Clone, Debug, Default)]
pub(in crate::bvh) struct Ghosts {
    /// For each real slot, the faces for which it has ghosts.
    faces: Vec<Faces>,
    /// Image of each ghost leaf.
    leaf_images: Vec<[i8; 3]>,
    /// Scratch: the particles that have ghosts.
    near_faces: Vec<NearFaces>,
    /// Scratch: for each image, the particles mirrored there whose ghost is in use, and stands by.
    lists: Vec<[Vec<u32>; 2]>,
}

#[derive(Clone, Copy, Debug)]
struct NearFaces {
    particle: u32,
    /// The faces for which it has ghosts, and those of them that it reaches already.
    faces: Faces,
    in_use: Faces,
}

/// A set of faces, two bits an axis: bit `2 axis` is the lower face, seen again in image +1, bit `2 axis + 1` the
/// upper face, seen again in image -1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Faces(u8);

impl Faces {
    /// The periodic faces that a box of half width `half` around `center` reaches.
    #[inline(always)]
    fn within(sim_box: &SimBox, center: [f32; 3], half: f32) -> Self {
        let (lo, hi) = (sim_box.lo(), sim_box.hi());
        let faces = (0..3).filter(|&axis| sim_box.is_periodic(axis)).fold(0, |faces, axis| {
            let lower = u8::from(center[axis] - half < lo[axis]);
            let upper = u8::from(center[axis] + half >= hi[axis]);
            faces | lower << (2 * axis) | upper << (2 * axis + 1)
        });
        Self(faces)
    }

    /// The faces by which a particle is seen in `image`.
    fn of_image(image: [i8; 3]) -> Self {
        Self((0..3).fold(0, |faces, axis| {
            faces
                | match image[axis] {
                    0 => 0,
                    1.. => 1 << (2 * axis),
                    _ => 2 << (2 * axis),
                }
        }))
    }

    /// These faces, and their opposites.
    fn with_opposites(self) -> Self {
        Self(self.0 | (self.0 & 0b01_0101) << 1 | (self.0 & 0b10_1010) >> 1)
    }

    fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    fn contains(self, other: Self) -> bool {
        other.0 & !self.0 == 0
    }
}

impl Ghosts {
    /// Appends ghost slots to the `real` ones of `slots.particle`, whole leaves of one image each.
    pub fn create(&mut self, slots: &mut Slots, input: &Input) {
        let sim_box = input.sim_box;
        let slack = coordinate_slack(sim_box);
        let margin = MARGIN * mean_radius(input);
        let reach = |particle: u32| slack + margin + half_width(input.radius(particle as usize));
        let faces_in_use = |particle: u32| Faces::within(sim_box, input.at(particle as usize), reach(particle));

        self.faces.resize(slots.particle.len(), Faces::default());
        self.faces.par_iter_mut().zip(&slots.particle).with_min_len(4096).for_each(|(faces, &particle)| {
            *faces = Faces::default();
            if particle != u32::MAX {
                let in_use = faces_in_use(particle);
                if in_use != Faces::default() {
                    let wrappable = Faces::within(sim_box, input.at(particle as usize), slack + margin);
                    *faces = in_use.union(wrappable.with_opposites());
                }
            }
        });

        self.near_faces.clear();
        let near_faces = self.faces.iter().zip(&slots.particle).filter(|(faces, _)| **faces != Faces::default());
        self.near_faces.extend(near_faces.map(|(&faces, &particle)| NearFaces {
            particle,
            faces,
            in_use: faces_in_use(particle),
        }));

        let images = &sim_box.images()[1..];
        self.lists.resize(images.len(), [Vec::new(), Vec::new()]);
        self.lists.par_iter_mut().zip(images).for_each(|([in_use, standing_by], &image)| {
            in_use.clear();
            standing_by.clear();
            let needed = Faces::of_image(image);
            for near in self.near_faces.iter().filter(|near| near.faces.contains(needed)) {
                if near.in_use.contains(needed) { &mut *in_use } else { &mut *standing_by }.push(near.particle);
            }
        });

        self.leaf_images.clear();
        for (lists, &image) in self.lists.iter().zip(images) {
            for list in lists {
                slots.particle.extend_from_slice(list);
                slots.particle.resize(slots.particle.len().next_multiple_of(LANES), u32::MAX);
                self.leaf_images.resize(slots.particle.len() / LANES - self.faces.len() / LANES, image);
            }
        }
    }

    /// Whether every image needed at the positions that `tree` was fitted to exists. Particles are seen up to
    /// `beyond_body` further than their boxes in the tree reach.
    pub fn suffice(&self, tree: &Tree, slots: &Slots, input: &Input, beyond_body: f32) -> bool {
        let slack = coordinate_slack(input.sim_box);
        // Most leaves are far from all faces as a whole. Twice the slack, because their boxes are rounded once more.
        let interior = interior(input.sim_box, 2.0 * slack + beyond_body);
        let slot_suffices = |slot: usize| {
            let particle = slots.particle[slot];
            particle == u32::MAX || {
                let reach = slack + half_width(input.radius(particle as usize));
                self.faces[slot].contains(Faces::within(input.sim_box, slots.at(slot), reach))
            }
        };
        (0..self.real_leaves())
            .into_par_iter()
            .with_min_len(256)
            .all(|leaf| interior.holds(&tree.leaf(leaf)) || (leaf * LANES..(leaf + 1) * LANES).all(slot_suffices))
    }

    /// The image of leaf `leaf`; `[0, 0, 0]` for leaves of real particles.
    #[inline(always)]
    pub fn image(&self, leaf: usize) -> [i8; 3] {
        if leaf < self.real_leaves() { [0; 3] } else { self.leaf_images[leaf - self.real_leaves()] }
    }

    pub fn bytes(&self) -> usize {
        self.faces.capacity()
            + size_of::<[i8; 3]>() * self.leaf_images.capacity()
            + size_of::<NearFaces>() * self.near_faces.capacity()
            + self.lists.iter().flatten().map(|list| size_of::<u32>() * list.capacity()).sum::<usize>()
    }

    #[inline(always)]
    fn real_leaves(&self) -> usize {
        self.faces.len() / LANES
    }
}

/// What is further than `margin` from all periodic faces.
fn interior(sim_box: &SimBox, margin: f32) -> Aabb {
    let mut interior = Aabb { lo: [f32::NEG_INFINITY; 3], hi: [f32::INFINITY; 3] };
    for axis in (0..3).filter(|&axis| sim_box.is_periodic(axis)) {
        interior.lo[axis] = sim_box.lo()[axis] + margin;
        interior.hi[axis] = sim_box.hi()[axis] - margin;
    }
    interior
}

/// How far rounding may move a particle across a face.
fn coordinate_slack(sim_box: &SimBox) -> f32 {
    let extent = sim_box.lo().into_iter().chain(sim_box.hi()).fold(0.0, |extent: f32, face| extent.max(face.abs()));
    conservative_range(0.0, extent)
}

fn mean_radius(input: &Input) -> f32 {
    match input.radii {
        InputRadii::Uniform(r) => r,
        InputRadii::PerParticle(radii) => {
            let sum: f64 = radii.iter().map(|&r| f64::from(r)).sum();
            (sum / radii.len().max(1) as f64) as f32
        }
    }
}
