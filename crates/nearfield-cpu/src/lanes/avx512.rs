//! Lanes as one AVX-512 register.

use super::Lanes;
use pulp::{cast, x86::V4};
use std::arch::x86_64::{__m512, __m512i, _CMP_LT_OQ};

/// In each quarter, the sums of two pairs of `a` and of two of `b`.
#[inline(always)]
fn sum_pairs(v4: V4, a: __m512, b: __m512) -> __m512 {
    let f = v4.avx512f;
    f._mm512_add_ps(f._mm512_shuffle_ps::<0b10_00_10_00>(a, b), f._mm512_shuffle_ps::<0b11_01_11_01>(a, b))
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

    #[inline(always)]
    fn truncate(self, a: __m512) -> __m512i {
        self.avx512f._mm512_cvttps_epi32(a)
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
    fn add_to_parts(self, a: __m512, to: &mut [f32; 16]) {
        *to = cast(self.avx512f._mm512_add_ps(cast(*to), a));
    }

    #[inline(always)]
    fn sum_halves(self, a: [__m512; 3], b: [__m512; 3]) -> [[f32; 4]; 3] {
        let f = self.avx512f;
        // In each quarter: two sums of a, two of b; then x of a, x of b, y of a, y of b, and twice z of a, z of b.
        let [x, y, z] = [sum_pairs(self, a[0], b[0]), sum_pairs(self, a[1], b[1]), sum_pairs(self, a[2], b[2])];
        let (xy, zz) = (sum_pairs(self, x, y), sum_pairs(self, z, z));
        // Quarters: x and y of lanes 0 to 7, of lanes 8 to 15, z of lanes 0 to 7, of lanes 8 to 15.
        let all = f._mm512_add_ps(
            f._mm512_shuffle_f32x4::<0b10_00_10_00>(xy, zz),
            f._mm512_shuffle_f32x4::<0b11_01_11_01>(xy, zz),
        );
        let order = cast([0u32, 4, 1, 5, 2, 6, 3, 7, 8, 12, 9, 13, 0, 0, 0, 0]);
        let sums: [[f32; 4]; 4] = cast(f._mm512_permutexvar_ps(order, all));
        [sums[0], sums[1], sums[2]]
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
