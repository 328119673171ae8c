//! Sixteen boxes as a structure of arrays, so that one SIMD compare per face tests them all.
//!
//! Kernels of the tree are plain indexed loops that vectorise where they are inlined under a wider instruction set. They avoid closures
//! and iterator adapters, which the compiler does not promise to inline there.

use crate::LANES;

/// An axis-aligned box `[lo, hi]`; empty when `lo > hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aabb {
    pub lo: [f32; 3],
    pub hi: [f32; 3],
}

impl Aabb {
    /// The box of nothing: overlaps nothing and leaves a union unchanged.
    pub const EMPTY: Self = Self { lo: [f32::INFINITY; 3], hi: [f32::NEG_INFINITY; 3] };

    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "kernels index")]
    pub fn translated(mut self, by: [f32; 3]) -> Self {
        for axis in 0..3 {
            self.lo[axis] += by[axis];
            self.hi[axis] += by[axis];
        }
        self
    }

    /// The box and all within `margin` of it on each axis.
    #[inline(always)]
    pub fn inflated(mut self, margin: f32) -> Self {
        for axis in 0..3 {
            self.lo[axis] -= margin;
            self.hi[axis] += margin;
        }
        self
    }

    pub fn holds(&self, inner: &Self) -> bool {
        (0..3).all(|a| self.lo[a] <= inner.lo[a] && inner.hi[a] <= self.hi[a])
    }

    /// Half the surface area; zero when empty.
    pub fn half_area(&self) -> f64 {
        let [x, y, z] = std::array::from_fn(|a| f64::from((self.hi[a] - self.lo[a]).max(0.0)));
        x * y + y * z + z * x
    }
}

/// The boxes of up to sixteen children; unused lanes hold [`Aabb::EMPTY`].
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    lo: [[f32; LANES]; 3],
    hi: [[f32; LANES]; 3],
}

impl Node {
    pub const EMPTY: Self = Self { lo: [[f32::INFINITY; LANES]; 3], hi: [[f32::NEG_INFINITY; LANES]; 3] };

    #[inline(always)]
    pub fn set(&mut self, lane: usize, child: &Aabb) {
        for axis in 0..3 {
            self.lo[axis][lane] = child.lo[axis];
            self.hi[axis][lane] = child.hi[axis];
        }
    }

    pub fn get(&self, lane: usize) -> Aabb {
        Aabb { lo: self.lo.map(|lanes| lanes[lane]), hi: self.hi.map(|lanes| lanes[lane]) }
    }

    /// The union of the children.
    #[inline(always)]
    pub fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::EMPTY;
        for axis in 0..3 {
            bounds.lo[axis] = smallest(self.lo[axis]);
            bounds.hi[axis] = largest(self.hi[axis]);
        }
        bounds
    }

    /// Bit `l` is set when child `l` overlaps `query`, faces included.
    #[inline(always)]
    pub fn overlap(&self, query: &Aabb) -> u32 {
        let mut hit = [0; LANES];
        for (lane, hit) in hit.iter_mut().enumerate() {
            let inside = (self.lo[0][lane] <= query.hi[0])
                & (self.hi[0][lane] >= query.lo[0])
                & (self.lo[1][lane] <= query.hi[1])
                & (self.hi[1][lane] >= query.lo[1])
                & (self.lo[2][lane] <= query.hi[2])
                & (self.hi[2][lane] >= query.lo[2]);
            *hit = u32::from(inside) << lane;
        }
        let mut mask = 0;
        for bit in hit {
            mask |= bit;
        }
        mask
    }

    /// Bit `l` is set when child `l` overlaps any of `queries`.
    #[inline(always)]
    pub fn overlap_any<const N: usize>(&self, queries: &[Aabb; N]) -> u32 {
        let mut mask = 0;
        for query in queries {
            mask |= self.overlap(query);
        }
        mask
    }

    /// The distances at which a ray from `origin` enters the children, and a bit for each child that it meets within
    /// `reach`. `inverse` is one over its direction, finite on every axis.
    #[inline(always)]
    pub fn entries(&self, origin: [f32; 3], inverse: [f32; 3], reach: f32) -> ([f32; LANES], u32) {
        let (mut near, mut far) = ([0.0; LANES], [reach; LANES]);
        for axis in 0..3 {
            // By direction, not by size of the distances: an empty box must stay one.
            let (enter, exit) =
                if inverse[axis] >= 0.0 { (&self.lo[axis], &self.hi[axis]) } else { (&self.hi[axis], &self.lo[axis]) };
            for lane in 0..LANES {
                let t = (enter[lane] - origin[axis]) * inverse[axis];
                near[lane] = if t > near[lane] { t } else { near[lane] };
                let t = (exit[lane] - origin[axis]) * inverse[axis];
                far[lane] = if t < far[lane] { t } else { far[lane] };
            }
        }
        let mut hit = [0; LANES];
        for lane in 0..LANES {
            hit[lane] = u32::from(near[lane] <= far[lane]) << lane;
        }
        let mut mask = 0;
        for bit in hit {
            mask |= bit;
        }
        (near, mask)
    }
}

/// The smallest of sixteen numbers, none of them NaN, by halving: each step is one SIMD minimum.
#[inline(always)]
pub(super) fn smallest(mut lanes: [f32; LANES]) -> f32 {
    for width in [8, 4, 2, 1] {
        for lane in 0..width {
            lanes[lane] = if lanes[lane] < lanes[lane + width] { lanes[lane] } else { lanes[lane + width] };
        }
    }
    lanes[0]
}

/// The largest of sixteen numbers, none of them NaN.
#[inline(always)]
pub(super) fn largest(mut lanes: [f32; LANES]) -> f32 {
    for width in [8, 4, 2, 1] {
        for lane in 0..width {
            lanes[lane] = if lanes[lane] > lanes[lane + width] { lanes[lane] } else { lanes[lane + width] };
        }
    }
    lanes[0]
}
