//! The implicit tree: leaf `l` is slots `16 l .. 16 l + 16`, and node `g` of a level has the children
//! `16 g .. 16 g + 16` of the level below. There is no topology to store or to search for, so a build is a sort and a
//! refit one linear pass over each level.

use super::node::{Aabb, Node, largest, smallest};
use crate::{Input, InputRadii, LANES, Slots};
use nearfield_core::predicate::conservative_range;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

const SLOTS_PER_NODE: usize = LANES * LANES;
/// Nodes a thread takes at once: 16 lowest nodes are 4096 slots.
const GRAIN: usize = 16;
/// 16^8 leaves are more than 32-bit slots can number.
const MAX_LEVELS: usize = 8;

/// Boxes of all levels; `levels[0]` holds those of the leaves, the last level is the root alone.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    levels: Vec<Vec<Node>>,
    leaves: usize,
}

/// How far a particle is seen on each axis, which is half the width of its box: its radius, and the rounding of the
/// squared distance. The rounding of coordinates is added to queries instead, because it grows with the extent of the
/// tree.
#[inline(always)]
pub(super) fn half_width(radius: f32) -> f32 {
    conservative_range(radius, 0.0)
}

impl Tree {
    /// Makes room for `leaves` leaves. Boxes are unspecified until [`Tree::fit`].
    pub fn reshape(&mut self, leaves: usize) {
        self.leaves = leaves;
        let (mut level, mut nodes) = (0, leaves);
        loop {
            nodes = nodes.div_ceil(LANES).max(1);
            if level == self.levels.len() {
                self.levels.push(Vec::new());
            }
            self.levels[level].resize(nodes, Node::EMPTY);
            level += 1;
            if nodes == 1 {
                break;
            }
        }
        self.levels.truncate(level);
    }

    /// Gathers positions into `slots` and fits every box, leaf `l` moved by `leaf_shift(l)`. Boxes are around bodies of
    /// half width `body` times that of [`half_width`].
    pub fn fit(
        &mut self,
        arch: Arch,
        slots: &mut Slots,
        input: &Input,
        body: f32,
        leaf_shift: impl Fn(usize) -> [f32; 3] + Sync,
    ) {
        self.fit_leaves(arch, slots, input, body, leaf_shift);
        for level in 1..self.levels.len() {
            let (below, above) = self.levels.split_at_mut(level);
            let children = below[level - 1].par_chunks(LANES);
            above[0].par_iter_mut().zip(children).with_min_len(GRAIN).for_each(|(node, children)| {
                *node = arch.dispatch(FitNode { children });
            });
        }
    }

    fn fit_leaves(
        &mut self,
        arch: Arch,
        slots: &mut Slots,
        input: &Input,
        body: f32,
        leaf_shift: impl Fn(usize) -> [f32; 3] + Sync,
    ) {
        let used = self.leaves * LANES;
        if used == 0 {
            self.levels[0].fill(Node::EMPTY);
            return;
        }
        let last_leaf = self.leaves - 1;
        let (particle, radius) = (&slots.particle[..used], &slots.radius);
        self.levels[0]
            .par_iter_mut()
            .zip(slots.x[..used].par_chunks_mut(SLOTS_PER_NODE))
            .zip(slots.y[..used].par_chunks_mut(SLOTS_PER_NODE))
            .zip(slots.z[..used].par_chunks_mut(SLOTS_PER_NODE))
            .with_min_len(GRAIN)
            .enumerate()
            .for_each(|(index, (((node, x), y), z))| {
                let range = index * SLOTS_PER_NODE..index * SLOTS_PER_NODE + x.len();
                *node = arch.dispatch(FitLeaves {
                    input,
                    body,
                    particle: &particle[range.clone()],
                    radius: radius.get(range).unwrap_or_default(),
                    position: [x, y, z],
                    shift: std::array::from_fn(|lane| leaf_shift((index * LANES + lane).min(last_leaf))),
                });
            });
    }

    /// The box of everything.
    pub fn root(&self) -> Aabb {
        self.levels.last().map_or(Aabb::EMPTY, |root| root[0].bounds())
    }

    /// The level of the root, where there is one.
    #[inline(always)]
    pub fn top(&self) -> Option<usize> {
        self.levels.len().checked_sub(1)
    }

    /// A node of a level.
    #[inline(always)]
    pub fn node(&self, level: usize, index: usize) -> &Node {
        &self.levels[level][index]
    }

