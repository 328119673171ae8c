//! Any law, with sums that do not depend on order: pairs in range are found by vectors and computed one by one.

use super::{
    BLOCK, Output,
    blocks::Blocks,
    list::{PairList, Pairs},
    quad::{self, CLUSTER, Quad, VECTORS, displacement, own_pairs, squared_length, twice},
    sums::{Exact, PageSums},
};
use crate::{
    Grid,
    kernel::with_law,
    lanes::{self, Lanes},
    physics::Physics,
};
use nearfield_core::{
    interaction::{Coefficients, PairLaw},
    predicate,
};

/// `f/r` and energy of a pair in range, from r² and both types.
type PairFunction<'a> = &'a (dyn Fn(f32, u32, u32) -> [f32; 2] + Sync);

/// See [`super::Clusters::evaluate`].
pub(super) fn evaluate(
    physics: &Physics,
    blocks: &Blocks,
    list: &mut PairList,
    grid: Option<&Grid>,
    sums: &mut PageSums,
    out: Output,
) -> bool {
    let cutoff = physics.cutoff();
    with_law!(physics, law, coefficients => {
        let pair = |r2: f32, kind_i: u32, kind_j: u32| {
            let c = coefficients.get(kind_i, kind_j, cutoff);
            [law.f_over_r(r2, &c), law.energy(r2, &c)]
        };
        sums.evaluate_exactly(blocks, list, grid, out, &|list, sums| {
            super::isa().run(Kernel { pair: &pair, blocks, list, physics, sums });
        })
    })
}

struct Kernel<'a> {
    pair: PairFunction<'a>,
    blocks: &'a Blocks,
    list: &'a Pairs,
    physics: &'a Physics,
    sums: &'a mut [Exact],
}

impl lanes::Kernel for Kernel<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let (blocks, list) = (self.blocks, self.list);
        let range2 = lanes.splat(blocks.cutoff * blocks.cutoff);
        for segment in &list.segments {
            let cluster = segment.cluster as usize;
            let quad = Quad::new(lanes, blocks, cluster, segment.image);
            let position = quad::position(lanes, &blocks.position[cluster / 2], cluster);
            for (k, &j) in list.blocks[segment.start as usize..segment.end as usize].iter().enumerate() {
                let j = j as usize;
                let at = twice(lanes, &blocks.position[j]);
                let shifts = quad.shifts(lanes, blocks, j);
                let own = segment.own && k == 0;
                let pairs = if own { own_pairs(cluster) } else { [u16::MAX; VECTORS] };
                for v in 0..VECTORS {
                    let r2 = squared_length(lanes, displacement::<L, true>(lanes, &position[v], at, &shifts[v]));
                    let mut inside = lanes.lt(r2, range2) & pairs[v];
                    while inside != 0 {
                        let lane = inside.trailing_zeros() as usize;
                        let i = cluster % 2 * CLUSTER + 2 * v + lane / BLOCK;
                        self.add((cluster / 2, i), (j, lane % BLOCK), segment.image);
                        inside &= inside - 1;
                    }
                }
            }
        }
    }
}

impl Kernel<'_> {
    /// Adds a pair in range to both sides.
    #[inline(always)]
    fn add(&mut self, i: (usize, usize), j: (usize, usize), image: [i8; 3]) {
        let blocks = self.blocks;
        let place = |(b, lane): (usize, usize)| blocks.position[b].0.map(|x| x[lane]);
        let crossing = |(b, lane): (usize, usize)| blocks.crossings[b].0.map(|x| x[lane]);
        let (ci, cj) = (crossing(i), crossing(j));
        let shift = std::array::from_fn(|a| (f32::from(image[a]) - ci[a] + cj[a]) * blocks.period[a]);
        let dr = predicate::displacement(place(i), place(j), shift);
        let r2 = predicate::squared_length(dr);
        let kind = |(b, lane): (usize, usize)| blocks.kind.get(b).map_or(0, |kinds| kinds[lane]);
        let [f, u] = (self.pair)(r2, kind(i), kind(j));
        let (grain, cap) = (self.physics.grain, self.physics.cap);
        let f = if f < cap { f } else { cap };
        let u = if u < cap { u } else { cap };
        let force = [0, 1, 2].map(|axis| grain.force(-(f * dr[axis])));
        let [x, y, z] = force;
        let (u, w) = (grain.energy(u), grain.energy(f * r2));
        self.sums[i.0].add(i.1, [x, y, z, u, w, 1.0]);
        self.sums[j.0].add(j.1, [-x, -y, -z, u, w, 1.0]);
    }
}
