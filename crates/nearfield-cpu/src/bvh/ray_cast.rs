//! Long rays through the tree, the nearer children of a node first: for pictures. Neighbours are found by point rays
//! instead.

use super::{Bvh, tree::Tree};
use crate::{LANES, Slots};
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// A half line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts, \[length\].
    pub origin: [f32; 3],
    /// Where it goes; of length 1.
    pub direction: [f32; 3],
}

impl Bvh {
    /// Calls `visit` with the slots of each leaf whose box `ray` meets within the distance `reach`. Of the children
    /// of a node the nearer ones come first; boxes overlap, so this is not an order of all leaves. The visitor gets the
    /// present reach and returns the new one: shorter once something is hit, negative to stop. Periodic images are not
    /// followed.
    ///
    /// ```
    /// use nearfield_core::{Boundary, Images, SimBox};
    /// use nearfield_cpu::{Bvh, Input, InputRadii, Ray};
    /// let sim_box = SimBox::cubic(10.0, Boundary::Open)?;
    /// let x = [5.0];
    /// let input = Input { sim_box: &sim_box, position: [&x, &x, &x], radii: InputRadii::Uniform(1.0), kind: &[] };
    /// let mut bvh = Bvh::new(Images::Gamma);
    /// bvh.build(&input);
    /// let ray = Ray { origin: [0.0, 5.0, 5.0], direction: [1.0, 0.0, 0.0] };
    /// let mut leaves = 0;
    /// bvh.cast(&ray, f32::INFINITY, |_, _, reach| {
    ///     leaves += 1;
    ///     reach
    /// });
    /// assert_eq!(leaves, 1);
    /// # Ok::<(), nearfield_core::Error>(())
    /// ```
    #[inline]
    pub fn cast(&self, ray: &Ray, reach: f32, visit: impl FnMut(&Slots, Range<usize>, f32) -> f32) {
        self.arch.dispatch(Cast { tree: &self.tree, slots: &self.slots, ray, reach, visit });
    }
}

/// [`Bvh::cast`], compiled for each instruction set.
struct Cast<'a, F> {
    tree: &'a Tree,
    slots: &'a Slots,
    ray: &'a Ray,
    reach: f32,
    visit: F,
}

