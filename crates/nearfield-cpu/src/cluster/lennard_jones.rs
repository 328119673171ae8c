//! Lennard-Jones by whole vectors: two laws, and the kernel over the inner list.

use super::{
    BLOCK,
    blocks::{Blocks, Octet},
    list::Pairs,
    quad::{CLUSTER, Quad, VECTORS, own_pairs, squared_length, twice},
};
use crate::{
    lanes::{self, Lanes},
    physics::Physics,
};
use nearfield_core::{Truncation, interaction::PairCoefficients};

/// A pair law in vectors, given the reciprocal of r².
pub(super) trait Law: Copy + Sync {
    /// Whether types matter.
    const TYPED: bool;

    /// What forces and energies are to be multiplied with at last.
    fn scale(&self) -> f32;

    /// What the functions below need to know of pairs of two particles' types with those of eight.
    fn coefficients<L: Lanes>(&self, lanes: L, i: [u32; 2], j: &[u32; BLOCK]) -> [L::F; 4];

    /// `-(1/r) dU/dr` from `y` = 1 / r², for several vectors at once: each operation on all of them before the next,
    /// so that none waits for the one before.
    fn f_over_r<L: Lanes, const K: usize>(&self, lanes: L, y: &[L::F; K], c: &[[L::F; 4]; K]) -> [L::F; K];

    /// `U` from `y` = 1 / r² and r².
    fn energy<L: Lanes>(&self, lanes: L, y: L::F, r2: L::F, c: &[L::F; 4]) -> L::F;
}

/// One type, force not shifted, no cap: in units of 48 ε σ¹², which leaves one constant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plain {
    scale: f32,
    /// 1 / (2 σ⁶)
    half_inverse_sigma6: f32,
    shift: f32,
}

impl Plain {
    /// Where the system allows. Powers of distances far from one would leave the range of f32.
    pub fn new(physics: &Physics) -> Option<Self> {
        let [kind] = &physics.interaction.types[..] else { return None };
        let sigma6 = f64::from(kind.sigma).powi(6);
        let c = physics.interaction.single(physics.cutoff()).0;
        let scale = (48.0 * f64::from(kind.epsilon) * sigma6 * sigma6) as f32;
        let usable = (0.02..=20.0).contains(&kind.sigma)
            && physics.cutoff() <= 300.0
            && physics.cap == f32::INFINITY
            && scale.is_normal()
            && physics.interaction.truncation != Truncation::Force;
        let half_inverse_sigma6 = (0.5 / sigma6) as f32;
        usable.then_some(Self { scale, half_inverse_sigma6, shift: c.energy_shift / scale })
    }
}

impl Law for Plain {
    const TYPED: bool = false;

    fn scale(&self) -> f32 {
        self.scale
    }

    #[inline(always)]
    fn coefficients<L: Lanes>(&self, lanes: L, _: [u32; 2], _: &[u32; BLOCK]) -> [L::F; 4] {
        let zero = lanes.splat(0.0);
        [lanes.splat(self.half_inverse_sigma6), lanes.splat(self.shift), zero, zero]
    }

    #[inline(always)]
    fn f_over_r<L: Lanes, const K: usize>(&self, lanes: L, y: &[L::F; K], c: &[[L::F; 4]; K]) -> [L::F; K] {
        let (mut y2, mut y3) = (*y, *y);
        for k in 0..K {
            y2[k] = lanes.mul(y[k], y[k]);
        }
        for k in 0..K {
            y3[k] = lanes.sub(lanes.mul(y2[k], y[k]), c[k][0]);
        }
        for k in 0..K {
            y2[k] = lanes.mul(y2[k], y2[k]);
        }
        for k in 0..K {
            y3[k] = lanes.mul(y3[k], y2[k]);
        }
        y3
    }

    #[inline(always)]
    fn energy<L: Lanes>(&self, lanes: L, y: L::F, _: L::F, c: &[L::F; 4]) -> L::F {
        let y3 = lanes.mul(lanes.mul(y, y), y);
        let u = lanes.mul(y3, lanes.sub(y3, lanes.add(c[0], c[0])));
        lanes.sub(lanes.mul(u, lanes.splat(1.0 / 12.0)), c[1])
    }
}

