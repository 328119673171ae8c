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
    fn compress(self, mask: u16, value: [f32; 16], to: &mut [f32; 16]) {
        compress(mask, value, to);
    }

    #[inline(always)]
    fn compress_u(self, mask: u16, value: [u32; 16], to: &mut [u32; 16]) {
        compress(mask, value, to);
    }
}
