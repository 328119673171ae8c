//! Lanes as four NEON registers.

use super::Lanes;
use pulp::{aarch64::Neon, cast};
use std::arch::aarch64::{float32x4_t, uint8x16_t, uint8x16x2_t, uint32x4_t};

type F = [float32x4_t; 4];
type U = [uint32x4_t; 4];

/// The bit of each lane in a mask.
const BITS: [[u32; 4]; 4] = {
    let [a, b, c, d] = [1, 1 << 4, 1 << 8, 1 << 12];
    [[a, 2 * a, 4 * a, 8 * a], [b, 2 * b, 4 * b, 8 * b], [c, 2 * c, 4 * c, 8 * c], [d, 2 * d, 4 * d, 8 * d]]
};

/// For each mask of four lanes, the permutation of bytes that brings its lanes to the front, with zeros after them.
static FRONT: [[u8; 16]; 16] = {
    let mut table = [[u8::MAX; 16]; 16];
    let mut mask = 0;
    while mask < 16 {
        let (mut byte, mut at) = (0, 0);
        while byte < 16 {
            if mask >> (byte / 4) & 1 == 1 {
                table[mask][at] = byte as u8;
                at += 1;
            }
            byte += 1;
        }
        mask += 1;
    }
    table
};

// Closures, unlike on other instruction sets: NEON is part of what all code is compiled for.

#[inline(always)]
fn each<T: Copy, R>(a: [T; 4], op: impl Fn(T) -> R) -> [R; 4] {
    [op(a[0]), op(a[1]), op(a[2]), op(a[3])]
}

#[inline(always)]
fn both<A: Copy, B: Copy, R>(a: [A; 4], b: [B; 4], op: impl Fn(A, B) -> R) -> [R; 4] {
    [op(a[0], b[0]), op(a[1], b[1]), op(a[2], b[2]), op(a[3], b[3])]
}

/// The bits of truth values.
#[inline(always)]
fn bits(neon: Neon, mask: U) -> u16 {
    let [a, b, c, d] = both(mask, BITS, |mask, bits| neon.neon.vandq_u32(mask, cast(bits)));
    neon.neon.vaddvq_u32(neon.neon.vorrq_u32(neon.neon.vorrq_u32(a, b), neon.neon.vorrq_u32(c, d))) as u16
}

/// The lanes of the mask next to each other in each quarter, and where each quarter's come.
#[inline(always)]
fn compress_quarters(neon: Neon, mask: u16, value: U) -> [(usize, uint8x16_t); 4] {
    let quarter = |k: u16| {
        let before = mask & ((1 << (4 * k)) - 1);
        let front = FRONT[usize::from(mask >> (4 * k) & 15)];
        (before.count_ones() as usize, neon.neon.vqtbl1q_u8(cast(value[usize::from(k)]), cast(front)))
    };
    [quarter(0), quarter(1), quarter(2), quarter(3)]
}

impl Lanes for Neon {
    type F = F;
    type U = U;
    type M = U;

    #[inline(always)]
    fn splat(self, value: f32) -> F {
        [self.neon.vdupq_n_f32(value); 4]
    }

    #[inline(always)]
    fn load(self, from: &[f32; 16]) -> F {
        cast(*from)
    }

    #[inline(always)]
    fn add(self, a: F, b: F) -> F {
        both(a, b, |a, b| self.neon.vaddq_f32(a, b))
    }

    #[inline(always)]
    fn sub(self, a: F, b: F) -> F {
        both(a, b, |a, b| self.neon.vsubq_f32(a, b))
    }

    #[inline(always)]
    fn mul(self, a: F, b: F) -> F {
        both(a, b, |a, b| self.neon.vmulq_f32(a, b))
    }

    #[inline(always)]
    fn mul_add(self, a: F, b: F, c: F) -> F {
        let v = self.neon;
        let one = |k: usize| v.vfmaq_f32(c[k], a[k], b[k]);
        [one(0), one(1), one(2), one(3)]
    }

    #[inline(always)]
    fn mul_sub(self, a: F, b: F, c: F) -> F {
        self.mul_add(a, b, each(c, |c| self.neon.vnegq_f32(c)))
    }

    #[inline(always)]
    fn max(self, a: F, b: F) -> F {
        both(a, b, |a, b| self.neon.vmaxq_f32(a, b))
    }

    #[inline(always)]
    fn lt(self, a: F, b: F) -> u16 {
        bits(self, self.less(a, b))
    }

    #[inline(always)]
    fn splat_u(self, value: u32) -> U {
        [self.neon.vdupq_n_u32(value); 4]
    }

    #[inline(always)]
    fn load_u(self, from: &[u32; 16]) -> U {
        cast(*from)
    }

    #[inline(always)]
    fn ne_u(self, a: U, b: U) -> u16 {
        !bits(self, both(a, b, |a, b| self.neon.vceqq_u32(a, b)))
    }

