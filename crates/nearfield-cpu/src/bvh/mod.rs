//! A software bounding volume hierarchy with the programming model of a ray-tracing API: boxes around particles are
//! built into a tree or refitted in it, and point rays are traced through it.
//!
//! Particle j is the box `c_j ± r_j`, so a point ray from i finds exactly the j with `|x_i - x_j| < r_j` on each
//! axis, the rest of which the predicate refuses. The radius of the *query* plays no part: a pair with
//! `r_j <= d < r_i` is found from the side of j alone. Other bodies and rays find the same where there is one radius:
//! see [`Probe`].

mod hilbert;
mod images;
mod node;
mod order;
mod probe;
mod ray_cast;
mod sort;
#[cfg(test)]
mod tests;
mod tree;
mod validate;

use crate::{GroupBox, Input, InputRadii, LANES, Run, Slots, Structure, Vicinity};
use images::{Scene, Views};
use nearfield_core::{Images, SimBox, predicate::conservative_range};
use node::Aabb;
pub(crate) use order::CurveOrder;
pub use probe::Probe;
use pulp::{Arch, Simd, WithSimd};
pub use ray_cast::Ray;
use rayon::prelude::*;
use std::ops::Range;
use tree::{Tree, half_width};

/// What a refit came to.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refit {
    /// The tree follows the new positions.
    Done,
    /// The tree would miss pairs and must be built: the ghosts were outrun, or the input changed its size or kind.
    NeedsBuild,
}

/// An implicit 16-wide tree over particles along a Hilbert curve, traced by groups of the 16 points of a leaf.
///
/// As a [`Structure`] it proposes, for each query point p of a group, every slot j and image with `d(p, j) < r_j`;
/// [`GroupBox::radius`] is ignored. Query points are wrapped into the box on periodic axes. Consumers that need
/// max(r_i, r_j) let the pair act from one side: the smaller radius, ties by index.
///
/// ```
/// use nearfield_core::{Boundary, Images, SimBox};
/// use nearfield_cpu::{Bvh, GroupBox, Input, InputRadii, Refit, Run, Structure, Vicinity};
/// let sim_box = SimBox::cubic(10.0, Boundary::Periodic)?;
/// let x = [0.5, 9.5];
/// let input = Input { sim_box: &sim_box, position: [&x, &x, &x], radii: InputRadii::Uniform(2.0), kind: &[] };
/// let mut bvh = Bvh::new(Images::Gamma);
/// bvh.build(&input);
/// let mut runs = Vec::new();
/// bvh.runs(&GroupBox { lo: [0.5; 3], hi: [0.5; 3], radius: 2.0 }, &mut Vicinity::default(), &mut runs);
/// assert!(runs.contains(&Run { start: 0, end: 16, image: [-1; 3] }));
/// assert_eq!(bvh.refit(&input), Refit::Done);
/// # Ok::<(), nearfield_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Bvh {
    arch: Arch,
    probe: Probe,
    order: CurveOrder,
    slots: Slots,
    tree: Tree,
    views: Views,
    /// The images of the box, and what moves a query back from each into the tree.
    images: Vec<([i8; 3], [f32; 3])>,
    n_particles: usize,
    /// Radius of all, where they are not per particle.
    uniform_radius: Option<f32>,
    sim_box: Option<SimBox>,
    /// Added to queries on each side: what rounding of coordinates may amount to.
    slack: f32,
}

impl Bvh {
    /// A tree of nothing for point rays, seeing periodic images by `images`.
    pub fn new(images: Images) -> Self {
        Self::with_probe(Probe::Point, images)
    }

    /// A tree of nothing for rays of another kind.
    pub fn with_probe(probe: Probe, images: Images) -> Self {
        Self {
            arch: Arch::new(),
            probe,
            order: CurveOrder::default(),
            slots: Slots::default(),
            tree: Tree::default(),
            views: Views::new(images),
            images: vec![([0; 3], [0.0; 3])],
            n_particles: 0,
            uniform_radius: None,
            sim_box: None,
            slack: 0.0,
        }
    }

    /// Builds the tree anew. Nothing is allocated when sizes repeat.
    pub fn build(&mut self, input: &Input) {
        self.n_particles = input.len();
        let real_slots = self.n_particles.next_multiple_of(LANES);
        let particle = &mut self.slots.particle;
        particle.clear();
        particle.resize(real_slots, u32::MAX);
        particle[..self.n_particles].par_iter_mut().zip(self.order.sort(input)).for_each(|(slot, key)| *slot = key);
        if let Some(ghosts) = self.views.ghosts_mut() {
            ghosts.create(&mut self.slots, input);
        }
        let used = self.slots.particle.len();
        self.slots.particle.resize(used + LANES, u32::MAX);
        for axis in [&mut self.slots.x, &mut self.slots.y, &mut self.slots.z] {
            axis.resize(used + LANES, Slots::FAR);
            axis[used..].fill(Slots::FAR);
        }
        gather(&mut self.slots.kind, &self.slots.particle, input.kind, 0);
        self.tree.reshape(used / LANES);
        self.fit(input);
    }

