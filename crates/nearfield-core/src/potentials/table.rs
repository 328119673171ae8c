//! A tabulated potential: cubic Hermite interpolation of `U(r)` with its force as slope.
//!
//! The interpolated force is the exact derivative of the interpolated energy, so energy is conserved however coarse
//! the table.

use super::{PairPotential, Real};

/// What can be wrong with a table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// Interpolation needs two points.
    #[error("a table needs at least two rows, found {0}")]
    TooShort(usize),
    /// Distances must rise.
    #[error("row {row}: r = {r} must be greater than in the row before and not negative")]
    NotAscending {
        /// Row number, from 1.
        row: usize,
        /// The distance.
        r: f64,
    },
    /// A value is NaN or infinite.
    #[error("row {row}: every value must be finite")]
    NotFinite {
        /// Row number, from 1.
        row: usize,
    },
}

/// `U(r)` and `F(r) = -dU/dr` at ascending distances, resampled to an even grid. In units of ε and σ of the pair:
/// the energy is `ε U(r / σ)`. Below the first distance the first force continues; beyond the last all is zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    start: f64,
    end: f64,
    inverse_step: f64,
    /// (U, F) at the nodes.
    nodes: Vec<[f64; 2]>,
}

/// Nodes of the even grid: more than any printed table holds, 32 kB.
const N_NODES: usize = 2048;

impl Table {
    /// A table from rows of (r, U, F).
    ///
    /// # Errors
    /// [`TableError`], naming the row.
    pub fn new(rows: &[[f64; 3]]) -> Result<Self, TableError> {
        if rows.len() < 2 {
            return Err(TableError::TooShort(rows.len()));
        }
        for (i, row) in rows.iter().enumerate() {
            if !row.iter().all(|v| v.is_finite()) {
                return Err(TableError::NotFinite { row: i + 1 });
            }
            if row[0] < 0.0 || (i > 0 && row[0] <= rows[i - 1][0]) {
                return Err(TableError::NotAscending { row: i + 1, r: row[0] });
            }
        }
        let (start, end) = (rows[0][0], rows[rows.len() - 1][0]);
        let step = (end - start) / (N_NODES - 1) as f64;
        let mut nodes = Vec::with_capacity(N_NODES);
        let mut k = 0;
        for node in 0..N_NODES {
            let r = start + node as f64 * step;
            while k + 2 < rows.len() && rows[k + 1][0] <= r {
                k += 1;
            }
            let ([r0, u0, f0], [r1, u1, f1]) = (rows[k], rows[k + 1]);
            nodes.push(hermite((r - r0) / (r1 - r0), r1 - r0, [u0, f0], [u1, f1]));
        }
        Ok(Self { start, end, inverse_step: 1.0 / step, nodes })
    }

    /// The last tabulated distance, in units of σ.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// The first tabulated distance, in units of σ.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Intervals of the even grid per σ.
    pub fn intervals_per_sigma(&self) -> f64 {
        self.inverse_step
    }

    /// Polynomial coefficients of U and of F on each interval of the even grid, in powers of the fraction of the
    /// interval: what a device that interpolates in f32 stores, for differences of nodes would lose its digits.
    pub fn polynomials(&self) -> impl ExactSizeIterator<Item = ([f64; 4], [f64; 3])> + '_ {
        let h = 1.0 / self.inverse_step;
        self.nodes.windows(2).map(move |nodes| {
            let [[u0, f0], [u1, f1]] = [nodes[0], nodes[1]];
            let (a, b) = (-f0 * h - (u1 - u0), f1 * h + (u1 - u0));
            let u = [u0, (u1 - u0) + a, b - 2.0 * a, a - b];
            (u, [-u[1] / h, -2.0 * u[2] / h, -3.0 * u[3] / h])
        })
    }

    /// (U, F) at distance `x`, in units of ε and σ.
    #[inline]
    fn interpolate(&self, x: f64) -> [f64; 2] {
        // The end itself still counts: a cutoff there takes its shifts from the last row.
        if x > self.end {
            return [0.0, 0.0];
        }
        if x < self.start {
            let [u, f] = self.nodes[0];
            return [u + f * (self.start - x), f];
        }
        let t = (x - self.start) * self.inverse_step;
        let k = (t as usize).min(N_NODES - 2);
        hermite(t - k as f64, 1.0 / self.inverse_step, self.nodes[k], self.nodes[k + 1])
    }
}

/// Cubic Hermite value and negative slope at fraction `t` of an interval of width `h`.
#[inline(always)]
fn hermite(t: f64, h: f64, [u0, f0]: [f64; 2], [u1, f1]: [f64; 2]) -> [f64; 2] {
    let (a, b) = (-f0 * h - (u1 - u0), f1 * h + (u1 - u0));
    let s = 1.0 - t;
    let u = s * u0 + t * u1 + t * s * (s * a + t * b);
    let slope = (u1 - u0) + (1.0 - 2.0 * t) * (s * a + t * b) + t * s * (b - a);
    [u, -slope / h]
}

impl PairPotential for Table {
    #[inline(always)]
    fn f_over_r<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        let r = r2.sqrt();
        let [_, f] = self.interpolate((r / sigma).to_f64());
        if r2 > T::of(0.0) { epsilon / sigma * T::of(f) / r } else { T::of(0.0) }
    }

    #[inline(always)]
    fn energy<T: Real>(&self, r2: T, epsilon: T, sigma: T) -> T {
        let [u, _] = self.interpolate((r2.sqrt() / sigma).to_f64());
        epsilon * T::of(u)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_the_interpolation() {
        let table = Table::new(&[[0.5, 3.0, 4.0], [1.0, 1.5, 2.0], [2.5, 0.0, 0.5]]).unwrap();
        for (k, (u, f)) in table.polynomials().enumerate() {
            for t in [0.0, 0.25, 0.5, 0.99] {
                let [expected_u, expected_f] =
                    table.interpolate(table.start() + (k as f64 + t) / table.intervals_per_sigma());
                assert!((u[0] + t * (u[1] + t * (u[2] + t * u[3])) - expected_u).abs() < 1e-9);
                assert!((f[0] + t * (f[1] + t * f[2]) - expected_f).abs() < 1e-6);
            }
        }
        assert_eq!(table.polynomials().len(), N_NODES - 1);
    }
}
