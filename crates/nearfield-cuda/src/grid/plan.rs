//! Size and number of the cells of each class.

use super::{
    bulk::Bulk,
    classes::{self, Class},
    width::{cube_width, pencil_width},
};
use nearfield_core::SimBox;
use nearfield_kernels::{Float4, layouts::CellClass};

/// Cells along x to the width of a pencil.
const CELLS_PER_WIDTH: f64 = 4.0;

/// Expected neighbours below which most particles have none: cells then hold about one.
pub(crate) const SPARSE: f64 = 1.0;

/// Most cells to a particle, and in any case: where particles cluster, cells are coarser than these would like.
const CELLS_PER_PARTICLE: f64 = 4.0;
const LEAST_CELLS: f64 = 64.0;

/// Ratio of expected neighbours that a sample does not tell from none.
const SIMILAR: f64 = 1.1;

/// Most cells along an axis: kernels compute them in f32.
const MOST_ALONG: f64 = (1 << 22) as f64;

/// What sizes of cells depend on. A plan is right for any positions, but good for those it was made for.
#[derive(Clone, Copy, Debug)]
pub struct Survey<'a> {
    /// Number of particles.
    pub n: usize,
    /// Positions of some of them, with radii in w where they are per particle.
    pub sample: &'a [Float4],
    /// The box.
    pub sim_box: &'a SimBox,
    /// The one cutoff; `None` where radii are per particle.
    pub cutoff: Option<f32>,
    /// The largest radius of all particles.
    pub largest: f32,
}

/// The cells of every class.
#[derive(Clone, Debug, Default)]
pub struct CellPlan {
    /// The classes, by ascending radius; eight at most.
    pub classes: Vec<CellClass>,
    /// Cells of all of them.
    pub n_cells: usize,
    /// What kernels must add to ranges so that roundings lose no candidate, \[length\].
    pub slack: f32,
    /// Expected number of particles within the largest range of one of them.
    pub neighbors: f64,
    /// Whether most particles have no neighbours, and one cutoff serves all pairs.
    pub sparse: bool,
}

impl CellPlan {
    /// Chooses classes and their cells.
    pub fn new(survey: &Survey) -> Self {
        let bulk = Bulk::of(survey.n, survey.sample);
        let classes = match survey.cutoff {
            Some(cutoff) => classes::single(survey.n, cutoff),
            None => classes::divide(survey.sample.iter().map(|p| p.w).collect(), survey.largest, &bulk),
        };
        let neighbors = survey.n as f64 * bulk.share_within(f64::from(survey.largest));
        let sparse = survey.cutoff.is_some() && neighbors < SPARSE;
        let mut plan = Self { slack: slack(&bulk, survey.sim_box), neighbors, sparse, ..Self::default() };
        for class in &classes {
            let shape = if sparse { Shape::cubes(class, &bulk) } else { Shape::pencils(class, &bulk) };
            let cells = lay_out(class, &bulk, shape, plan.n_cells);
            plan.n_cells += cells.n.iter().map(|&n| n as usize).product::<usize>();
            plan.classes.push(cells);
        }
        plan
    }
}

impl CellPlan {
    /// Whether particles have about as many neighbours in as many classes.
    pub(super) fn is_much_as(&self, other: &Self) -> bool {
        let ratio = self.neighbors / other.neighbors;
        self.classes.len() == other.classes.len() && (1.0 / SIMILAR..SIMILAR).contains(&ratio)
    }
}

/// Edges of cells and shifted differences are off by a few roundings of the largest number they come from.
fn slack(bulk: &Bulk, sim_box: &SimBox) -> f32 {
    let (lo, hi, length) = (sim_box.lo(), sim_box.hi(), sim_box.lengths());
    let extent = (0..3).fold(0.0f64, |extent, axis| {
        let of_box = lo[axis].abs().max(hi[axis].abs()).max(length[axis]);
        extent.max(f64::from(of_box)).max(bulk.lo[axis].abs() + bulk.length[axis])
    });
    (8.0 * f64::from(f32::EPSILON) * extent) as f32
}

