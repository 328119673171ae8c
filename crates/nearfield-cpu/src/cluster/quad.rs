//! Four particles of a cluster against the eight of a block: displacements by the definition of a neighbour.

use super::{
    BLOCK,
    blocks::{Blocks, Octet},
};
use crate::lanes::Lanes;

/// Particles in a cluster.
pub(super) const CLUSTER: usize = 4;

/// Vectors for a cluster: each holds two of its particles, eight times.
pub(super) const VECTORS: usize = CLUSTER / 2;

/// For the first and second cluster of a block and each vector, the lanes of pairs i < j within the block.
const LATER: [[u16; VECTORS]; 2] = {
    let mut masks = [[0; VECTORS]; 2];
    let mut i = 0;
    while i < BLOCK {
        masks[i / CLUSTER][i % CLUSTER / 2] |= ((0xff << (i + 1)) & 0xff) << (8 * (i % 2));
        i += 1;
    }
    masks
};

/// Where the particles of a cluster are.
pub(super) type Position<L> = [[<L as Lanes>::F; 3]; VECTORS];

/// A cluster to be paired with blocks seen in an image.
#[derive(Clone, Copy)]
pub(super) struct Quad<L: Lanes> {
    block: usize,
    at: usize,
    image: [L::F; 3],
    /// The shift of the image where nobody has crossed.
    shift: [L::F; 3],
    crossed: bool,
}

impl<L: Lanes> Quad<L> {
    /// Cluster `cluster`, to be paired with blocks seen in `image`.
    #[inline(always)]
    pub fn new(lanes: L, blocks: &Blocks, cluster: usize, image: [i8; 3]) -> Self {
        let (block, at) = (cluster / 2, cluster % 2 * CLUSTER);
        let [x, y, z] = image.map(f32::from);
        let [px, py, pz] = blocks.period;
        Self {
            block,
            at,
            image: [lanes.splat(x), lanes.splat(y), lanes.splat(z)],
            shift: [lanes.splat(x * px), lanes.splat(y * py), lanes.splat(z * pz)],
            crossed: blocks.crossed[block],
        }
    }

    /// What is added to displacements to block `j`, for each vector: the image and the crossings of both, in periods.
    #[inline(always)]
    pub fn shifts(&self, lanes: L, blocks: &Blocks, j: usize) -> [[L::F; 3]; VECTORS] {
        if !(self.crossed | blocks.crossed[j]) {
            return self.shifts_of_image();
        }
        let theirs = twice(lanes, &blocks.crossings[j]);
        let mut shifts = self.shifts_of_image();
        let own = quarters(lanes, &blocks.crossings[self.block], self.at);
        for v in 0..VECTORS {
            for axis in 0..3 {
                let image = lanes.sub(lanes.add(self.image[axis], theirs[axis]), own[v][axis]);
                shifts[v][axis] = lanes.mul(image, lanes.splat(blocks.period[axis]));
            }
        }
        shifts
    }

    /// As [`Quad::shifts`], where nobody has crossed.
    #[inline(always)]
    pub fn shifts_of_image(&self) -> [[L::F; 3]; VECTORS] {
        [self.shift; VECTORS]
    }
}

/// Where the particles of cluster `cluster` are, of its block at `position`.
#[inline(always)]
pub(super) fn position<L: Lanes>(lanes: L, position: &Octet, cluster: usize) -> Position<L> {
    quarters(lanes, position, cluster % 2 * CLUSTER)
}

// No closures below or in kernels: they would be compiled without the instruction set.

/// Elements `at` of each array in lanes 0 to 7 and the next in lanes 8 to 15, then the same of the two after them.
#[inline(always)]
fn quarters<L: Lanes>(lanes: L, octet: &Octet, at: usize) -> Position<L> {
    let [x, y, z] = [four(&octet.0[0], at), four(&octet.0[1], at), four(&octet.0[2], at)];
    let ([x0, x1], [y0, y1], [z0, z1]) = (lanes.quarters(x), lanes.quarters(y), lanes.quarters(z));
    [[x0, y0, z0], [x1, y1, z1]]
}

/// The first or the second half.
#[inline(always)]
fn four(of: &[f32; BLOCK], at: usize) -> &[f32; CLUSTER] {
    &of.as_chunks().0[at / CLUSTER]
}

/// An array of eight vectors, twice in each vector.
#[inline(always)]
pub(super) fn twice<L: Lanes>(lanes: L, octet: &Octet) -> [L::F; 3] {
    [lanes.twice(&octet.0[0]), lanes.twice(&octet.0[1]), lanes.twice(&octet.0[2])]
}

/// `(x_j - x_i) + shift`. Without `SHIFTED` there is no shift.
#[inline(always)]
pub(super) fn displacement<L: Lanes, const SHIFTED: bool>(
    lanes: L,
    i: &[L::F; 3],
    j: [L::F; 3],
    shift: &[L::F; 3],
) -> [L::F; 3] {
    let mut d = j;
    for axis in 0..3 {
        d[axis] = lanes.sub(j[axis], i[axis]);
        if SHIFTED {
            d[axis] = lanes.add(d[axis], shift[axis]);
        }
    }
    d
}

/// The squared length as the predicate defines it.
#[inline(always)]
pub(super) fn squared_length<L: Lanes>(lanes: L, [x, y, z]: [L::F; 3]) -> L::F {
    lanes.mul_add(x, x, lanes.mul_add(y, y, lanes.mul(z, z)))
}

/// The lanes of cluster `cluster` that are pairs, where a block is listed with a cluster of its own.
#[inline(always)]
pub(super) fn own_pairs(cluster: usize) -> [u16; VECTORS] {
    LATER[cluster % 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_of_a_block_with_itself_hold_each_pair_once() {
        let mut seen = [[0; BLOCK]; BLOCK];
        for cluster in 0..2 {
            for (v, mask) in own_pairs(cluster).into_iter().enumerate() {
                for lane in (0..16).filter(|lane| mask >> lane & 1 == 1) {
                    seen[CLUSTER * cluster + 2 * v + lane / 8][lane % 8] += 1;
                }
            }
        }
        for (i, row) in seen.iter().enumerate() {
            for (j, &count) in row.iter().enumerate() {
                assert_eq!(count, u32::from(i < j), "{i} {j}");
            }
        }
    }
}
