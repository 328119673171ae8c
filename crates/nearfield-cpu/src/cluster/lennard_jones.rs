//! Lennard-Jones by whole vectors: two laws, and the kernel over the inner list.

use super::{
    BLOCK,
    blocks::{Blocks, Octet},
    list::Pairs,
    quad::{self, CLUSTER, Position, Quad, VECTORS, displacement, own_pairs, squared_length, twice},
    sums::Parts,
};
use crate::{
    lanes::{self, Lanes},
    physics::Physics,
    prefetch::prefetch,
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
            y3[k] = lanes.mul_sub(y2[k], y[k], c[k][0]);
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

/// A block is fetched while so many before it in a list are searched, in systems of more blocks than fit the cache of a core
/// with their sums.
const AHEAD: usize = 3;
const CACHED: usize = 1 << 14;

/// Adds the forces of the pairs of `list` to `force`, and where `ENERGY` their energies, virials and number to
/// `energy`, all over the law's scale.
pub(super) struct Kernel<'a, P, const ENERGY: bool> {
    pub law: P,
    pub blocks: &'a Blocks,
    pub list: &'a Pairs,
    pub force: &'a mut [Parts],
    pub energy: &'a mut [Parts],
    /// Scratch: blocks of a segment some of whose particles have crossed a face.
    pub crossed: &'a mut Vec<u32>,
}

impl<P: Law, const ENERGY: bool> lanes::Kernel for Kernel<'_, P, ENERGY> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { law, blocks, list, force, energy, crossed } = self;
        // Slices of one length need but one test of an index.
        let n = blocks.len();
        let view = View {
            lanes,
            law,
            blocks,
            position: &blocks.position[..n],
            crossed: &blocks.crossed[..n],
            kind: if P::TYPED && !blocks.kind.is_empty() { &blocks.kind[..n] } else { &[] },
            range2: lanes.splat(blocks.cutoff * blocks.cutoff),
        };
        let mut to = Target { force: &mut force[..n], energy: if ENERGY { &mut energy[..n] } else { energy } };
        // As many as a segment may have. No calls below: all that is in registers would have to be saved.
        crossed.resize(n, 0);
        let all = [lanes.mask(u16::MAX); VECTORS];
        for segments in list.segments.chunk_by(|a, b| a.cluster == b.cluster) {
            let cluster = segments[0].cluster as usize;
            let (block, at) = (cluster / 2, cluster % 2 * CLUSTER);
            let kinds = if P::TYPED && !view.kind.is_empty() { view.kind[block] } else { [0; BLOCK] };
            let kinds = [kinds[at], kinds[at + 1], kinds[at + 2], kinds[at + 3]];
            // As if somebody else might change it, so that it is read from the cache: registers are for sums.
            let position = quad::position(lanes, &view.position[block], cluster);
            let position = std::hint::black_box(&position);
            // The second cluster of a block has nearly the first one's list, which is in the cache then.
            let ahead = if at == 0 && n > CACHED { AHEAD } else { usize::MAX };
            let zero = [[lanes.splat(0.0); 3]; VECTORS];
            let mut sums = Sums { force: zero, energy: zero };
            for segment in segments {
                let quad = Quad::new(lanes, blocks, cluster, segment.image);
                let of = Four { position, ahead, quad, kinds };
                let listed = &list.blocks[segment.start as usize..segment.end as usize];
                let [first, second] = if segment.own { own_pairs(cluster) } else { [u16::MAX; VECTORS] };
                let pairs = [lanes.mask(first), lanes.mask(second)];
                let mut apart = Apart { blocks: &mut *crossed, n: 0 };
                if view.crossed[block] {
                    sums = view.add_segment::<ENERGY, CROSSED>(&of, listed, pairs, sums, &mut to, &mut apart);
                    continue;
                }
                // Its own block has not crossed either, so `pairs` is for none of those put apart.
                if segment.image == [0; 3] {
                    sums = view.add_segment::<ENERGY, HERE>(&of, listed, pairs, sums, &mut to, &mut apart);
                } else {
                    sums = view.add_segment::<ENERGY, IMAGE>(&of, listed, pairs, sums, &mut to, &mut apart);
                }
                let Apart { blocks, n } = apart;
                if n > 0 {
                    let mut none = Apart { blocks: &mut [], n: 0 };
                    sums = view.add_segment::<ENERGY, CROSSED>(&of, &blocks[..n], all, sums, &mut to, &mut none);
                }
            }
            let force = lanes.sum_halves(sums.force[0], sums.force[1]);
            for (to, of_four) in to.force[block].0.iter_mut().zip(&force) {
                for (to, sum) in to[at..at + CLUSTER].iter_mut().zip(of_four) {
                    *to -= sum;
                }
            }
            if ENERGY {
                let energy = lanes.sum_halves(sums.energy[0], sums.energy[1]);
                for (to, of_four) in to.energy[block].0.iter_mut().zip(&energy) {
                    for (to, sum) in to[at..at + CLUSTER].iter_mut().zip(of_four) {
                        *to += sum;
                    }
                }
            }
        }
    }
}

