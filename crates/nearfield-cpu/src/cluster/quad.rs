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

/// A cluster in vectors.
#[derive(Clone, Copy)]
pub(super) struct Quad<L: Lanes> {
    position: [[L::F; 3]; VECTORS],
    /// The image less the crossings of the cluster's own particles: the crossings of the others are to be added.
    image: [[L::F; 3]; VECTORS],
    period: [L::F; 3],
}

impl<L: Lanes> Quad<L> {
    /// Cluster `cluster`, to be paired with blocks seen in `image`.
    #[inline(always)]
    pub fn new(lanes: L, blocks: &Blocks, cluster: usize, image: [i8; 3]) -> Self {
        let (block, at) = (cluster / 2, cluster % 2 * CLUSTER);
        let (position, crossings) = (&blocks.position[block].0, &blocks.crossings[block].0);
        let pair = |from: &[[f32; BLOCK]; 3], axis: usize, v: usize| {
            lanes.halves(from[axis][at + 2 * v], from[axis][at + 2 * v + 1])
        };
        let of = |v: usize| [pair(position, 0, v), pair(position, 1, v), pair(position, 2, v)];
        let image_of = |v: usize, axis: usize| lanes.sub(lanes.splat(f32::from(image[axis])), pair(crossings, axis, v));
        let images = |v: usize| [image_of(v, 0), image_of(v, 1), image_of(v, 2)];
        Self {
            position: [of(0), of(1)],
            image: [images(0), images(1)],
            period: [lanes.splat(blocks.period[0]), lanes.splat(blocks.period[1]), lanes.splat(blocks.period[2])],
        }
    }

    /// `(x_j - x_i) + image * period` of vector `v`. Without `IMAGES` none has an image.
    #[inline(always)]
    pub fn displacement<const IMAGES: bool>(
        &self,
        lanes: L,
        v: usize,
        j: [L::F; 3],
        crossings: [L::F; 3],
    ) -> [L::F; 3] {
        let along = |axis: usize| {
            let d = lanes.sub(j[axis], self.position[v][axis]);
            if IMAGES {
                let image = lanes.add(self.image[v][axis], crossings[axis]);
                lanes.add(d, lanes.mul(image, self.period[axis]))
            } else {
                d
            }
        };
        [along(0), along(1), along(2)]
    }
}

/// An array of eight vectors, twice in each vector.
#[inline(always)]
pub(super) fn twice<L: Lanes>(lanes: L, octet: &Octet) -> [L::F; 3] {
    [lanes.twice(&octet.0[0]), lanes.twice(&octet.0[1]), lanes.twice(&octet.0[2])]
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
