//! Width and number of the pencils of each class.

use super::PENCIL_OCCUPANCY;
use super::classes::Class;
use super::survey::Bulk;
use crate::LANES;
use crate::lanes::Lanes;

/// Fewest particles to a pencil on average, which bounds memory where particles cluster.
const LEAST_PER_PENCIL: f64 = 8.0;

/// Part of a pencil that may lack where their number is chosen: a whole number stays so while particles move a little.
const MARGIN: f64 = 0.01;

/// A row of cells along x. What its fields say of space is taken from its particles, so nothing is lost by rounding.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pencil {
    /// First slot.
    pub slots: u32,
    /// First cell.
    pub cells: u32,
    /// Least x.
    pub x0: f32,
    /// Cells per length.
    pub cells_per_length: f32,
    /// Least and largest y.
    pub y: [f32; 2],
    /// Least and largest z.
    pub z: [f32; 2],
}

impl Pencil {
    /// Squared distance from a group to the particles' bounds across x.
    #[inline(always)]
    pub fn distance2(&self, lo: [f32; 3], hi: [f32; 3]) -> f32 {
        let dy = (self.y[0] - hi[1]).max(lo[1] - self.y[1]).max(0.0);
        let dz = (self.z[0] - hi[2]).max(lo[2] - self.z[1]).max(0.0);
        dy * dy + dz * dz
    }
}

/// The cells or pencils, counted from that which begins with `from`, that values are in. They never decrease with the value:
/// what is before the first is in the first, and beyond the last they go on.
#[inline(always)]
pub(super) fn numbers<L: Lanes>(lanes: L, values: L::F, from: L::F, per_length: L::F) -> [u32; LANES] {
    /// Above any number of them.
    const MOST: f32 = (1u32 << 31) as f32 - 128.0;
    let scaled = lanes.mul(lanes.sub(values, from), per_length);
    let mut numbers = [0; LANES];
    let whole = lanes.truncate(lanes.min(lanes.max(scaled, lanes.splat(0.0)), lanes.splat(MOST)));
    lanes.compress_u(u16::MAX, whole, &mut numbers);
    numbers
}

/// The pencils of one class: `n[1]` layers along z of `n[0]` pencils along y.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// Upper limit of the radii of the class.
    pub limit: f32,
    /// Largest radius of the class; zero where queries bring the one radius there is.
    pub largest: f32,
    /// Index of the first pencil.
    pub first: usize,
    /// Pencils along y and z.
    pub n: [usize; 2],
    /// Where they begin; the outermost extend to infinity.
    pub lo: [f32; 2],
    /// Pencils per length.
    pub per_length: [f32; 2],
    /// Longest extent of a group along x.
    pub group_length: f32,
}

impl Layout {
    /// Pencil number along `axis` (0 is y, 1 is z). It never decreases with `value`, rounding included, so the
    /// particles between two values are in the pencils between theirs.
    #[inline(always)]
    pub fn coordinate(&self, axis: usize, value: f32) -> usize {
        (((value - self.lo[axis]) * self.per_length[axis]) as i32).clamp(0, self.n[axis] as i32 - 1) as usize
    }

    /// Pencil of a point, counted from the first pencil of the first class.
    #[inline(always)]
    pub fn pencil_of(&self, y: f32, z: f32) -> usize {
        self.first + self.coordinate(1, z) * self.n[0] + self.coordinate(0, y)
    }

    /// The pencils of points, as [`Layout::pencil_of`].
    #[inline(always)]
    pub fn pencils_of<L: Lanes>(&self, lanes: L, y: &[f32; LANES], z: &[f32; LANES]) -> [u32; LANES] {
        let (first, [ny, nz]) = (self.first as u32, self.n.map(|n| n as u32));
        let (y, z) = (self.coordinates(lanes, 0, y), self.coordinates(lanes, 1, z));
        let mut pencils = [0; LANES];
        for k in 0..LANES {
            pencils[k] = first + z[k].min(nz - 1) * ny + y[k].min(ny - 1);
        }
        pencils
    }

