//! The pencils around a group of queries, kept for the groups after it: those of one pencil have the same around them.

use super::Grid;
use super::layout::{Pencil, numbers};
use crate::lanes::{Isa, Kernel, Lanes};
use crate::{GroupBox, LANES, Run};
use nearfield_core::predicate::conservative_range;

/// What is around a group of queries, for whoever searches for one group after the other. It belongs to one structure as it
/// is: a new one begins with [`Vicinity::default`] or [`Vicinity::clear`].
#[derive(Clone, Debug, Default)]
pub struct Vicinity {
    /// Where groups have no other pencils within reach than these.
    area: Option<Area>,
    pencils: Vec<Around>,
    n: usize,
}

/// Groups that lie within `lo` and `hi` across x, and whose radius and coordinates are no larger.
#[derive(Clone, Copy, Debug)]
struct Area {
    lo: [f32; 2],
    hi: [f32; 2],
    radius: f32,
    extent: f32,
    /// The pencil in the middle.
    pencil: Option<usize>,
}

impl Area {
    fn holds(&self, group: &GroupBox, extent: f32) -> bool {
        let inside = |axis: usize| self.lo[axis] <= group.lo[axis + 1] && group.hi[axis + 1] <= self.hi[axis];
        inside(0) && inside(1) && group.radius <= self.radius && extent <= self.extent
    }
}

/// Sixteen pencils, each where an image along y and z puts it.
#[derive(Clone, Copy, Debug)]
struct Around {
    /// Least and largest y and z.
    y: [[f32; LANES]; 2],
    z: [[f32; LANES]; 2],
    x0: [f32; LANES],
    cells_per_length: [f32; LANES],
    /// Largest radius of the class.
    largest: [f32; LANES],
    cells: [u32; LANES],
    n_cells: [u32; LANES],
    image: [[i8; 2]; LANES],
}

impl Around {
    const NONE: Self = Self {
        y: [[0.0; LANES]; 2],
        z: [[0.0; LANES]; 2],
        x0: [0.0; LANES],
        cells_per_length: [0.0; LANES],
        largest: [0.0; LANES],
        cells: [0; LANES],
        n_cells: [0; LANES],
        image: [[0; 2]; LANES],
    };
}

impl Vicinity {
    /// Forgets what it holds.
    pub fn clear(&mut self) {
        self.area = None;
    }

    fn push(&mut self, pencil: &Pencil, next: &Pencil, largest: f32, image: [i8; 2], shift: [f32; 2]) {
        if self.n.is_multiple_of(LANES) {
            self.pencils.push(Around::NONE);
        }
        let (to, k) = (&mut self.pencils[self.n / LANES], self.n % LANES);
        for end in 0..2 {
            to.y[end][k] = pencil.y[end] + shift[0];
            to.z[end][k] = pencil.z[end] + shift[1];
        }
        (to.x0[k], to.cells_per_length[k], to.largest[k]) = (pencil.x0, pencil.cells_per_length, largest);
        (to.cells[k], to.n_cells[k], to.image[k]) = (pencil.cells, next.cells - pencil.cells, image);
        self.n += 1;
    }
}

/// [`Grid::find_runs`].
struct Search<'a> {
    grid: &'a Grid,
    group: &'a GroupBox,
    from: u32,
    vicinity: &'a mut Vicinity,
    out: &'a mut Vec<Run>,
}

impl Kernel for Search<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        self.grid.find_runs(lanes, self.group, self.from, self.vicinity, self.out);
    }
}

impl Grid {
    /// As [`Grid::find_runs`], for callers that are not compiled for an instruction set.
    pub(crate) fn find_runs_from(&self, group: &GroupBox, from: u32, vicinity: &mut Vicinity, out: &mut Vec<Run>) {
        Isa::detect().run(Search { grid: self, group, from, vicinity, out });
    }

    /// Appends the runs of `group`, without those that end before slot `from`: see [`crate::Structure::runs`].
    #[inline(always)]
    pub(crate) fn find_runs<L: Lanes>(
        &self,
        lanes: L,
        group: &GroupBox,
        from: u32,
        vicinity: &mut Vicinity,
        out: &mut Vec<Run>,
    ) {
        let extent = self.extent_with(group);
        if !vicinity.area.is_some_and(
            #[inline(always)]
            |area| area.holds(group, extent),
        ) {
            self.look_around(group, extent, vicinity);
        }
        let images = self.images_in_reach(0, group, self.farthest(group.radius, extent));
        for &image in images.iter() {
            self.select(lanes, group, image, extent, from, vicinity, out);
        }
    }

