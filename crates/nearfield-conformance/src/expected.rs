//! What an engine must find, and how far rounding may take it from the exact result.

use nearfield_core::{
    System,
    interaction::{PairLaw, Truncated},
    oracle::{self, Pair, Reference},
    with_potential,
};

/// Roundings allowed in a pair's force, in units of its condition (see [`Expected`]).
const ROUNDINGS: f64 = 8.0;

/// The oracle's results for a system with the error bounds of f32 arithmetic.
///
/// The displacement `(x_j - x_i) + s` is off by up to half an ulp of `x_j - x_i`, which is of the size of the box where
/// a shift follows, and half an ulp of the result. With D = |x_j - x_i| where there is a shift and zero elsewhere, a
/// force F(r) then moves by up to ε (r + D) (|F'| + |F| / r) = ε (r + D) K. The roundings of the potential's own terms
/// are of the same size: where terms of opposite sign cancel, as at the minimum of Lennard-Jones, F' does not. So a
/// force is right within `8 ε Σ (r + D) K` over the particle's pairs. An energy likewise moves by ε (r + D) |F|, its
/// terms by ε |U|, and a force shift's by ε r² K.
pub struct Expected {
    /// Pairs within range, sorted.
    pub pairs: Vec<Pair>,
    /// Float64 forces and energies.
    pub reference: Reference,
    /// Largest error of each force component, `[N]`.
    pub force_error: Vec<f64>,
    /// Largest error of the potential energy.
    pub energy_error: f64,
    /// Largest error of the virial.
    pub virial_error: f64,
}

impl Expected {
    /// Brute force in float64.
    pub fn new(system: &System) -> Self {
        let pairs = oracle::pairs(&system.sim_box, &system.particles, &system.radii);
        let reference = oracle::evaluate_pairs(system, &pairs);
        let n = system.particles.len();
        let mut out = Self { pairs, reference, force_error: vec![0.0; n], energy_error: 0.0, virial_error: 0.0 };
        out.bound_errors(system);
        out
    }

    fn bound_errors(&mut self, system: &System) {
        for pair in &self.pairs {
            let (i, j) = (pair.i as usize, pair.j as usize);
            let (xi, xj) = (system.particles.position.get(i), system.particles.position.get(j));
            let shift = system.sim_box.shift(pair.image);
            let dr: [f64; 3] = std::array::from_fn(|a| f64::from(xj[a]) - f64::from(xi[a]) + f64::from(shift[a]));
            let r = dr.iter().map(|d| d * d).sum::<f64>().sqrt();
            if r == 0.0 {
                continue;
            }
            let before_shift = (0..3)
                .filter(|&a| shift[a] != 0.0)
                .map(|a| f64::from(xj[a]) - f64::from(xi[a]))
                .fold(0.0, |largest, d| d.abs().max(largest));
            let kind = &system.particles.kind;
            let range = system.radii.range(i, j);
            let c = system.interaction.pair_f64(kind[i], kind[j], range, system.radii.is_uniform());
            let (force, slope, energy) = with_potential!(&system.interaction.potential, p => {
                let law = Truncated::<_, true>(p);
                let force = |r: f64| law.f_over_r(r * r, &c) * r;
                let slope = (force(r * (1.0 + 1e-6)) - force(r * (1.0 - 1e-6))) / (2e-6 * r);
                (force(r).abs(), slope.abs(), law.energy(r * r, &c).abs())
            });
            let unit = ROUNDINGS * f64::from(f32::EPSILON);
            let stiffness = slope + force / r;
            let force_error = unit * (r + before_shift) * stiffness;
            self.force_error[i] += force_error;
            self.force_error[j] += force_error;
            self.energy_error += unit * ((r + before_shift) * force + energy + r * r * stiffness);
            self.virial_error += r * force_error + unit * r * force;
        }
    }
}