    #[inline(always)]
    fn gt_u(self, a: U, b: U) -> u16 {
        bits(self, both(a, b, |a, b| self.neon.vcgtq_u32(a, b)))
    }

    #[inline(always)]
    fn truncate(self, a: F) -> U {
        // Towards minus infinity: the same, as nothing is negative.
        each(a, |a| self.neon.vcvtmq_u32_f32(a))
    }

    #[inline(always)]
    fn compress(self, mask: u16, value: F, to: &mut [f32; 16]) {
        for (at, quarter) in compress_quarters(self, mask, cast(value)) {
            to[at..at + 4].copy_from_slice(&cast::<uint8x16_t, [f32; 4]>(quarter));
        }
    }

    #[inline(always)]
    fn compress_u(self, mask: u16, value: U, to: &mut [u32; 16]) {
        for (at, quarter) in compress_quarters(self, mask, value) {
            to[at..at + 4].copy_from_slice(&cast::<uint8x16_t, [u32; 4]>(quarter));
        }
    }

    #[inline(always)]
    fn less(self, a: F, b: F) -> U {
        both(a, b, |a, b| self.neon.vcltq_f32(a, b))
    }

    #[inline(always)]
    fn mask(self, bits: u16) -> U {
        let bits = self.neon.vdupq_n_u32(u32::from(bits));
        each(BITS, |of_lane| self.neon.vtstq_u32(bits, cast(of_lane)))
    }

    #[inline(always)]
    fn and(self, a: U, b: U) -> U {
        both(a, b, |a, b| self.neon.vandq_u32(a, b))
    }

    #[inline(always)]
    fn keep(self, mask: U, value: F) -> F {
        cast(self.and(mask, cast(value)))
    }

    // NEON's own minimum is NaN where either is.
    #[inline(always)]
    fn min(self, a: F, b: F) -> F {
        both(a, b, |a, b| self.neon.vbslq_f32(self.neon.vcltq_f32(a, b), a, b))
    }

    #[inline(always)]
    fn sqrt(self, a: F) -> F {
        each(a, |a| self.neon.vsqrtq_f32(a))
    }

    #[inline(always)]
    fn reciprocal(self, mask: U, a: F) -> F {
        let v = self.neon;
        // Good to eight bits; each step of Newton's doubles that.
        let refined = |a, y| v.vmulq_f32(y, v.vrecpsq_f32(a, y));
        self.keep(mask, each(a, |a| refined(a, refined(a, v.vrecpeq_f32(a)))))
    }

    #[inline(always)]
    fn twice(self, half: &[f32; 8]) -> F {
        let [low, high] = cast(*half);
        [low, high, low, high]
    }

    #[inline(always)]
    fn halves(self, low: f32, high: f32) -> F {
        let (low, high) = (self.neon.vdupq_n_f32(low), self.neon.vdupq_n_f32(high));
        [low, low, high, high]
    }

    #[inline(always)]
    fn quarters(self, four: &[f32; 4]) -> [F; 2] {
        [self.halves(four[0], four[1]), self.halves(four[2], four[3])]
    }

    #[inline(always)]
    fn add_to_parts(self, a: F, to: &mut [f32; 16]) {
        let v = self.neon;
        let [low, high, others @ ..]: F = cast(*to);
        let (low, high) = (v.vaddq_f32(low, v.vaddq_f32(a[0], a[2])), v.vaddq_f32(high, v.vaddq_f32(a[1], a[3])));
        *to = cast([low, high, others[0], others[1]]);
    }

    #[inline(always)]
    fn sum_halves(self, a: [F; 3], b: [F; 3]) -> [[f32; 4]; 3] {
        let v = self.neon;
        // Each addition of neighbours halves how many values there are.
        let quarters = |a: F| v.vpaddq_f32(v.vpaddq_f32(a[0], a[1]), v.vpaddq_f32(a[2], a[3]));
        [0, 1, 2].map(|axis| cast(v.vpaddq_f32(quarters(a[axis]), quarters(b[axis]))))
    }

    #[inline(always)]
    fn look_up(self, low: &[f32; 8], high: &[f32; 8], index: &[u32; 8]) -> F {
        let v = self.neon;
        // Four bytes of each entry.
        let bytes = |index| v.vmlaq_n_u32(v.vdupq_n_u32(0x0302_0100), index, 0x0404_0404);
        let [first, second]: [uint32x4_t; 2] = cast(*index);
        let [first, second]: [uint8x16_t; 2] = [cast(bytes(first)), cast(bytes(second))];
        let table = |of: &[f32; 8]| {
            let [a, b] = cast(*of);
            uint8x16x2_t(a, b)
        };
        let (low, high) = (table(low), table(high));
        let entry = |table, bytes| cast::<uint8x16_t, float32x4_t>(v.vqtbl2q_u8(table, bytes));
        [entry(low, first), entry(low, second), entry(high, first), entry(high, second)]
    }
}