    /// The runs that are seen in one image along x.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "the innermost part of a search")]
    fn select<L: Lanes>(
        &self,
        lanes: L,
        group: &GroupBox,
        image: i8,
        extent: f32,
        from: u32,
        vicinity: &Vicinity,
        out: &mut Vec<Run>,
    ) {
        let shift = f32::from(image) * self.period[0];
        let lo = [lanes.splat(group.lo[0] - shift), lanes.splat(group.lo[1]), lanes.splat(group.lo[2])];
        let hi = [lanes.splat(group.hi[0] - shift), lanes.splat(group.hi[1]), lanes.splat(group.hi[2])];
        let radius = lanes.splat(group.radius);
        let slack = [lanes.splat(conservative_range(1.0, 0.0)), lanes.splat(conservative_range(0.0, extent))];
        let (zero, most) = (lanes.splat(0.0), lanes.splat(f32::MAX / 4.0));
        for (c, around) in vicinity.pencils.iter().enumerate() {
            let y = lanes.max(lanes.sub(lanes.load(&around.y[0]), hi[1]), lanes.sub(lo[1], lanes.load(&around.y[1])));
            let z = lanes.max(lanes.sub(lanes.load(&around.z[0]), hi[2]), lanes.sub(lo[2], lanes.load(&around.z[1])));
            let (y, z) = (lanes.max(y, zero), lanes.max(z, zero));
            let distance2 = lanes.mul_add(y, y, lanes.mul(z, z));
            let reach = lanes.mul_add(lanes.max(radius, lanes.load(&around.largest)), slack[0], slack[1]);
            let reach2 = lanes.mul(reach, reach);
            // Where both are infinite the root is NaN, and the whole pencil is near.
            let half_length = lanes.min(lanes.sqrt(lanes.sub(reach2, distance2)), most);
            let (least, to) = (lanes.sub(lo[0], half_length), lanes.add(hi[0], half_length));
            let (x0, per_length) = (lanes.load(&around.x0), lanes.load(&around.cells_per_length));
            let begins = numbers(lanes, least, x0, per_length);
            let ends = numbers(lanes, to, x0, per_length);
            let held = (1u32 << (vicinity.n - c * LANES).min(LANES)) - 1;
            let mut near = held as u16 & !lanes.lt(reach2, distance2) & !lanes.lt(to, x0);
            while near != 0 {
                let k = near.trailing_zeros() as usize;
                near &= near - 1;
                let (first, n) = (around.cells[k] as usize, around.n_cells[k]);
                if begins[k] > n {
                    continue;
                }
                let start = self.cells[first + begins[k].min(n - 1) as usize];
                let end = self.cells[first + ends[k].min(n - 1) as usize + 1];
                if start == end || end <= from {
                    continue;
                }
                let image = [image, around.image[k][0], around.image[k][1]];
                match out.last_mut() {
                    Some(last) if last.end == start && last.image == image => last.end = end,
                    _ => out.push(Run { start, end, image }),
                }
            }
        }
    }

    /// Fills `vicinity` for `group` and for groups of the same pencil.
    fn look_around(&self, group: &GroupBox, extent: f32, vicinity: &mut Vicinity) {
        let area = self.area_around(group, extent, vicinity.area);
        vicinity.area = Some(area);
        vicinity.pencils.clear();
        vicinity.n = 0;
        let ([y0, z0], [y1, z1]) = (area.lo, area.hi);
        let all = GroupBox { lo: [group.lo[0], y0, z0], hi: [group.hi[0], y1, z1], radius: area.radius };
        self.for_each_image(&all, self.farthest(area.radius, area.extent), |image, bounds| {
            // Those along x are each group's own.
            if image[0] != 0 {
                return;
            }
            let image = [image[1], image[2]];
            let shift = std::array::from_fn(|axis| f32::from(image[axis]) * self.period[axis + 1]);
            for layout in &self.layouts {
                let reach = conservative_range(area.radius.max(layout.largest), area.extent);
                self.for_each_pencil(layout, bounds, reach, |p| {
                    vicinity.push(&self.pencils[p], &self.pencils[p + 1], layout.largest, image, shift);
                });
            }
        });
    }

    /// The area of the pencil that `group` lies in: the narrowest that is not much narrower than the group. What was the
    /// area before is added where it was the same pencil's, so that groups that lie across its bounds come to be inside.
    fn area_around(&self, group: &GroupBox, extent: f32, before: Option<Area>) -> Area {
        let across = |lo: [f32; 2], hi: [f32; 2]| [hi[0] - lo[0], hi[1] - lo[1]];
        let (lo, hi) = ([group.lo[1], group.lo[2]], [group.hi[1], group.hi[2]]);
        let [width, height] = across(lo, hi);
        let mut area = Area { lo, hi, radius: group.radius, extent, pencil: None };
        let mut least = f32::INFINITY;
        for layout in &self.layouts {
            let p = layout.pencil_of(0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1]));
            let pencil = &self.pencils[p];
            let (from, to) = ([pencil.y[0], pencil.z[0]], [pencil.y[1], pencil.z[1]]);
            let [w, h] = across(from, to);
            if pencil.slots < self.pencils[p + 1].slots && w >= 0.5 * width && h >= 0.5 * height && w * h < least {
                least = w * h;
                area.lo = std::array::from_fn(|axis| lo[axis].min(from[axis]));
                area.hi = std::array::from_fn(|axis| hi[axis].max(to[axis]));
                area.radius = group.radius.max(layout.largest);
                area.pencil = Some(p);
            }
        }
        if let Some(before) = before.filter(|before| before.pencil.is_some() && before.pencil == area.pencil) {
            area.lo = std::array::from_fn(|axis| area.lo[axis].min(before.lo[axis]));
            area.hi = std::array::from_fn(|axis| area.hi[axis].max(before.hi[axis]));
            area.radius = area.radius.max(before.radius);
            area.extent = area.extent.max(before.extent);
        }
        area
    }
}
