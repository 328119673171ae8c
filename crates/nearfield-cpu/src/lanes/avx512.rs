//! Lanes as one AVX-512 register.

use super::{Kernel, Lanes};
use pulp::x86::V4;
use pulp::{NullaryFnOnce, cast};
use std::arch::x86_64::{__m256, __m512, __m512i, _CMP_LT_OQ};

/// A kernel to run under AVX-512.
pub(super) struct OnAvx512<K> {
    pub lanes: V4,
    pub kernel: K,
}

impl<K: Kernel> NullaryFnOnce for OnAvx512<K> {
    type Output = K::Output;

    #[inline(always)]
    fn call(self) -> K::Output {
        self.kernel.run(self.lanes)
    }
}

impl Lanes for V4 {
    type F = __m512;
    type U = __m512i;
    type M = u16;

    #[inline(always)]
    fn splat(self, value: f32) -> __m512 {
        self.avx512f._mm512_set1_ps(value)
    }

    #[inline(always)]
    fn load(self, from: &[f32; 16]) -> __m512 {
        cast(*from)
    }

    #[inline(always)]
    fn add(self, a: __m512, b: __m512) -> __m512 {
        self.avx512f._mm512_add_ps(a, b)
    }

    #[inline(always)]
    fn sub(self, a: __m512, b: __m512) -> __m512 {
        self.avx512f._mm512_sub_ps(a, b)
    }

    #[inline(always)]
    fn mul(self, a: __m512, b: __m512) -> __m512 {
        self.avx512f._mm512_mul_ps(a, b)
    }

    #[inline(always)]
    fn mul_add(self, a: __m512, b: __m512, c: __m512) -> __m512 {
        self.avx512f._mm512_fmadd_ps(a, b, c)
    }

    #[inline(always)]
    fn mul_sub(self, a: __m512, b: __m512, c: __m512) -> __m512 {
        self.avx512f._mm512_fmsub_ps(a, b, c)
    }

    #[inline(always)]
    fn max(self, a: __m512, b: __m512) -> __m512 {
        self.avx512f._mm512_max_ps(a, b)
    }

    #[inline(always)]
    fn lt(self, a: __m512, b: __m512) -> u16 {
        self.avx512f._mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b)
    }

    #[inline(always)]
    fn splat_u(self, value: u32) -> __m512i {
        self.avx512f._mm512_set1_epi32(value.cast_signed())
    }

    #[inline(always)]
    fn load_u(self, from: &[u32; 16]) -> __m512i {
        cast(*from)
    }

    #[inline(always)]
    fn ne_u(self, a: __m512i, b: __m512i) -> u16 {
        self.avx512f._mm512_cmpneq_epi32_mask(a, b)
    }

    #[inline(always)]
    fn gt_u(self, a: __m512i, b: __m512i) -> u16 {
        self.avx512f._mm512_cmpgt_epi32_mask(a, b)
    }

    // In a register and then stored whole: the compressing store is microcoded on some processors.
    #[inline(always)]
    fn compress(self, mask: u16, value: __m512, to: &mut [f32; 16]) {
        *to = cast(self.avx512f._mm512_maskz_compress_ps(mask, value));
    }

    #[inline(always)]
    fn compress_u(self, mask: u16, value: __m512i, to: &mut [u32; 16]) {
        *to = cast(self.avx512f._mm512_maskz_compress_epi32(mask, value));
    }

    #[inline(always)]
    fn less(self, a: __m512, b: __m512) -> u16 {
        self.lt(a, b)
    }

    #[inline(always)]
    fn mask(self, bits: u16) -> u16 {
        bits
    }

    #[inline(always)]
    fn and(self, a: u16, b: u16) -> u16 {
        a & b
    }

    #[inline(always)]
    fn keep(self, mask: u16, value: __m512) -> __m512 {
        self.avx512f._mm512_maskz_mov_ps(mask, value)
    }

    #[inline(always)]
    fn min(self, a: __m512, b: __m512) -> __m512 {
        self.avx512f._mm512_min_ps(a, b)
    }

    #[inline(always)]
    fn sqrt(self, a: __m512) -> __m512 {
        self.avx512f._mm512_sqrt_ps(a)
    }

    #[inline(always)]
    fn reciprocal(self, mask: u16, a: __m512) -> __m512 {
        let estimate = self.avx512f._mm512_rcp14_ps(a);
        let correction = self.avx512f._mm512_fnmadd_ps(a, estimate, self.splat(2.0));
        // Masked last: infinity times its estimate, zero, is NaN.
        self.avx512f._mm512_maskz_mul_ps(mask, estimate, correction)
    }

    #[inline(always)]
    fn twice(self, half: &[f32; 8]) -> __m512 {
        cast(self.avx512f._mm512_broadcast_f64x4(cast(*half)))
    }

    #[inline(always)]
    fn halves(self, low: f32, high: f32) -> __m512 {
        let low = self.avx512f._mm512_set1_ps(low);
        self.avx512f._mm512_mask_mov_ps(low, 0xff00, self.avx512f._mm512_set1_ps(high))
    }

    #[inline(always)]
    fn quarters(self, four: &[f32; 4]) -> [__m512; 2] {
        let four = self.avx512f._mm512_castps128_ps512(cast(*four));
        let first = cast([0u32, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1]);
        let second = cast([2u32, 2, 2, 2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3]);
        [self.avx512f._mm512_permutexvar_ps(first, four), self.avx512f._mm512_permutexvar_ps(second, four)]
    }

    #[inline(always)]
    fn add_halves(self, a: __m512, to: &mut [f32; 8]) {
        let low = self.avx512f._mm512_castps512_ps256(a);
        let high: __m256 = cast(self.avx512f._mm512_extractf64x4_pd::<1>(cast(a)));
        *to = cast(self.avx._mm256_add_ps(cast(*to), self.avx._mm256_add_ps(low, high)));
    }

    #[inline(always)]
    fn sum_halves(self, a: __m512, b: __m512) -> [f32; 4] {
        let f = self.avx512f;
        // In each quarter: pairs of a, pairs of b; then their sums, each twice.
        let pairs =
            f._mm512_add_ps(f._mm512_shuffle_ps::<0b01_00_01_00>(a, b), f._mm512_shuffle_ps::<0b11_10_11_10>(a, b));
        let quarters = f._mm512_add_ps(pairs, f._mm512_permute_ps::<0b10_11_00_01>(pairs));
        let halves = f._mm512_add_ps(quarters, f._mm512_shuffle_f32x4::<0b10_11_00_01>(quarters, quarters));
        let first = cast([0u32, 8, 2, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
        cast(f._mm512_castps512_ps128(f._mm512_permutexvar_ps(first, halves)))
    }

    #[inline(always)]
    fn look_up(self, low: &[f32; 8], high: &[f32; 8], index: &[u32; 8]) -> __m512 {
        let low = self.avx512f._mm512_castpd256_pd512(cast(*low));
        let table = cast(self.avx512f._mm512_insertf64x4::<1>(low, cast(*high)));
        let index = cast(self.avx512f._mm512_broadcast_f64x4(cast(*index)));
        // Entries 8 to 15 are the upper lanes'.
        let upper = self.avx512f._mm512_maskz_set1_epi32(0xff00, 8);
        self.avx512f._mm512_permutexvar_ps(self.avx512f._mm512_or_si512(index, upper), table)
    }
}