    /// As [`Layout::coordinate`], but that those of points beyond the last pencil go on.
    #[inline(always)]
    fn coordinates<L: Lanes>(&self, lanes: L, axis: usize, values: &[f32; LANES]) -> [u32; LANES] {
        numbers(lanes, lanes.load(values), lanes.splat(self.lo[axis]), lanes.splat(self.per_length[axis]))
    }

    /// Number of pencils.
    pub fn len(&self) -> usize {
        self.n[0] * self.n[1]
    }
}

/// Lays the pencils of every class out, one class after the other.
pub(super) fn plan(classes: &[Class], bulk: &Bulk, out: &mut Vec<Layout>) {
    let lengths = bulk.lengths();
    out.clear();
    let mut first = 0;
    for class in classes {
        // Measured of other samples clustering differs a little, and with other pencils all particles are out of order.
        let clustering = (0.5 * (2.0 * bulk.clustering.log2()).round()).exp2();
        let width = pencil_width(class.n as f64, clustering, lengths);
        let n = [1, 2].map(|axis| ((lengths[axis] / width + MARGIN) as usize).max(1));
        let layout = Layout {
            limit: class.limit,
            largest: class.largest,
            first,
            n,
            lo: [bulk.lo[1], bulk.lo[2]],
            per_length: std::array::from_fn(|a| {
                let per_length = (n[a] as f64 / lengths[a + 1]) as f32;
                if per_length.is_finite() { per_length } else { 0.0 }
            }),
            group_length: (2.5 * width) as f32,
        };
        first += layout.len();
        out.push(layout);
    }
}

/// The width w for which a cube of w holds [`PENCIL_OCCUPANCY`] particles at the density they see, or more where
/// pencils would hold fewer than [`LEAST_PER_PENCIL`]. Axes shorter than w count as w.
fn pencil_width(n: f64, clustering: f64, lengths: [f64; 3]) -> f64 {
    let cubes = n * clustering / PENCIL_OCCUPANCY;
    let mut sorted = lengths;
    sorted.sort_unstable_by(f64::total_cmp);
    let [a, b, c] = sorted;
    let by_volume = (a * b * c / cubes).cbrt();
    let by_area = (b * c / cubes).sqrt();
    let width = if by_volume <= a {
        by_volume
    } else if by_area <= b {
        by_area
    } else {
        c / cubes
    };
    let pencils = (n / LEAST_PER_PENCIL).max(1.0);
    let [_, y, z] = lengths;
    let width = width.max((y * z / pencils).sqrt()).max(y / pencils).max(z / pencils);
    if width > 0.0 && width.is_finite() { width } else { f64::MAX }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pencils_are_bounded_by_the_particles_in_any_box() {
        for lengths in
            [[1e3, 1e3, 1e3], [1e30, 1.0, 1.0], [1.0, 1e30, 1e-30], [0.0, 5.0, 1e9], [0.0; 3], [3.0, 0.0, 0.0]]
        {
            for clustering in [1.0, 1e4] {
                for n in [0usize, 1, 7, 100_000] {
                    let hi = lengths.map(|l| l as f32);
                    let bulk = Bulk { n, lo: [0.0; 3], hi, clustering };
                    let classes = super::super::classes::single(n);
                    let mut layouts = Vec::new();
                    plan(&classes, &bulk, &mut layouts);
                    assert!(layouts[0].len() <= n / 8 + 1, "{lengths:?} {clustering} {n}: {layouts:?}");
                }
            }
        }
    }

    #[test]
    fn a_uniform_cube_has_pencils_of_about_eight_to_a_cube() {
        let width = pencil_width(1e6, 1.0, [1000.0; 3]);
        assert!((width - 20.0).abs() < 1e-9, "{width}");
    }
}