impl<F: FnMut(&Slots, Range<usize>, f32) -> f32> WithSimd for Cast<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { tree, slots, ray, mut reach, mut visit } = self;
        // A component of zero would make 0 * infinity of a box face that the ray runs in.
        let inverse = ray.direction.map(|d| 1.0 / if d.abs() < 1e-12 { 1e-12_f32.copysign(d) } else { d });
        // The nodes and leaves yet to be entered, nearest last. A level leaves at most 15 behind.
        let mut pending = [(0.0, 0, 0); 8 * LANES];
        let mut n_pending = 0;
        let mut next = tree.top().map(|level| (0.0, level + 1, 0));
        while let Some((distance, height, index)) = next {
            if distance <= reach {
                if height == 0 {
                    reach = visit(slots, index * LANES..(index + 1) * LANES, reach);
                } else {
                    let (entry, mut hits) = tree.node(height - 1, index).entries(ray.origin, inverse, reach);
                    let first = n_pending;
                    while hits != 0 {
                        let lane = hits.trailing_zeros() as usize;
                        hits &= hits - 1;
                        let mut place = n_pending;
                        while place > first && pending[place - 1].0 < entry[lane] {
                            pending[place] = pending[place - 1];
                            place -= 1;
                        }
                        pending[place] = (entry[lane], height - 1, index * LANES + lane);
                        n_pending += 1;
                    }
                }
            }
            next = n_pending.checked_sub(1).map(|last| {
                n_pending = last;
                pending[last]
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Input, InputRadii};
    use nearfield_core::{Boundary, Images, SimBox};
    use rand::{RngExt, SeedableRng};

    /// Whether the ray meets the sphere of the slot.
    fn meets(slots: &Slots, slot: usize, radius: f32, ray: &Ray) -> bool {
        let center = [slots.x[slot], slots.y[slot], slots.z[slot]];
        let to: [f32; 3] = std::array::from_fn(|axis| center[axis] - ray.origin[axis]);
        let along: f32 = (0..3).map(|axis| to[axis] * ray.direction[axis]).sum();
        let off = (0..3).map(|axis| (to[axis] - along * ray.direction[axis]).powi(2)).sum::<f32>();
        along > 0.0 && off < radius * radius
    }

    #[test]
    fn a_ray_visits_every_sphere_that_it_meets_and_the_nearest_leaf_of_a_node_first() {
        let mut random = rand_pcg::Pcg64::seed_from_u64(7);
        let sim_box = SimBox::cubic(10.0, Boundary::Open).unwrap();
        let mut n_compared = 0;
        for n in [1, 16, 300, 5000] {
            let position: [Vec<f32>; 3] =
                std::array::from_fn(|_| (0..n).map(|_| random.random_range(0.0..10.0)).collect());
            let radius = 0.4;
            let position = std::array::from_fn(|axis| position[axis].as_slice());
            let input = Input { sim_box: &sim_box, position, radii: InputRadii::Uniform(radius), kind: &[] };
            let mut bvh = Bvh::new(Images::Gamma);
            bvh.build(&input);
            for axis_ray in 0..60 {
                let mut direction: [f32; 3] = std::array::from_fn(|_| random.random_range(-1.0..1.0));
                if axis_ray < 30 {
                    direction[axis_ray % 3] = 0.0;
                    direction[(axis_ray + 1) % 3] = -0.0;
                }
                let length = direction.iter().map(|d| d * d).sum::<f32>().sqrt();
                let ray = Ray {
                    origin: std::array::from_fn(|_| random.random_range(-5.0..15.0)),
                    direction: direction.map(|d| d / length),
                };
                let (mut found, mut boxes) = (Vec::new(), Vec::new());
                bvh.cast(&ray, f32::INFINITY, |slots, range, reach| {
                    boxes.push(range.start / LANES);
                    found.extend(
                        range
                            .filter(|&s| slots.particle[s] < n && meets(slots, s, radius, &ray))
                            .map(|s| slots.particle[s]),
                    );
                    reach
                });
                let slots = &bvh.slots;
                let expected = (0..slots.particle.len())
                    .filter(|&s| slots.particle[s] < n && meets(slots, s, radius, &ray))
                    .map(|s| slots.particle[s]);
                found.sort_unstable();
                let mut expected: Vec<u32> = expected.collect();
                expected.sort_unstable();
                assert_eq!(found, expected, "{n} particles, {ray:?}");
                let entry = |leaf: &usize| {
                    let bounds = bvh.tree.leaf(*leaf);
                    (0..3).fold(0.0_f32, |entry, axis| {
                        let face = if ray.direction[axis] >= 0.0 { bounds.lo[axis] } else { bounds.hi[axis] };
                        let distance = (face - ray.origin[axis]) / ray.direction[axis];
                        if distance.is_finite() { entry.max(distance) } else { entry }
                    })
                };
                for pair in boxes.windows(2).filter(|pair| pair[0] / LANES == pair[1] / LANES) {
                    let [first, second] = [entry(&pair[0]), entry(&pair[1])];
                    assert!(first <= second + 1e-4, "{n} particles, {ray:?}: {first} before {second}");
                    n_compared += 1;
                }
            }
        }
        assert!(n_compared > 100, "{n_compared} pairs of leaves test little");
    }

    #[test]
    fn a_negative_reach_stops_the_ray() {
        let sim_box = SimBox::cubic(10.0, Boundary::Open).unwrap();
        let x: Vec<f32> = (0..400).map(|i| i as f32 * 0.025).collect();
        let y = [5.0; 400];
        let input = Input { sim_box: &sim_box, position: [&x, &y, &y], radii: InputRadii::Uniform(0.5), kind: &[] };
        let mut bvh = Bvh::new(Images::Gamma);
        bvh.build(&input);
        let ray = Ray { origin: [-1.0, 5.0, 5.0], direction: [1.0, 0.0, 0.0] };
        let mut visited = 0;
        bvh.cast(&ray, f32::INFINITY, |_, _, _| {
            visited += 1;
            -1.0
        });
        assert_eq!(visited, 1);
    }
}
