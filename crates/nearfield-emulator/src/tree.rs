//! A bounding-volume hierarchy over boxes.

use nearfield_cuda::gpu::Aabb;

/// Most boxes of a leaf.
const LEAF: usize = 4;
/// Halving 2^32 boxes takes no more levels.
const MAX_DEPTH: usize = 33;
/// Bounds of nothing.
const NOTHING: Aabb = [f32::INFINITY, f32::INFINITY, f32::INFINITY, -f32::INFINITY, -f32::INFINITY, -f32::INFINITY];

/// Boxes in a binary tree, as they were at the last build or refit.
pub struct Tree {
    nodes: Vec<Node>,
    /// Numbers of the boxes, by leaf.
    order: Vec<u32>,
    /// The boxes, in the same order.
    boxes: Vec<Aabb>,
}

struct Node {
    bounds: Aabb,
    /// Place of the first box in `order`.
    first: usize,
    count: usize,
    /// The second child; the first follows its parent. Zero for leaves.
    second: usize,
}

impl Tree {
    /// Over boxes.
    pub fn new(boxes: &[Aabb]) -> Self {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = Vec::with_capacity(boxes.len());
        split(boxes, &mut order, 0, &mut nodes);
        let mut tree = Self { nodes, order, boxes: Vec::new() };
        tree.refit(boxes);
        tree
    }

    /// Fits the tree to as many boxes as it has.
    pub fn refit(&mut self, boxes: &[Aabb]) {
        self.boxes.clear();
        self.boxes.extend(self.order.iter().map(|&number| boxes[number as usize]));
        // Children come after their parents.
        for i in (0..self.nodes.len()).rev() {
            let Node { first, count, second, .. } = self.nodes[i];
            self.nodes[i].bounds = match second {
                0 => self.boxes[first..first + count].iter().fold(NOTHING, union),
                _ => union(self.nodes[i + 1].bounds, &self.nodes[second].bounds),
            };
        }
    }

    /// Calls `found` with the number of each box that shares a point with another, bounds included. One with a NaN has
    /// none.
    pub fn overlapping(&self, other: &Aabb, mut found: impl FnMut(u32)) {
        let mut stack = [0; MAX_DEPTH];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let i = stack[height];
            let Node { ref bounds, first, count, second } = self.nodes[i];
            if !overlap(bounds, other) {
                continue;
            }
            if second == 0 {
                for k in first..first + count {
                    if overlap(&self.boxes[k], other) {
                        found(self.order[k]);
                    }
                }
            } else {
                stack[height] = second;
                stack[height + 1] = i + 1;
                height += 2;
            }
        }
    }
}

/// Appends the node of some boxes and those below it, halving along the axis of the widest spread of centres.
fn split(boxes: &[Aabb], order: &mut [u32], first: usize, nodes: &mut Vec<Node>) {
    let node = nodes.len();
    nodes.push(Node { bounds: NOTHING, first, count: order.len(), second: 0 });
    if order.len() <= LEAF {
        return;
    }
    let center = |number: u32, axis: usize| boxes[number as usize][axis] + boxes[number as usize][axis + 3];
    let spread = |axis: usize| {
        let centers = order.iter().map(|&number| center(number, axis));
        let (lo, hi) = centers.fold((f32::INFINITY, f32::NEG_INFINITY), |(lo, hi), c| (lo.min(c), hi.max(c)));
        hi - lo
    };
    let spreads = [0, 1, 2].map(spread);
    let axis = (0..3).max_by(|&a, &b| spreads[a].total_cmp(&spreads[b])).unwrap_or(0);
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&a, &b| center(a, axis).total_cmp(&center(b, axis)));
    let (low, high) = order.split_at_mut(half);
    split(boxes, low, first, nodes);
    nodes[node].second = nodes.len();
    split(boxes, high, first + half, nodes);
}

/// NaN bounds are left out.
fn union(a: Aabb, b: &Aabb) -> Aabb {
    std::array::from_fn(|k| if k < 3 { a[k].min(b[k]) } else { a[k].max(b[k]) })
}

fn overlap(a: &Aabb, b: &Aabb) -> bool {
    (0..3).all(|axis| a[axis] <= b[axis + 3] && b[axis] <= a[axis + 3])
}