    /// Calls `visit` once with each leaf whose box overlaps any of the boxes around `rays`, in ascending order.
    #[inline(always)]
    pub fn trace<const N: usize>(&self, rays: &[Aabb; N], mut visit: impl FnMut(usize)) {
        let Some(top) = self.top() else { return };
        // For each level on the way down: the node, and which of its children are still to be visited.
        let mut node = [0; MAX_LEVELS];
        let mut pending = [0; MAX_LEVELS];
        let mut level = top;
        pending[top] = self.levels[top][0].overlap_any(rays);
        loop {
            if pending[level] == 0 {
                if level == top {
                    return;
                }
                level += 1;
                continue;
            }
            if level == 0 {
                let mut hits = std::mem::take(&mut pending[0]);
                while hits != 0 {
                    visit(node[0] * LANES + hits.trailing_zeros() as usize);
                    hits &= hits - 1;
                }
                continue;
            }
            let child = node[level] * LANES + pending[level].trailing_zeros() as usize;
            pending[level] &= pending[level] - 1;
            level -= 1;
            node[level] = child;
            pending[level] = self.levels[level][child].overlap_any(rays);
        }
    }

    /// The box of leaf `leaf`.
    pub fn leaf(&self, leaf: usize) -> Aabb {
        self.levels[0][leaf / LANES].get(leaf % LANES)
    }

    /// Expected number of boxes that a random line through the root meets: the sum of their areas by the root's.
    /// Motion inflates boxes, so the growth of this since the build is the degradation that refits cause.
    pub fn cost(&self) -> f64 {
        let area = |node: &Node| (0..LANES).map(|lane| node.get(lane).half_area()).sum::<f64>();
        let total: f64 = self.levels.iter().map(|level| level.par_iter().map(area).sum::<f64>()).sum();
        let root = self.root().half_area();
        if root > 0.0 { total / root } else { 0.0 }
    }

    /// Checks that every node's lane holds exactly the bounds of the node below it.
    pub fn validate(&self) -> Result<(), String> {
        for level in 1..self.levels.len() {
            for (index, child) in self.levels[level - 1].iter().enumerate() {
                let stored = self.levels[level][index / LANES].get(index % LANES);
                if stored != child.bounds() {
                    return Err(format!("level {level}: box of child {index} is not the bounds of its children"));
                }
            }
        }
        Ok(())
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(|level| size_of::<Node>() * level.capacity()).sum()
    }
}

/// Gathers positions for the leaves below one node of the lowest level and finds their boxes.
struct FitLeaves<'a> {
    input: &'a Input<'a>,
    body: f32,
    particle: &'a [u32],
    /// Empty when uniform.
    radius: &'a [f32],
    position: [&'a mut [f32]; 3],
    shift: [[f32; 3]; LANES],
}

impl WithSimd for FitLeaves<'_> {
    type Output = Node;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Node {
        let uniform = match self.input.radii {
            InputRadii::Uniform(r) => self.body * half_width(r),
            InputRadii::PerParticle(_) => 0.0,
        };
        let mut node = Node::EMPTY;
        for (lane, particle) in self.particle.chunks_exact(LANES).enumerate() {
            let slots = lane * LANES..(lane + 1) * LANES;
            let mut half = [uniform; LANES];
            if !self.radius.is_empty() {
                for (half, &radius) in half.iter_mut().zip(&self.radius[slots.clone()]) {
                    *half = self.body * half_width(radius);
                }
            }
            let mut leaf = Aabb::EMPTY;
            for axis in 0..3 {
                let out = &mut self.position[axis][slots.clone()];
                let coordinates = self.input.position[axis];
                for (out, &particle) in out.iter_mut().zip(particle) {
                    // Padding is the particle `u32::MAX`, which does not exist.
                    *out = if (particle as usize) < coordinates.len() {
                        coordinates[particle as usize]
                    } else {
                        Slots::FAR
                    };
                }
                let (mut lo, mut hi) = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
                for slot in 0..LANES {
                    let center = out[slot] + self.shift[lane][axis];
                    // Padding must not reach the bounds.
                    lo[slot] = if out[slot] == Slots::FAR { f32::INFINITY } else { center - half[slot] };
                    hi[slot] = if out[slot] == Slots::FAR { f32::NEG_INFINITY } else { center + half[slot] };
                }
                leaf.lo[axis] = smallest(lo);
                leaf.hi[axis] = largest(hi);
            }
            node.set(lane, &leaf);
        }
        node
    }
}

/// The node of up to sixteen nodes.
struct FitNode<'a> {
    children: &'a [Node],
}

impl WithSimd for FitNode<'_> {
    type Output = Node;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Node {
        let mut node = Node::EMPTY;
        for (lane, child) in self.children.iter().enumerate() {
            node.set(lane, &child.bounds());
        }
        node
    }
}
