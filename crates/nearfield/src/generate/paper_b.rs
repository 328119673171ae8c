//! The two workloads of paper B, by its own parameters.

use super::{Generate, Positions, sphere_surface_cutoff};

/// A start and the cutoff that goes with it. Boundaries are open: the paper has no periodic images.
///
/// ```
/// use nearfield::generate::Workload;
/// use nearfield_core::Boundary;
/// let workload = Workload::uniform(8, 4);
/// assert_eq!((workload.start.n, workload.cutoff), (2048, 0.125));
/// assert_eq!(workload.start.build([Boundary::Open; 3], 1.0)?.sim_box.lengths(), [1.0; 3]);
/// # Ok::<(), nearfield::generate::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Workload {
    /// Positions; velocities are zero.
    pub start: Generate,
    /// The one cutoff, \[length\].
    pub cutoff: f64,
}

impl Workload {
    /// Section 5.2: `p` particles on average in each of `beta`³ cells of the unit box, whose width is the cutoff.
    ///
    /// The paper's text has N = p 3^beta; its code and captions mean N = p beta³. It measures beta = 2, 4, ..., 32 and p
    /// = 1, 2, ..., 32.
    pub fn uniform(beta: usize, p: usize) -> Self {
        let start = Generate { lengths: Some([1.0; 3]), ..at_rest(Positions::Disordered, p * beta.pow(3)) };
        Self { start, cutoff: 1.0 / beta as f64 }
    }

    /// Section 5.3 and code 2: `p` `alpha`³ particles on the unit sphere, with about 9 `p` neighbours each.
    ///
    /// The paper measures alpha = 8, 16, ..., 128 and p = 1, 2, ..., 32. The sphere is about the middle of the box [0,
    /// 2)³.
    pub fn sphere_surface(alpha: usize, p: usize) -> Self {
        let n = p * alpha.pow(3);
        let start = Generate { lengths: Some([2.0; 3]), ..at_rest(Positions::SphereSurface, n) };
        Self { start, cutoff: sphere_surface_cutoff(n, 9.0 * p as f64) }
    }
}

fn at_rest(positions: Positions, n: usize) -> Generate {
    Generate { positions, n, temperature: 0.0, ..Generate::default() }
}
