//! Ghosts (tutorial C): particles whose box pokes over a face appear once more on the other side, as slots of their
//! own behind the real ones. Queries then need no second ray.
//!
//! The set is frozen between builds, so it is drawn with a margin for motion. A particle within the margin of a face
//! may also be wrapped to the other side, where it needs the opposite images: those stand by from the start, in
//! leaves of their own, because until then they lie a box length away from the ghosts in use.

use crate::{Input, InputRadii, LANES, Slots, bvh::tree::half_width};
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
    /// Particles to mirror, by image and readiness.
    lists: Vec<Vec<u32>>,
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
            *faces = if particle == u32::MAX {
                Faces::default()
            } else {
                let wrappable = Faces::within(sim_box, input.at(particle as usize), slack + margin);
                faces_in_use(particle).union(wrappable.with_opposites())
            };
        });

        let images = &sim_box.images()[1..];
        self.lists.resize(2 * images.len(), Vec::new());
        self.lists.iter_mut().for_each(Vec::clear);
        for (&faces, &particle) in self.faces.iter().zip(&slots.particle) {
            if faces == Faces::default() {
                continue;
            }
            let in_use = faces_in_use(particle);
            for (index, &image) in images.iter().enumerate() {
                let needed = Faces::of_image(image);
                if faces.contains(needed) {
                    let stands_by = usize::from(!in_use.contains(needed));
                    self.lists[2 * index + stands_by].push(particle);
                }
            }
        }

        self.leaf_images.clear();
        for (index, list) in self.lists.iter().enumerate() {
            slots.particle.extend_from_slice(list);
            slots.particle.resize(slots.particle.len().next_multiple_of(LANES), u32::MAX);
            self.leaf_images.resize(slots.particle.len() / LANES - self.real_leaves(), images[index / 2]);
        }
    }

    /// Whether every image needed at the current positions exists.
    pub fn suffice(&self, slots: &Slots, input: &Input) -> bool {
        let slack = coordinate_slack(input.sim_box);
        self.faces.par_iter().zip(&slots.particle).enumerate().with_min_len(4096).all(|(slot, (faces, &particle))| {
            particle == u32::MAX || {
                let reach = slack + half_width(input.radius(particle as usize));
                faces.contains(Faces::within(input.sim_box, slots.at(slot), reach))
            }
        })
    }

    /// The image of leaf `leaf`; `[0, 0, 0]` for leaves of real particles.
    #[inline(always)]
    pub fn image(&self, leaf: usize) -> [i8; 3] {
        if leaf < self.real_leaves() { [0; 3] } else { self.leaf_images[leaf - self.real_leaves()] }
    }

    pub fn bytes(&self) -> usize {
        self.faces.capacity()
            + size_of::<[i8; 3]>() * self.leaf_images.capacity()
            + self.lists.iter().map(|list| size_of::<u32>() * list.capacity()).sum::<usize>()
    }

    #[inline(always)]
    fn real_leaves(&self) -> usize {
        self.faces.len() / LANES
    }
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
