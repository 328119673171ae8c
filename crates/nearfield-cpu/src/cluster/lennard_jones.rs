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

    /// `-(1/r) dU/dr` from `y` = 1 / r².
    fn f_over_r<L: Lanes>(&self, lanes: L, y: L::F, c: &[L::F; 4]) -> L::F;

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
            && physics.cutoff() <= 100.0
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
    fn f_over_r<L: Lanes>(&self, lanes: L, y: L::F, c: &[L::F; 4]) -> L::F {
        let y2 = lanes.mul(y, y);
        let y3 = lanes.mul(y2, y);
        lanes.mul(lanes.sub(y3, c[0]), lanes.mul(y2, y2))
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
        let [low, high] = i.map(|kind| &self.rows[kind as usize % BLOCK]);
        let row = |k: usize| lanes.look_up(&low[k], &high[k], j);
        [row(0), row(1), row(2), row(3)]
    }

    #[inline(always)]
    fn f_over_r<L: Lanes>(&self, lanes: L, y: L::F, c: &[L::F; 4]) -> L::F {
        let s2 = lanes.mul(c[0], y);
        let s6 = lanes.mul(lanes.mul(s2, s2), s2);
        let f = lanes.mul(lanes.mul(c[1], y), lanes.mul(s6, lanes.sub(s6, lanes.splat(0.5))));
        let f = if FORCE_SHIFT { lanes.sub(f, lanes.mul(c[3], lanes.sqrt(y))) } else { f };
        lanes.min(f, lanes.splat(self.cap))
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

/// Adds the forces of the pairs of `list` to `force`, and where `ENERGY` their energies, virials and number to
/// `energy`, all over the law's scale.
pub(super) struct Kernel<'a, P, const ENERGY: bool> {
    pub law: P,
    pub blocks: &'a Blocks,
    pub list: &'a Pairs,
    pub force: &'a mut [Octet],
    pub energy: &'a mut [Octet],
}

/// Sums of a cluster against the blocks of a segment.
struct Sums<L: Lanes> {
    force: [[L::F; 3]; VECTORS],
    energy: [[L::F; 3]; VECTORS],
}

impl<P: Law, const ENERGY: bool> lanes::Kernel for Kernel<'_, P, ENERGY> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let (blocks, list) = (self.blocks, self.list);
        for segment in &list.segments {
            let cluster = segment.cluster as usize;
            let (block, at) = (cluster / 2, cluster % 2 * CLUSTER);
            let quad = Quad::<L>::new(lanes, blocks, cluster, segment.image);
            let kinds = if P::TYPED && !blocks.kind.is_empty() { blocks.kind[block] } else { [0; BLOCK] };
            let kinds: [u32; CLUSTER] = [kinds[at], kinds[at + 1], kinds[at + 2], kinds[at + 3]];
            let zero = [[lanes.splat(0.0); 3]; VECTORS];
            let mut sums = Sums::<L> { force: zero, energy: zero };
            let with_images = segment.image != [0; 3] || blocks.crossed[block];
            let mut listed = &list.blocks[segment.start as usize..segment.end as usize];
            if segment.own {
                let pairs = own_pairs(cluster).map(|mask| lanes.mask(mask));
                self.add::<L, true>(lanes, &quad, &kinds, listed[0] as usize, pairs, &mut sums);
                listed = &listed[1..];
            }
            let all = [lanes.mask(u16::MAX); VECTORS];
            for &j in listed {
                let j = j as usize;
                if with_images || blocks.crossed[j] {
                    self.add::<L, true>(lanes, &quad, &kinds, j, all, &mut sums);
                } else {
                    self.add::<L, false>(lanes, &quad, &kinds, j, all, &mut sums);
                }
            }
            for v in 0..VECTORS {
                for axis in 0..3 {
                    let [low, high] = lanes.sum_halves(sums.force[v][axis]);
                    let to = &mut self.force[block].0[axis];
                    to[at + 2 * v] -= low;
                    to[at + 2 * v + 1] -= high;
                    if ENERGY {
                        let [low, high] = lanes.sum_halves(sums.energy[v][axis]);
                        let to = &mut self.energy[block].0[axis];
                        to[at + 2 * v] += low;
                        to[at + 2 * v + 1] += high;
                    }
                }
            }
        }
    }
}

impl<P: Law, const ENERGY: bool> Kernel<'_, P, ENERGY> {
    /// The pairs of a cluster and block `j`. Without `GENERAL` none has an image, and all lanes are pairs.
    #[inline(always)]
    fn add<L: Lanes, const GENERAL: bool>(
        &mut self,
        lanes: L,
        quad: &Quad<L>,
        kinds: &[u32; CLUSTER],
        j: usize,
        pairs: [L::M; VECTORS],
        sums: &mut Sums<L>,
    ) {
        let blocks = self.blocks;
        let at = twice(lanes, &blocks.position[j]);
        let crossings = if GENERAL { twice(lanes, &blocks.crossings[j]) } else { at };
        let kinds_j = if P::TYPED && !blocks.kind.is_empty() { &blocks.kind[j] } else { &[0; BLOCK] };
        let range2 = lanes.splat(blocks.cutoff * blocks.cutoff);
        let zero = lanes.splat(0.0);
        let (mut force, mut energy) = ([zero; 3], [zero; 3]);
        for v in 0..VECTORS {
            let d = quad.displacement::<GENERAL>(lanes, v, at, crossings);
            let r2 = squared_length(lanes, d);
            let inside = lanes.less(r2, range2);
            let inside = if GENERAL { lanes.and(inside, pairs[v]) } else { inside };
            let y = lanes.reciprocal(inside, r2);
            let c = self.law.coefficients(lanes, [kinds[2 * v], kinds[2 * v + 1]], kinds_j);
            let f = self.law.f_over_r(lanes, y, &c);
            // One that adds up powers of y is zero outside; others must be made so.
            let f = if P::TYPED { lanes.keep(inside, f) } else { f };
            for axis in 0..3 {
                let along = lanes.mul(f, d[axis]);
                sums.force[v][axis] = lanes.add(sums.force[v][axis], along);
                force[axis] = if v == 0 { along } else { lanes.add(force[axis], along) };
            }
            if ENERGY {
                let u = self.law.energy(lanes, y, r2, &c);
                for (k, value) in [u, lanes.mul(f, r2), lanes.splat(1.0)].into_iter().enumerate() {
                    let value = lanes.keep(inside, value);
                    sums.energy[v][k] = lanes.add(sums.energy[v][k], value);
                    energy[k] = lanes.add(energy[k], value);
                }
            }
        }
        for axis in 0..3 {
            lanes.add_halves(force[axis], &mut self.force[j].0[axis]);
            if ENERGY {
                lanes.add_halves(energy[axis], &mut self.energy[j].0[axis]);
            }
        }
    }
}