/// Up to eight types, any truncation, and a cap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Typed<const FORCE_SHIFT: bool> {
    /// Rows by type of i, entries by type of j: σ², 48 ε, energy shift, force shift.
    rows: [[[f32; BLOCK]; 4]; BLOCK],
    cutoff: f32,
    cap: f32,
}

impl<const FORCE_SHIFT: bool> Typed<FORCE_SHIFT> {
    /// Of an interaction with no more than eight types.
    pub fn new(physics: &Physics) -> Self {
        let n = physics.interaction.types.len();
        let table = physics.interaction.typed_table(physics.cutoff());
        let mut rows = [[[0.0; BLOCK]; 4]; BLOCK];
        for (k, c) in table.iter().enumerate() {
            let PairCoefficients { epsilon, sigma, energy_shift, force_shift, .. } = *c;
            for (row, value) in rows[k / n].iter_mut().zip([sigma * sigma, 48.0 * epsilon, energy_shift, force_shift]) {
                row[k % n] = value;
            }
        }
        Self { rows, cutoff: physics.cutoff(), cap: physics.cap }
    }
}

impl<const FORCE_SHIFT: bool> Law for Typed<FORCE_SHIFT> {
    const TYPED: bool = true;

    fn scale(&self) -> f32 {
        1.0
    }

    #[inline(always)]
    fn coefficients<L: Lanes>(&self, lanes: L, i: [u32; 2], j: &[u32; BLOCK]) -> [L::F; 4] {
        let (low, high) = (&self.rows[i[0] as usize % BLOCK], &self.rows[i[1] as usize % BLOCK]);
        [
            lanes.look_up(&low[0], &high[0], j),
            lanes.look_up(&low[1], &high[1], j),
            lanes.look_up(&low[2], &high[2], j),
            lanes.look_up(&low[3], &high[3], j),
        ]
    }

    #[inline(always)]
    fn f_over_r<L: Lanes, const K: usize>(&self, lanes: L, y: &[L::F; K], c: &[[L::F; 4]; K]) -> [L::F; K] {
        let mut out = *y;
        for k in 0..K {
            let s2 = lanes.mul(c[k][0], y[k]);
            let s6 = lanes.mul(lanes.mul(s2, s2), s2);
            let f = lanes.mul(lanes.mul(c[k][1], y[k]), lanes.mul(s6, lanes.sub(s6, lanes.splat(0.5))));
            let f = if FORCE_SHIFT { lanes.sub(f, lanes.mul(c[k][3], lanes.sqrt(y[k]))) } else { f };
            out[k] = lanes.min(f, lanes.splat(self.cap));
        }
        out
    }

    #[inline(always)]
    fn energy<L: Lanes>(&self, lanes: L, y: L::F, r2: L::F, c: &[L::F; 4]) -> L::F {
        let s2 = lanes.mul(c[0], y);
        let s6 = lanes.mul(lanes.mul(s2, s2), s2);
        let u = lanes.mul(lanes.mul(c[1], lanes.splat(1.0 / 12.0)), lanes.mul(s6, lanes.sub(s6, lanes.splat(1.0))));
        let u = lanes.sub(u, c[2]);
        let u =
            if FORCE_SHIFT { lanes.mul_add(lanes.sub(lanes.sqrt(r2), lanes.splat(self.cutoff)), c[3], u) } else { u };
        lanes.min(u, lanes.splat(self.cap))
    }
}

/// How far displacements of pairs are shifted: not at all, by the image of the segment, or by that and what particles
/// have crossed.
const HERE: u8 = 0;
const IMAGE: u8 = 1;
const CROSSED: u8 = 2;

/// Adds the forces of the pairs of `list` to `force`, and where `ENERGY` their energies, virials and number to
/// `energy`, all over the law's scale.
pub(super) struct Kernel<'a, P, const ENERGY: bool> {
    pub law: P,
    pub blocks: &'a Blocks,
    pub list: &'a Pairs,
    pub force: &'a mut [Octet],
    pub energy: &'a mut [Octet],
    /// Scratch: blocks of a segment some of whose particles have crossed a face.
    pub crossed: &'a mut Vec<u32>,
}

