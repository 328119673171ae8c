//! The orthorhombic simulation box and its boundaries.

use crate::{Error, Result};
use serde::{Deserialize, Serialize};

/// Names of the axes, for messages.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// What happens at the two faces of one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Boundary {
    /// The box repeats; positions are wrapped into `[lo, hi)`.
    #[default]
    Periodic,
    /// Elastic reflection of position and velocity at both faces.
    Wall,
    /// Nothing: particles may leave, the bounds only inform.
    Open,
}

/// An axis-aligned box `[lo, hi)` with a boundary per axis. Always valid: finite bounds and positive lengths.
///
/// ```
/// use nearfield_core::{Boundary, SimBox};
/// let slab = SimBox::new([0.0; 3], [10.0, 10.0, 30.0], [Boundary::Periodic, Boundary::Periodic, Boundary::Wall])?;
/// assert_eq!(slab.lengths(), [10.0, 10.0, 30.0]);
/// assert_eq!(slab.wrap([-1.0, 25.0, 5.0]), ([9.0, 5.0, 5.0], [-1, 2, 0]));
/// # Ok::<(), nearfield_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimBox {
    lo: [f32; 3],
    hi: [f32; 3],
    boundary: [Boundary; 3],
}

impl SimBox {
    /// A box from its bounds, \[length\].
    ///
    /// # Errors
    /// [`Error::InvalidBox`] when a bound is not finite or a length is not positive.
    pub fn new(lo: [f32; 3], hi: [f32; 3], boundary: [Boundary; 3]) -> Result<Self> {
        for axis in 0..3 {
            let length = hi[axis] - lo[axis];
            if !(lo[axis].is_finite() && hi[axis].is_finite() && length.is_finite() && length > 0.0) {
                return Err(Error::InvalidBox { axis, lo: lo[axis], hi: hi[axis] });
            }
        }
        Ok(Self { lo, hi, boundary })
    }

    /// A cube `[0, length)` with the same boundary on every axis.
    ///
    /// # Errors
    /// As [`SimBox::new`].
    pub fn cubic(length: f32, boundary: Boundary) -> Result<Self> {
        Self::new([0.0; 3], [length; 3], [boundary; 3])
    }

    /// Lower corner, \[length\].
    pub fn lo(&self) -> [f32; 3] {
        self.lo
    }

    /// Upper corner, \[length\].
    pub fn hi(&self) -> [f32; 3] {
        self.hi
    }

    /// Boundary of each axis.
    pub fn boundary(&self) -> [Boundary; 3] {
        self.boundary
    }

    /// Whether the axis is periodic.
    #[inline(always)]
    pub fn is_periodic(&self, axis: usize) -> bool {
        self.boundary[axis] == Boundary::Periodic
    }

    /// Whether any axis is periodic.
    pub fn any_periodic(&self) -> bool {
        (0..3).any(|axis| self.is_periodic(axis))
    }

    /// Edge lengths in f32. Periodic shifts are exact multiples of these.
    #[inline(always)]
    pub fn lengths(&self) -> [f32; 3] {
        std::array::from_fn(|axis| self.hi[axis] - self.lo[axis])
    }

    /// Volume, \[length³\].
    pub fn volume(&self) -> f64 {
        self.lengths().iter().map(|&l| f64::from(l)).product()
    }

    /// The translation of periodic image `image`, \[length\].
    #[inline(always)]
    pub fn shift(&self, image: [i8; 3]) -> [f32; 3] {
        let lengths = self.lengths();
        std::array::from_fn(|axis| f32::from(image[axis]) * lengths[axis])
    }

    /// The images whose particles can be within reach of the box: -1, 0, 1 on periodic axes, 0 elsewhere.
    /// `[0, 0, 0]` comes first.
    pub fn images(&self) -> Vec<[i8; 3]> {
        let range = |axis: usize| if self.is_periodic(axis) { [0i8, -1, 1].as_slice() } else { &[0] };
        let mut images = Vec::new();
        for &x in range(0) {
            for &y in range(1) {
                for &z in range(2) {
                    images.push([x, y, z]);
                }
            }
        }
        images
    }

