//! Lanes as two AVX2 registers.

use super::Lanes;
use pulp::{cast, x86::V3};
use std::arch::x86_64::{__m256, __m256i, _CMP_LT_OQ};

/// For each mask of eight lanes, the permutation that brings its lanes to the front.
static FRONT: [[u32; 8]; 256] = {
    let mut table = [[0; 8]; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut lane, mut at) = (0, 0);
        while lane < 8 {
            if mask >> lane & 1 == 1 {
                table[mask][at] = lane as u32;
                at += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    table
};

#[inline(always)]
fn both<T: Copy, R>(a: [T; 2], b: [T; 2], op: impl Fn(T, T) -> R) -> [R; 2] {
    [op(a[0], b[0]), op(a[1], b[1])]
}

#[inline(always)]
fn compress_halves(v3: V3, mask: u16, value: [__m256i; 2]) -> ([u32; 8], usize, [u32; 8]) {
    let [low, high] = mask.to_le_bytes();
    let front = |half: u8, value| {
        cast::<__m256i, [u32; 8]>(v3.avx2._mm256_permutevar8x32_epi32(value, cast(FRONT[usize::from(half)])))
    };
    (front(low, value[0]), low.count_ones() as usize, front(high, value[1]))
}

/// In each half, the sums of two pairs of `a` and of two of `b`.
#[inline(always)]
fn sum_pairs(v3: V3, a: __m256, b: __m256) -> __m256 {
    let v = v3.avx;
    v._mm256_add_ps(v._mm256_shuffle_ps::<0b10_00_10_00>(a, b), v._mm256_shuffle_ps::<0b11_01_11_01>(a, b))
}

impl Lanes for V3 {
    type F = [__m256; 2];
    type U = [__m256i; 2];
    type M = [__m256; 2];

    #[inline(always)]
    fn splat(self, value: f32) -> [__m256; 2] {
        [self.avx._mm256_set1_ps(value); 2]
    }

    #[inline(always)]
    fn load(self, from: &[f32; 16]) -> [__m256; 2] {
        cast(*from)
    }

    #[inline(always)]
    fn add(self, a: [__m256; 2], b: [__m256; 2]) -> [__m256; 2] {
        both(a, b, |a, b| self.avx._mm256_add_ps(a, b))
    }

    #[inline(always)]
    fn sub(self, a: [__m256; 2], b: [__m256; 2]) -> [__m256; 2] {
        both(a, b, |a, b| self.avx._mm256_sub_ps(a, b))
    }

    #[inline(always)]
    fn mul(self, a: [__m256; 2], b: [__m256; 2]) -> [__m256; 2] {
        both(a, b, |a, b| self.avx._mm256_mul_ps(a, b))
    }

    #[inline(always)]
    fn mul_add(self, a: [__m256; 2], b: [__m256; 2], c: [__m256; 2]) -> [__m256; 2] {
        [self.fma._mm256_fmadd_ps(a[0], b[0], c[0]), self.fma._mm256_fmadd_ps(a[1], b[1], c[1])]
    }

    #[inline(always)]
    fn mul_sub(self, a: [__m256; 2], b: [__m256; 2], c: [__m256; 2]) -> [__m256; 2] {
        [self.fma._mm256_fmsub_ps(a[0], b[0], c[0]), self.fma._mm256_fmsub_ps(a[1], b[1], c[1])]
    }

    #[inline(always)]
    fn max(self, a: [__m256; 2], b: [__m256; 2]) -> [__m256; 2] {
        both(a, b, |a, b| self.avx._mm256_max_ps(a, b))
    }

    #[inline(always)]
    fn lt(self, a: [__m256; 2], b: [__m256; 2]) -> u16 {
        u16::from_le_bytes(both(a, b, |a, b| {
            self.avx._mm256_movemask_ps(self.avx._mm256_cmp_ps::<_CMP_LT_OQ>(a, b)) as u8
        }))
    }

    #[inline(always)]
    fn splat_u(self, value: u32) -> [__m256i; 2] {
        [self.avx._mm256_set1_epi32(value.cast_signed()); 2]
    }

    #[inline(always)]
    fn load_u(self, from: &[u32; 16]) -> [__m256i; 2] {
        cast(*from)
    }

    #[inline(always)]
    fn ne_u(self, a: [__m256i; 2], b: [__m256i; 2]) -> u16 {
        !u16::from_le_bytes(both(a, b, |a, b| {
            self.avx._mm256_movemask_ps(cast(self.avx2._mm256_cmpeq_epi32(a, b))) as u8
        }))
    }

    #[inline(always)]
    fn gt_u(self, a: [__m256i; 2], b: [__m256i; 2]) -> u16 {
        u16::from_le_bytes(both(a, b, |a, b| {
            self.avx._mm256_movemask_ps(cast(self.avx2._mm256_cmpgt_epi32(a, b))) as u8
        }))
    }

    #[inline(always)]
    fn truncate(self, a: [__m256; 2]) -> [__m256i; 2] {
        [self.avx._mm256_cvttps_epi32(a[0]), self.avx._mm256_cvttps_epi32(a[1])]
    }

    #[inline(always)]
    fn compress(self, mask: u16, value: [__m256; 2], to: &mut [f32; 16]) {
        let (low, n_low, high) = compress_halves(self, mask, value.map(cast));
        to[..8].copy_from_slice(&low.map(f32::from_bits));
        to[n_low..n_low + 8].copy_from_slice(&high.map(f32::from_bits));
    }

    #[inline(always)]
    fn compress_u(self, mask: u16, value: [__m256i; 2], to: &mut [u32; 16]) {
        let (low, n_low, high) = compress_halves(self, mask, value);
        to[..8].copy_from_slice(&low);
        to[n_low..n_low + 8].copy_from_slice(&high);
    }

    #[inline(always)]
    fn less(self, a: [__m256; 2], b: [__m256; 2]) -> [__m256; 2] {
        [self.avx._mm256_cmp_ps::<_CMP_LT_OQ>(a[0], b[0]), self.avx._mm256_cmp_ps::<_CMP_LT_OQ>(a[1], b[1])]
    }

    #[inline(always)]
    fn mask(self, bits: u16) -> [__m256; 2] {
        let lanes: __m256i = cast([1u32, 2, 4, 8, 16, 32, 64, 128]);
        let low = self.avx2._mm256_and_si256(self.avx._mm256_set1_epi32(i32::from(bits)), lanes);
        let high = self.avx2._mm256_and_si256(self.avx._mm256_set1_epi32(i32::from(bits >> 8)), lanes);
        [cast(self.avx2._mm256_cmpeq_epi32(low, lanes)), cast(self.avx2._mm256_cmpeq_epi32(high, lanes))]
    }

    #[inline(always)]
    fn and(self, a: [__m256; 2], b: [__m256; 2]) -> [__m256; 2] {
        [self.avx._mm256_and_ps(a[0], b[0]), self.avx._mm256_and_ps(a[1], b[1])]
    }

    #[inline(always)]
    fn keep(self, mask: [__m256; 2], value: [__m256; 2]) -> [__m256; 2] {
        self.and(mask, value)
    }

    #[inline(always)]
    fn min(self, a: [__m256; 2], b: [__m256; 2]) -> [__m256; 2] {
        [self.avx._mm256_min_ps(a[0], b[0]), self.avx._mm256_min_ps(a[1], b[1])]
    }

    #[inline(always)]
    fn sqrt(self, a: [__m256; 2]) -> [__m256; 2] {
        [self.avx._mm256_sqrt_ps(a[0]), self.avx._mm256_sqrt_ps(a[1])]
    }

    #[inline(always)]
    fn reciprocal(self, mask: [__m256; 2], a: [__m256; 2]) -> [__m256; 2] {
        let two = self.avx._mm256_set1_ps(2.0);
        let estimate = [self.avx._mm256_rcp_ps(a[0]), self.avx._mm256_rcp_ps(a[1])];
        let low = self.avx._mm256_mul_ps(estimate[0], self.fma._mm256_fnmadd_ps(a[0], estimate[0], two));
        let high = self.avx._mm256_mul_ps(estimate[1], self.fma._mm256_fnmadd_ps(a[1], estimate[1], two));
        // Masked last: infinity times its estimate, zero, is NaN.
        self.and(mask, [low, high])
    }

    #[inline(always)]
    fn twice(self, half: &[f32; 8]) -> [__m256; 2] {
        [cast(*half); 2]
    }

    #[inline(always)]
    fn halves(self, low: f32, high: f32) -> [__m256; 2] {
        [self.avx._mm256_set1_ps(low), self.avx._mm256_set1_ps(high)]
    }

    #[inline(always)]
    fn quarters(self, four: &[f32; 4]) -> [[__m256; 2]; 2] {
        [self.halves(four[0], four[1]), self.halves(four[2], four[3])]
    }

    #[inline(always)]
    fn add_to_parts(self, a: [__m256; 2], to: &mut [f32; 16]) {
        let [one, other]: [__m256; 2] = cast(*to);
        *to = cast([self.avx._mm256_add_ps(one, self.avx._mm256_add_ps(a[0], a[1])), other]);
    }

    #[inline(always)]
    fn sum_halves(self, a: [[__m256; 2]; 3], b: [[__m256; 2]; 3]) -> [[f32; 4]; 3] {
        let mut sums = [[0.0; 4]; 3];
        for axis in 0..3 {
            // In each half, the sums of two pairs of each; then half of each.
            let (a, b) = (sum_pairs(self, a[axis][0], a[axis][1]), sum_pairs(self, b[axis][0], b[axis][1]));
            let four = sum_pairs(self, a, b);
            let low = self.avx._mm256_castps256_ps128(four);
            sums[axis] = cast(self.sse._mm_add_ps(low, self.avx._mm256_extractf128_ps::<1>(four)));
        }
        sums
    }

    #[inline(always)]
    fn look_up(self, low: &[f32; 8], high: &[f32; 8], index: &[u32; 8]) -> [__m256; 2] {
        let index = cast(*index);
        [self.avx2._mm256_permutevar8x32_ps(cast(*low), index), self.avx2._mm256_permutevar8x32_ps(cast(*high), index)]
    }
}