/// Cells that are so wide along y and z, and the number of them to that length along x.
struct Shape {
    width: f64,
    along_x: f64,
}

impl Shape {
    /// For warps that take several consecutive particles.
    fn pencils(class: &Class, bulk: &Bulk) -> Self {
        let width = pencil_width(class.n * bulk.clustering, bulk.length, f64::from(class.largest));
        Self { width, along_x: CELLS_PER_WIDTH }
    }

    /// For threads that look around one particle each.
    fn cubes(class: &Class, bulk: &Bulk) -> Self {
        Self { width: cube_width(class.n * bulk.clustering, bulk.length), along_x: 1.0 }
    }
}

fn lay_out(class: &Class, bulk: &Bulk, shape: Shape, first_cell: usize) -> CellClass {
    let most = CELLS_PER_PARTICLE * class.n + LEAST_CELLS;
    let mut width = shape.width;
    let along = |width: f64| {
        let n = |length: f64, cell: f64| (length / cell).floor().clamp(1.0, MOST_ALONG);
        let [x, y, z] = bulk.length;
        [n(x, width / shape.along_x), n(y, width), n(z, width)]
    };
    while along(width).iter().product::<f64>() > most {
        width *= 1.25;
    }
    let n = along(width);
    let f32_or_zero = |x: f64| if (x as f32).is_finite() { x as f32 } else { 0.0 };
    CellClass {
        lo: bulk.lo.map(|lo| lo as f32),
        per_length: std::array::from_fn(|a| if n[a] > 1.0 { f32_or_zero(n[a] / bulk.length[a]) } else { 0.0 }),
        width: std::array::from_fn(|a| f32_or_zero(bulk.length[a] / n[a])),
        n: n.map(|n| n as u32),
        unused: 0,
        first_cell: first_cell as u32,
        limit: class.limit,
        largest: class.largest,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_bounded_by_the_particles_in_any_region() {
        for length in
            [[1e3, 1e3, 1e3], [1e30, 1.0, 1.0], [1.0, 1e38, 1e-30], [0.0, 5.0, 1e9], [0.0; 3], [3.0, 0.0, 0.0]]
        {
            for clustering in [1.0, 1e4] {
                for n in [0usize, 1, 7, 100_000] {
                    let bulk = Bulk { n, lo: [0.0; 3], length, clustering };
                    let class = &classes::single(n, 1.0)[0];
                    let cells = lay_out(class, &bulk, Shape::pencils(class, &bulk), 0);
                    let product: usize = cells.n.iter().map(|&n| n as usize).product();
                    assert!(product >= 1 && product <= 4 * n + 64, "{length:?} {clustering} {n}: {cells:?}");
                    assert!(cells.per_length.iter().chain(&cells.width).all(|x| x.is_finite()), "{cells:?}");
                }
            }
        }
    }

    #[test]
    fn points_on_a_line_have_cells_along_it() {
        for axis in 0..3 {
            let mut bulk = Bulk { n: 1_000_000, lo: [0.0; 3], length: [0.0; 3], clustering: 1.0 };
            bulk.length[axis] = 1000.0;
            let class = &classes::single(bulk.n, 1.0)[0];
            let cells = lay_out(class, &bulk, Shape::pencils(class, &bulk), 0);
            assert!(cells.n[axis] >= 100_000, "{cells:?}");
        }
    }

    #[test]
    fn a_uniform_cube_has_pencils_of_eight_to_a_cube_or_cells_of_one() {
        let bulk = Bulk { n: 1_000_000, lo: [0.0; 3], length: [1000.0; 3], clustering: 1.0 };
        let class = &classes::single(bulk.n, 160.0)[0];
        assert_eq!(lay_out(class, &bulk, Shape::pencils(class, &bulk), 0).n, [200, 50, 50]);
        assert_eq!(lay_out(class, &bulk, Shape::cubes(class, &bulk), 0).n, [100; 3]);
    }
}