/// A cluster.
struct Four<'a, L: Lanes> {
    position: &'a Position<L>,
    /// How many blocks on those are that are to be fetched.
    ahead: usize,
    quad: Quad<L>,
    kinds: [u32; CLUSTER],
}

/// Sums of a cluster's particles: handed on by value, to stay in registers.
#[derive(Clone, Copy)]
struct Sums<L: Lanes> {
    force: [[L::F; 3]; VECTORS],
    energy: [[L::F; 3]; VECTORS],
}

/// Blocks of a segment some of whose particles have crossed a face.
struct Apart<'a> {
    blocks: &'a mut [u32],
    n: usize,
}

/// What is added to of the blocks that a cluster is paired with.
struct Target<'a> {
    force: &'a mut [Parts],
    energy: &'a mut [Parts],
}

/// The pairs of a cluster and block `j`: displacements, their squared lengths, which count, and for those 1 / r².
#[derive(Clone, Copy)]
struct Near<L: Lanes> {
    j: usize,
    d: [[L::F; 3]; VECTORS],
    r2: [L::F; VECTORS],
    inside: [L::M; VECTORS],
    y: [L::F; VECTORS],
}

/// What the kernel reads.
struct View<'a, P, L: Lanes> {
    lanes: L,
    law: P,
    blocks: &'a Blocks,
    position: &'a [Octet],
    crossed: &'a [bool],
    kind: &'a [[u32; BLOCK]],
    range2: L::F,
}