    /// Fits the boxes of the last build to new positions and radii, in the old order. Types must not have changed.
    ///
    /// After [`Refit::NeedsBuild`] the tree must be built before its next use.
    pub fn refit(&mut self, input: &Input) -> Refit {
        let uniform = matches!(input.radii, InputRadii::Uniform(_));
        let same_input = input.len() == self.n_particles && uniform == self.uniform_radius.is_some();
        if self.sim_box.is_none() || !same_input {
            return Refit::NeedsBuild;
        }
        let largest = self.fit(input);
        let beyond_body = (1.0 - self.probe.body()) * half_width(largest);
        match self.views.ghosts() {
            Some(ghosts) if !ghosts.suffice(&self.tree, &self.slots, input, beyond_body) => Refit::NeedsBuild,
            _ => Refit::Done,
        }
    }

    /// Surface-area cost of the tree: the expected number of boxes met by a random line through it. Its growth since
    /// the last build says how far refits have degraded the tree.
    pub fn quality(&self) -> f64 {
        self.tree.cost()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let ghosts = self.views.ghosts().map_or(0, |ghosts| ghosts.bytes());
        self.slots.bytes() + self.tree.bytes() + self.order.bytes() + ghosts
    }

    /// Gives the largest radius.
    fn fit(&mut self, input: &Input) -> f32 {
        let (radii, largest): (&[f32], f32) = match input.radii {
            InputRadii::Uniform(r) => (&[], r),
            InputRadii::PerParticle(radii) => (radii, order::range(radii).1),
        };
        gather(&mut self.slots.radius, &self.slots.particle, radii, 0.0);
        self.uniform_radius = matches!(input.radii, InputRadii::Uniform(_)).then_some(largest);
        let (sim_box, body) = (input.sim_box, self.probe.body());
        match self.views.ghosts() {
            Some(ghosts) => {
                self.tree.fit(self.arch, &mut self.slots, input, body, |leaf| sim_box.shift(ghosts.image(leaf)));
            }
            None => self.tree.fit(self.arch, &mut self.slots, input, body, |_| [0.0; 3]),
        }
        let root = self.tree.root();
        let corners = [root.lo, root.hi, sim_box.lo(), sim_box.hi()];
        let extent = corners.as_flattened().iter().fold(0.0, |extent: f32, c| extent.max(c.abs()));
        self.slack = if self.n_particles == 0 { 0.0 } else { self.probe.roundings() * conservative_range(0.0, extent) };
        self.views.update(&Scene { sim_box, root, largest: half_width(largest) });
        self.images.clear();
        self.images.extend(sim_box.images().into_iter().map(|image| (image, sim_box.shift(image.map(|c| -c)))));
        self.sim_box = Some(*sim_box);
        largest
    }
}

impl Structure for Bvh {
    fn slots(&self) -> &Slots {
        &self.slots
    }

    fn n_groups(&self) -> usize {
        self.n_particles.div_ceil(LANES)
    }

    fn group(&self, g: usize) -> Range<usize> {
        g * LANES..(g + 1) * LANES
    }

    fn runs(&self, group: &GroupBox, _: &mut Vicinity, out: &mut Vec<Run>) {
        self.arch.dispatch(Trace { bvh: self, group, out });
    }

    fn complete(&self) -> bool {
        self.uniform_radius.is_some()
    }
}

/// [`Structure::runs`], compiled for each instruction set.
struct Trace<'a> {
    bvh: &'a Bvh,
    group: &'a GroupBox,
    out: &'a mut Vec<Run>,
}

impl WithSimd for Trace<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let query = Aabb { lo: self.group.lo, hi: self.group.hi }.inflated(self.bvh.slack);
        let reach = half_width(self.bvh.uniform_radius.unwrap_or(0.0));
        match self.bvh.probe {
            Probe::Point => self.rays(&query, [query]),
            Probe::Axes => self.rays(&query, probe::axis_rays(&query, reach)),
            Probe::Edges => self.rays(&query, probe::edge_rays(&query, reach)),
        }
    }
}

impl Trace<'_> {
    /// Traces the rays of all points in `query` together, so that a leaf is proposed once whichever of them it meets.
    #[inline(always)]
    fn rays<const N: usize>(self, query: &Aabb, rays: [Aabb; N]) {
        let Self { bvh, out, .. } = self;
        let ghosts = bvh.views.ghosts();
        let mut visible = bvh.views.visible(query, &rays);
        while visible != 0 {
            let (view, back) = bvh.images[visible.trailing_zeros() as usize];
            visible &= visible - 1;
            let mut there = rays;
            for ray in &mut there {
                *ray = ray.translated(back);
            }
            bvh.tree.trace(
                &there,
                #[inline(always)]
                |leaf| {
                    let image = match ghosts {
                        Some(ghosts) => ghosts.image(leaf),
                        None => view,
                    };
                    let start = (leaf * LANES) as u32;
                    match out.last_mut() {
                        Some(last) if last.end == start && last.image == image => last.end += LANES as u32,
                        _ => out.push(Run { start, end: start + LANES as u32, image }),
                    }
                },
            );
        }
    }
}

/// `out[s] = values[particle[s]]`, and `padding` where there is no particle; empty when `values` are.
fn gather<T: Copy + Send + Sync>(out: &mut Vec<T>, particle: &[u32], values: &[T], padding: T) {
    out.clear();
    if !values.is_empty() {
        out.resize(particle.len(), padding);
        out.par_iter_mut().zip(particle).with_min_len(4096).for_each(|(out, &particle)| {
            *out = values.get(particle as usize).copied().unwrap_or(padding);
        });
    }
}