    /// The position inside `[lo, hi)` on periodic axes, and the box crossings removed: the unwrapped coordinate is
    /// `wrapped + crossings * length`. Other axes are left alone. What is not finite stays so or becomes NaN.
    #[inline]
    pub fn wrap(&self, position: [f32; 3]) -> ([f32; 3], [i32; 3]) {
        let mut wrapped = position;
        let mut crossings = [0; 3];
        for axis in 0..3 {
            if self.is_periodic(axis) && !(position[axis] >= self.lo[axis] && position[axis] < self.hi[axis]) {
                (wrapped[axis], crossings[axis]) = self.wrap_axis(axis, position[axis]);
            }
        }
        (wrapped, crossings)
    }

    fn wrap_axis(&self, axis: usize, value: f32) -> (f32, i32) {
        let (lo, hi) = (f64::from(self.lo[axis]), f64::from(self.hi[axis]));
        let count = ((f64::from(value) - lo) / (hi - lo)).floor();
        let wrapped = (f64::from(value) - count * (hi - lo)) as f32;
        // Rounding to f32 may land on `hi` itself, which is the image of `lo`.
        if wrapped >= self.hi[axis] {
            (self.lo[axis], (count as i32).saturating_add(1))
        } else {
            // Not `max`: that would turn a NaN into `lo` and hide a run that has blown up.
            (if wrapped < self.lo[axis] { self.lo[axis] } else { wrapped }, count as i32)
        }
    }

    /// Fails when `range` reaches beyond half a periodic length: there the nearest image is not the only one.
    ///
    /// # Errors
    /// [`Error::CutoffTooLarge`].
    pub fn check_range(&self, range: f32, particle: Option<usize>) -> Result<()> {
        let lengths = self.lengths();
        for (axis, &length) in lengths.iter().enumerate() {
            if self.is_periodic(axis) && range > length / 2.0 {
                return Err(Error::CutoffTooLarge { cutoff: range, particle, axis, length });
            }
        }
        Ok(())
    }

    /// The most that may be added to a search `range` \[length\] so that no pair is found at two images: with it, the
    /// range is half of the shortest periodic length, less what f32 rounds when the two are added. Infinite where
    /// nothing is periodic, negative where the range itself leaves nothing.
    pub fn room_around(&self, range: f32) -> f32 {
        let lengths = self.lengths();
        (0..3)
            .filter(|&axis| self.is_periodic(axis))
            .map(|axis| 0.5 * lengths[axis] * (1.0 - 4.0 * f32::EPSILON) - range)
            .fold(f32::INFINITY, f32::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_lands_inside_and_counts_crossings() {
        let sim_box = SimBox::cubic(10.0, Boundary::Periodic).unwrap();
        assert_eq!(sim_box.wrap([10.0, -1e-9, 35.0]), ([0.0, 0.0, 5.0], [1, 0, 3]));
        for value in [-1e6f32, -10.0, -1e-30, 0.0, 9.999_999, 10.0, 1e6] {
            let ([x, ..], _) = sim_box.wrap([value, 0.0, 0.0]);
            assert!((0.0..10.0).contains(&x), "{value} wrapped to {x}");
        }
    }

    #[test]
    fn images_are_only_those_of_periodic_axes() {
        let slab = SimBox::new([0.0; 3], [1.0; 3], [Boundary::Periodic, Boundary::Open, Boundary::Wall]).unwrap();
        assert_eq!(slab.images(), [[0, 0, 0], [-1, 0, 0], [1, 0, 0]]);
        assert_eq!(SimBox::cubic(1.0, Boundary::Periodic).unwrap().images().len(), 27);
    }

    #[test]
    fn range_and_room_fit_into_half_of_the_shortest_periodic_length() {
        let boundary = [Boundary::Periodic, Boundary::Wall, Boundary::Periodic];
        for length in [10.0f32, 7.3, 1e-3, 123_456.7] {
            let sim_box = SimBox::new([0.0; 3], [length, 0.1 * length, 2.0 * length], boundary).unwrap();
            for part in [1e-4, 0.1, 0.3, 0.49, 0.499_99] {
                let range = part * length;
                let room = sim_box.room_around(range);
                assert!(room > 0.0 && sim_box.check_range(range + room, None).is_ok(), "{length} {part} {room}");
                assert!((range + room) / length > 0.499_99, "{length} {part} {room}");
            }
            assert!(sim_box.room_around(0.51 * length) < 0.0);
        }
        assert_eq!(SimBox::cubic(1.0, Boundary::Wall).unwrap().room_around(3.0), f32::INFINITY);
    }

    #[test]
    fn bad_bounds_are_refused() {
        for hi in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(matches!(SimBox::cubic(hi, Boundary::Open), Err(Error::InvalidBox { axis: 0, .. })), "{hi}");
        }
    }
}