/// Sums of a cluster against the blocks of a segment.
struct Sums<L: Lanes> {
    force: [[L::F; 3]; VECTORS],
    energy: [[L::F; 3]; VECTORS],
}

impl<P: Law, const ENERGY: bool> lanes::Kernel for Kernel<'_, P, ENERGY> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { law, blocks, list, force, energy, crossed } = self;
        // Slices of one length need but one test of an index.
        let n = blocks.len();
        let view = View {
            law,
            blocks,
            position: &blocks.position[..n],
            crossed: &blocks.crossed[..n],
            kind: if P::TYPED && !blocks.kind.is_empty() { &blocks.kind[..n] } else { &[] },
            range2: lanes.splat(blocks.cutoff * blocks.cutoff),
        };
        let (force, energy) = (&mut force[..n], if ENERGY { &mut energy[..n] } else { energy });
        for segment in &list.segments {
            let cluster = segment.cluster as usize;
            let (block, at) = (cluster / 2, cluster % 2 * CLUSTER);
            let kinds = if P::TYPED && !view.kind.is_empty() { view.kind[block] } else { [0; BLOCK] };
            let zero = [[lanes.splat(0.0); 3]; VECTORS];
            let mut sums = Sums::<L> { force: zero, energy: zero };
            let mut target = Target {
                quad: Quad::<L>::new(lanes, blocks, view.position, cluster, segment.image),
                kinds: [kinds[at], kinds[at + 1], kinds[at + 2], kinds[at + 3]],
                sums: &mut sums,
                force: &mut *force,
                energy: &mut *energy,
            };
            let listed = &list.blocks[segment.start as usize..segment.end as usize];
            let all = lanes.mask(u16::MAX);
            let [first, second] = if segment.own { own_pairs(cluster) } else { [u16::MAX; VECTORS] };
            let mut pairs = [lanes.mask(first), lanes.mask(second), all, all];
            let mut apart = listed;
            if !view.crossed[block] {
                crossed.clear();
                if segment.image == [0; 3] {
                    view.add_segment::<ENERGY, HERE>(lanes, listed, pairs, &mut target, crossed);
                } else {
                    view.add_segment::<ENERGY, IMAGE>(lanes, listed, pairs, &mut target, crossed);
                }
                (apart, pairs) = (&*crossed, [all; 4]);
            }
            for &j in apart {
                view.add::<2, ENERGY, CROSSED, true>(lanes, [j as usize; 2], pairs, &mut target);
                pairs = [all; 4];
            }
            for axis in 0..3 {
                let of_four = lanes.sum_halves(sums.force[0][axis], sums.force[1][axis]);
                for (to, sum) in force[block].0[axis][at..at + CLUSTER].iter_mut().zip(of_four) {
                    *to -= sum;
                }
                if ENERGY {
                    let of_four = lanes.sum_halves(sums.energy[0][axis], sums.energy[1][axis]);
                    for (to, sum) in energy[block].0[axis][at..at + CLUSTER].iter_mut().zip(of_four) {
                        *to += sum;
                    }
                }
            }
        }
    }
}

/// A cluster and what its pairs are added to.
struct Target<'a, L: Lanes> {
    quad: Quad<L>,
    kinds: [u32; CLUSTER],
    sums: &'a mut Sums<L>,
    force: &'a mut [Octet],
    energy: &'a mut [Octet],
}

/// What the kernel reads.
struct View<'a, P, L: Lanes> {
    law: P,
    blocks: &'a Blocks,
    position: &'a [Octet],
    crossed: &'a [bool],
    kind: &'a [[u32; BLOCK]],
    range2: L::F,
}

