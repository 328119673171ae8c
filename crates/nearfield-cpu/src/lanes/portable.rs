//! Lanes as plain arrays.

use super::Lanes;
use std::array::from_fn;

/// No vector unit assumed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable;

#[inline(always)]
fn mask(lane: impl Fn(usize) -> bool) -> u16 {
    (0..16).fold(0, |mask, k| mask | (u16::from(lane(k)) << k))
}

#[inline(always)]
fn compress<T: Copy>(mask: u16, value: [T; 16], to: &mut [T; 16]) {
    let mut at = 0;
    for (k, &v) in value.iter().enumerate() {
        if mask >> k & 1 == 1 {
            to[at] = v;
            at += 1;
        }
    }
}

impl Lanes for Portable {
    type F = [f32; 16];
    type U = [u32; 16];
    type M = u16;

    #[inline(always)]
    fn splat(self, value: f32) -> [f32; 16] {
        [value; 16]
    }

    #[inline(always)]
    fn load(self, from: &[f32; 16]) -> [f32; 16] {
        *from
    }

    #[inline(always)]
    fn add(self, a: [f32; 16], b: [f32; 16]) -> [f32; 16] {
        from_fn(|k| a[k] + b[k])
    }

    #[inline(always)]
    fn sub(self, a: [f32; 16], b: [f32; 16]) -> [f32; 16] {
        from_fn(|k| a[k] - b[k])
    }

    #[inline(always)]
    fn mul(self, a: [f32; 16], b: [f32; 16]) -> [f32; 16] {
        from_fn(|k| a[k] * b[k])
    }

    #[inline(always)]
    fn mul_add(self, a: [f32; 16], b: [f32; 16], c: [f32; 16]) -> [f32; 16] {
        from_fn(|k| a[k].mul_add(b[k], c[k]))
    }

    #[inline(always)]
    fn mul_sub(self, a: [f32; 16], b: [f32; 16], c: [f32; 16]) -> [f32; 16] {
        from_fn(|k| a[k].mul_add(b[k], -c[k]))
    }

    #[inline(always)]
    fn max(self, a: [f32; 16], b: [f32; 16]) -> [f32; 16] {
        from_fn(|k| a[k].max(b[k]))
    }

    #[inline(always)]
    fn lt(self, a: [f32; 16], b: [f32; 16]) -> u16 {
        mask(|k| a[k] < b[k])
    }

    #[inline(always)]
    fn splat_u(self, value: u32) -> [u32; 16] {
        [value; 16]
    }

    #[inline(always)]
    fn load_u(self, from: &[u32; 16]) -> [u32; 16] {
        *from
    }

    #[inline(always)]
    fn ne_u(self, a: [u32; 16], b: [u32; 16]) -> u16 {
        mask(|k| a[k] != b[k])
    }

    #[inline(always)]
    fn gt_u(self, a: [u32; 16], b: [u32; 16]) -> u16 {
        mask(|k| a[k] > b[k])
    }

    #[inline(always)]
    fn truncate(self, a: [f32; 16]) -> [u32; 16] {
        a.map(|a| a as u32)
    }

    #[inline(always)]
    fn compress(self, mask: u16, value: [f32; 16], to: &mut [f32; 16]) {
        compress(mask, value, to);
    }

    #[inline(always)]
    fn compress_u(self, mask: u16, value: [u32; 16], to: &mut [u32; 16]) {
        compress(mask, value, to);
    }

    #[inline(always)]
    fn less(self, a: [f32; 16], b: [f32; 16]) -> u16 {
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
    fn keep(self, mask: u16, value: [f32; 16]) -> [f32; 16] {
        from_fn(|k| if mask >> k & 1 == 1 { value[k] } else { 0.0 })
    }

    #[inline(always)]
    fn min(self, a: [f32; 16], b: [f32; 16]) -> [f32; 16] {
        from_fn(|k| if a[k] < b[k] { a[k] } else { b[k] })
    }

    #[inline(always)]
    fn sqrt(self, a: [f32; 16]) -> [f32; 16] {
        a.map(f32::sqrt)
    }

    #[inline(always)]
    fn reciprocal(self, mask: u16, a: [f32; 16]) -> [f32; 16] {
        self.keep(mask, a.map(f32::recip))
    }

    #[inline(always)]
    fn twice(self, half: &[f32; 8]) -> [f32; 16] {
        from_fn(|k| half[k % 8])
    }

    #[inline(always)]
    fn halves(self, low: f32, high: f32) -> [f32; 16] {
        from_fn(|k| if k < 8 { low } else { high })
    }

    #[inline(always)]
    fn quarters(self, four: &[f32; 4]) -> [[f32; 16]; 2] {
        [self.halves(four[0], four[1]), self.halves(four[2], four[3])]
    }

    #[inline(always)]
    fn add_to_parts(self, a: [f32; 16], to: &mut [f32; 16]) {
        for k in 0..8 {
            to[k] += a[k] + a[k + 8];
        }
    }

    #[inline(always)]
    fn sum_halves(self, a: [[f32; 16]; 3], b: [[f32; 16]; 3]) -> [[f32; 4]; 3] {
        // In the order of the vector units, so that sums are the same.
        let sum = |a: &[f32; 16], o: usize| {
            let quarter = |o: usize| (a[o] + a[o + 1]) + (a[o + 2] + a[o + 3]);
            quarter(o) + quarter(o + 4)
        };
        from_fn(|k| [sum(&a[k], 0), sum(&a[k], 8), sum(&b[k], 0), sum(&b[k], 8)])
    }

    #[inline(always)]
    fn look_up(self, low: &[f32; 8], high: &[f32; 8], index: &[u32; 8]) -> [f32; 16] {
        from_fn(|k| if k < 8 { low[index[k] as usize & 7] } else { high[index[k - 8] as usize & 7] })
    }
}
