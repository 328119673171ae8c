//! How long a step takes.

use super::Survey;
use nearfield_core::Method;
use serde::{Deserialize, Serialize};

/// Passes over the constants in a fit. Each pass solves for one constant at a time; three converge in tens of passes.
const PASSES: usize = 2000;

/// Seconds of a step of a method on a device: `step + particle n + pair p`, where p is the number of ordered pairs within
/// range, of all pairs for `brute`. On CPUs, seconds of one thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cost {
    /// Of any step, \[s\].
    pub step: f64,
    /// Of each particle, \[s\].
    pub particle: f64,
    /// Of each pair, \[s\].
    pub pair: f64,
}

impl Cost {
    /// Predicted seconds of a step.
    ///
    /// ```
    /// use nearfield::{Method, auto::{Cost, Survey}};
    /// let cost = Cost { step: 1e-5, particle: 1e-8, pair: 1e-9 };
    /// let system = Survey { n: 1000, neighbors: 50.0, variable_radii: false };
    /// let expected = 1e-5 + 1000.0 * 1e-8 + 50_000.0 * 1e-9;
    /// assert!((cost.seconds(Method::Cell, &system) - expected).abs() < 1e-15);
    /// ```
    pub fn seconds(&self, method: Method, survey: &Survey) -> f64 {
        let [step, particle, pair] = terms(method, survey);
        self.step * step + self.particle * particle + self.pair * pair
    }

    /// The constants, none of them negative, with the least sum of squares of relative errors for measured systems and
    /// their seconds of a step.
    ///
    /// ```
    /// use nearfield::{Method, auto::{Cost, Survey}};
    /// let cost = Cost { step: 1e-5, particle: 1e-8, pair: 1e-9 };
    /// let systems = [(1e3, 10.0), (1e4, 1.0), (1e5, 40.0), (1e6, 5.0)];
    /// let systems = systems.map(|(n, neighbors)| Survey { n: n as usize, neighbors, variable_radii: false });
    /// let measured = systems.map(|system| (system, cost.seconds(Method::Cell, &system)));
    /// let fitted = Cost::fit(Method::Cell, &measured);
    /// assert!((fitted.pair / cost.pair - 1.0).abs() < 1e-6);
    /// ```
    pub fn fit(method: Method, measured: &[(Survey, f64)]) -> Self {
        let rows: Vec<[f64; 3]> =
            measured.iter().map(|(survey, seconds)| terms(method, survey).map(|term| term / seconds)).collect();
        // Columns of unit length, so that the passes converge whatever the units are.
        let norms: [f64; 3] =
            std::array::from_fn(|c| rows.iter().map(|row| row[c] * row[c]).sum::<f64>().sqrt().max(f64::MIN_POSITIVE));
        let mut x = [0.0f64; 3];
        for _ in 0..PASSES {
            for column in 0..3 {
                let gradient: f64 = rows
                    .iter()
                    .map(|row| {
                        let predicted: f64 = (0..3).map(|c| row[c] / norms[c] * x[c]).sum();
                        row[column] / norms[column] * (1.0 - predicted)
                    })
                    .sum();
                x[column] = (x[column] + gradient).max(0.0);
            }
        }
        Self { step: x[0] / norms[0], particle: x[1] / norms[1], pair: x[2] / norms[2] }
    }
}

/// What the constants are multiplied with.
fn terms(method: Method, survey: &Survey) -> [f64; 3] {
    let n = survey.n as f64;
    [1.0, n, if method == Method::Brute { n * n } else { survey.pairs() }]
}