impl<P: Law, L: Lanes> View<'_, P, L> {
    /// The pairs of a cluster and the blocks `listed`, of the first of which only those of `pairs` count. Blocks of
    /// which some particle has crossed a face are put into `crossed`. The cluster's own has not.
    #[inline(always)]
    fn add_segment<const ENERGY: bool, const SHIFT: u8>(
        &self,
        lanes: L,
        listed: &[u32],
        pairs: [L::M; 4],
        to: &mut Target<L>,
        crossed: &mut Vec<u32>,
    ) {
        // One block or two, so that what is left is even.
        let (first, others) = listed.split_at(2 - listed.len() % 2);
        let [a, b] = [first[0] as usize, first[first.len() - 1] as usize];
        if self.crossed[a] {
            crossed.extend_from_slice(first);
        } else if a == b || self.crossed[b] {
            self.add::<2, ENERGY, SHIFT, true>(lanes, [a; 2], pairs, to);
            crossed.extend_from_slice(&first[1..]);
        } else {
            self.add::<4, ENERGY, SHIFT, true>(lanes, [a, b], pairs, to);
        }
        for two in others.as_chunks::<2>().0 {
            let [a, b] = [two[0] as usize, two[1] as usize];
            if self.crossed[a] | self.crossed[b] {
                crossed.extend_from_slice(two);
            } else {
                self.add::<4, ENERGY, SHIFT, false>(lanes, [a, b], pairs, to);
            }
        }
    }

    /// The pairs of a cluster and one block (`K` = 2 vectors) or two (`K` = 4): all lanes, or where `MASKED` those of
    /// `pairs`.
    #[inline(always)]
    fn add<const K: usize, const ENERGY: bool, const SHIFT: u8, const MASKED: bool>(
        &self,
        lanes: L,
        j: [usize; 2],
        pairs: [L::M; 4],
        to: &mut Target<L>,
    ) {
        let at = [twice(lanes, &self.position[j[0]]), twice(lanes, &self.position[j[1]])];
        let zero = lanes.splat(0.0);
        let shifts = match SHIFT {
            HERE => [[zero; 3]; VECTORS],
            IMAGE => to.quad.shifts_of_image(),
            _ => to.quad.shifts(lanes, self.blocks, j[0]),
        };
        let mut d = [[zero; 3]; K];
        let (mut r2, mut y, mut c) = ([zero; K], [zero; K], [[zero; 4]; K]);
        let mut inside = [pairs[0]; K];
        for k in 0..K {
            let (v, at) = (k % VECTORS, at[k / VECTORS]);
            d[k] = if SHIFT == HERE {
                to.quad.displacement::<false>(lanes, v, at, &shifts)
            } else {
                to.quad.displacement::<true>(lanes, v, at, &shifts)
            };
        }
        for k in 0..K {
            r2[k] = squared_length(lanes, d[k]);
        }
        for k in 0..K {
            let near = lanes.less(r2[k], self.range2);
            inside[k] = if MASKED { lanes.and(near, pairs[k]) } else { near };
            y[k] = lanes.reciprocal(inside[k], r2[k]);
        }
        for k in 0..K {
            let kinds_i = [to.kinds[k % VECTORS * 2], to.kinds[k % VECTORS * 2 + 1]];
            let kinds_j = if P::TYPED && !self.kind.is_empty() { &self.kind[j[k / VECTORS]] } else { &[0; BLOCK] };
            c[k] = self.law.coefficients(lanes, kinds_i, kinds_j);
        }
        let mut f = self.law.f_over_r(lanes, &y, &c);
        for k in 0..K {
            // What adds up powers of y is zero outside; others must be made so.
            f[k] = if P::TYPED { lanes.keep(inside[k], f[k]) } else { f[k] };
            for axis in 0..3 {
                d[k][axis] = lanes.mul(f[k], d[k][axis]);
            }
        }
        for b in 0..K / VECTORS {
            for axis in 0..3 {
                let both = lanes.add(d[VECTORS * b][axis], d[VECTORS * b + 1][axis]);
                lanes.add_halves(both, &mut to.force[j[b]].0[axis]);
            }
        }
        for k in 0..K {
            for axis in 0..3 {
                let sum = &mut to.sums.force[k % VECTORS][axis];
                *sum = lanes.add(*sum, d[k][axis]);
            }
        }
        if ENERGY {
            for k in 0..K {
                let u = self.law.energy(lanes, y[k], r2[k], &c[k]);
                let terms = [u, lanes.mul(f[k], r2[k]), lanes.splat(1.0)];
                for (of, term) in terms.into_iter().enumerate() {
                    let term = lanes.keep(inside[k], term);
                    let sum = &mut to.sums.energy[k % VECTORS][of];
                    *sum = lanes.add(*sum, term);
                    lanes.add_halves(term, &mut to.energy[j[k / VECTORS]].0[of]);
                }
            }
        }
    }
}