impl<P: Law, L: Lanes> View<'_, P, L> {
    /// The pairs of a cluster and the blocks `listed`, of the first of which only those of `pairs` count. Unless `SHIFT`
    /// is for them, blocks of which some particle has crossed a face are put `apart`.
    ///
    /// One block is searched while forces are computed of the one before: neither has to wait for the other.
    #[inline(always)]
    fn add_segment<const ENERGY: bool, const SHIFT: u8>(
        &self,
        of: &Four<L>,
        listed: &[u32],
        pairs: [L::M; VECTORS],
        mut sums: Sums<L>,
        to: &mut Target,
        apart: &mut Apart,
    ) -> Sums<L> {
        let mut listed = listed.iter();
        let Some(j) = self.next::<SHIFT>(&mut listed, apart) else { return sums };
        let mut near = self.search::<SHIFT, true>(of, j, pairs);
        while let Some(j) = self.next::<SHIFT>(&mut listed, apart) {
            if let Some(&ahead) = listed.as_slice().get(of.ahead) {
                prefetch(&self.position[ahead as usize]);
                prefetch(&to.force[ahead as usize]);
            }
            let next = self.search::<SHIFT, false>(of, j, pairs);
            sums = self.add::<ENERGY>(of.kinds, near, sums, to);
            near = next;
        }
        self.add::<ENERGY>(of.kinds, near, sums, to)
    }

    /// See [`View::add_segment`].
    #[inline(always)]
    fn next<const SHIFT: u8>(&self, listed: &mut std::slice::Iter<u32>, apart: &mut Apart) -> Option<usize> {
        loop {
            let j = *listed.next()?;
            if SHIFT == CROSSED || !self.crossed[j as usize] {
                return Some(j as usize);
            }
            apart.blocks[apart.n] = j;
            apart.n += 1;
        }
    }

    /// The pairs of a cluster and block `j` that are within range, where `MASKED` only those of `pairs`.
    #[inline(always)]
    fn search<const SHIFT: u8, const MASKED: bool>(&self, of: &Four<L>, j: usize, pairs: [L::M; VECTORS]) -> Near<L> {
        let lanes = self.lanes;
        let at = twice(lanes, &self.position[j]);
        let shifts = match SHIFT {
            HERE => [at; VECTORS],
            IMAGE => of.quad.shifts_of_image(),
            _ => of.quad.shifts(lanes, self.blocks, j),
        };
        let mut near = Near { j, d: [at; VECTORS], r2: [at[0]; VECTORS], inside: pairs, y: [at[0]; VECTORS] };
        for v in 0..VECTORS {
            near.d[v] = if SHIFT == HERE {
                displacement::<L, false>(lanes, &of.position[v], at, &shifts[v])
            } else {
                displacement::<L, true>(lanes, &of.position[v], at, &shifts[v])
            };
        }
        for v in 0..VECTORS {
            near.r2[v] = squared_length(lanes, near.d[v]);
        }
        for v in 0..VECTORS {
            let inside = lanes.less(near.r2[v], self.range2);
            near.inside[v] = if MASKED { lanes.and(inside, pairs[v]) } else { inside };
            near.y[v] = lanes.reciprocal(near.inside[v], near.r2[v]);
        }
        near
    }

    /// Adds up what pairs do.
    #[inline(always)]
    fn add<const ENERGY: bool>(
        &self,
        kinds: [u32; CLUSTER],
        near: Near<L>,
        mut sums: Sums<L>,
        to: &mut Target,
    ) -> Sums<L> {
        let lanes = self.lanes;
        let Near { j, mut d, r2, inside, y } = near;
        let kinds_j = if P::TYPED && !self.kind.is_empty() { &self.kind[j] } else { &[0; BLOCK] };
        let mut c = [[r2[0]; 4]; VECTORS];
        for v in 0..VECTORS {
            c[v] = self.law.coefficients(lanes, [kinds[2 * v], kinds[2 * v + 1]], kinds_j);
        }
        let mut f = self.law.f_over_r(lanes, &y, &c);
        for v in 0..VECTORS {
            // What adds up powers of y is zero outside; others must be made so.
            f[v] = if P::TYPED { lanes.keep(inside[v], f[v]) } else { f[v] };
            for axis in 0..3 {
                d[v][axis] = lanes.mul(f[v], d[v][axis]);
                sums.force[v][axis] = lanes.add(sums.force[v][axis], d[v][axis]);
            }
        }
        for axis in 0..3 {
            lanes.add_to_parts(lanes.add(d[0][axis], d[1][axis]), &mut to.force[j].0[axis]);
        }
        if ENERGY {
            for v in 0..VECTORS {
                let u = self.law.energy(lanes, y[v], r2[v], &c[v]);
                let terms = [u, lanes.mul(f[v], r2[v]), lanes.splat(1.0)];
                for (of, term) in terms.into_iter().enumerate() {
                    let term = lanes.keep(inside[v], term);
                    sums.energy[v][of] = lanes.add(sums.energy[v][of], term);
                    lanes.add_to_parts(term, &mut to.energy[j].0[of]);
                }
            }
        }
        sums
    }
}
