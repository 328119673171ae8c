//! Search radii: constant, uniform, or paper A's truncated log-normal.

use super::{
    Error, Result,
    random::{MAX_DRAWS, Stream, generator},
};
use nearfield_core::Radii;
use rand::RngExt;
use rand_distr::StandardNormal;
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// How radii are distributed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Distribution {
    /// `value` for all.
    Constant,
    /// Uniform in `range`.
    Uniform,
    /// exp(N(mu, sigma)) within `range`.
    Lognormal,
}

/// What happens to a log-normal draw outside the range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outside {
    /// It is drawn again: the truncated distribution.
    Redraw,
    /// It is set to the nearer end.
    Clamp,
}

/// A distribution of search radii, `[system.generate.radii]`. The default is paper A's LN(1, 2) in [1, 330]. The
/// paper does not say what happens to draws outside; redrawing is our default.
///
/// ```
/// use nearfield::generate::{Outside, RadiiSpec};
/// let spec: RadiiSpec = "lognormal:1,2,1,330,clamp".parse()?;
/// assert_eq!(spec, RadiiSpec { outside: Outside::Clamp, ..RadiiSpec::default() });
/// # Ok::<(), nearfield::generate::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RadiiSpec {
    /// The distribution.
    pub distribution: Distribution,
    /// The constant, \[length\].
    pub value: f64,
    /// Mean of the logarithm.
    pub mu: f64,
    /// Standard deviation of the logarithm.
    pub sigma: f64,
    /// Smallest and largest radius, \[length\].
    pub range: [f64; 2],
    /// Treatment of log-normal draws outside the range.
    pub outside: Outside,
}

impl Default for RadiiSpec {
    fn default() -> Self {
        Self {
            distribution: Distribution::Lognormal,
            value: 1.0,
            mu: 1.0,
            sigma: 2.0,
            range: [1.0, 330.0],
            outside: Outside::Redraw,
        }
    }
}

impl RadiiSpec {
    /// Radii of `n` particles. A constant gives [`Radii::Uniform`], which every method supports and which leaves
    /// sigma to the particle types.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`]; [`Error::NothingInRange`] when practically no log-normal draw is in range.
    pub fn draw(&self, n: usize, seed: u64) -> Result<Radii> {
        self.validate()?;
        let mut rng = generator(seed, Stream::Radii);
        let [low, high] = self.range;
        match self.distribution {
            Distribution::Constant => Ok(Radii::Uniform(self.value as f32)),
            Distribution::Uniform => {
                let radii = (0..n).map(|_| (low + rng.random::<f64>() * (high - low)) as f32).collect();
                Ok(Radii::PerParticle(radii))
            }
            Distribution::Lognormal => {
                // `libm` rather than the platform's `exp`, so that a seed gives the same bits everywhere.
                let mut draw = || libm::exp(self.mu + self.sigma * rng.sample::<f64, _>(StandardNormal));
                let mut one = || match self.outside {
                    Outside::Clamp => Some(draw().clamp(low, high)),
                    Outside::Redraw => (0..MAX_DRAWS).map(|_| draw()).find(|radius| (low..=high).contains(radius)),
                };
                let radii: Option<Vec<f32>> = (0..n).map(|_| one().map(|radius| radius as f32)).collect();
                radii.map(Radii::PerParticle).ok_or(Error::NothingInRange { what: "radii", low, high })
            }
        }
    }

    /// Checks the parameters that the distribution uses.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`].
    pub fn validate(&self) -> Result<()> {
        let check = |ok: bool, key, value: String, reason| {
            if ok { Ok(()) } else { Err(Error::InvalidParameter { key, value, reason }) }
        };
        // In f32, where radii live: a tiny positive f64 may be zero there.
        let positive = |value: f64| (value as f32).is_finite() && value as f32 > 0.0;
        let [low, high] = self.range;
        check(positive(self.value), "radii.value", self.value.to_string(), "must be positive and finite")?;
        check(self.mu.is_finite(), "radii.mu", self.mu.to_string(), "must be finite")?;
        check(
            self.sigma.is_finite() && self.sigma >= 0.0,
            "radii.sigma",
            self.sigma.to_string(),
            "must be finite and not negative",
        )?;
        check(
            positive(low) && positive(high) && low <= high,
            "radii.range",
            format!("{:?}", self.range),
            "must be two positive numbers, the smaller one first",
        )
    }
}

impl FromStr for RadiiSpec {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let unknown = || Error::UnknownRadii(text.into());
        let (name, arguments) = text.split_once(':').ok_or_else(unknown)?;
        let (arguments, outside) = match arguments.strip_suffix(",clamp") {
            Some(rest) if name == "lognormal" => (rest, Outside::Clamp),
            _ => (arguments, Outside::Redraw),
        };
        let numbers: Vec<f64> =
            arguments.split(',').map(|number| number.trim().parse().map_err(|_| unknown())).collect::<Result<_>>()?;
        let spec = Self { outside, ..Self::default() };
        match (name, numbers.as_slice()) {
            ("constant", &[value]) => Ok(Self { distribution: Distribution::Constant, value, ..spec }),
            ("uniform", &[low, high]) => Ok(Self { distribution: Distribution::Uniform, range: [low, high], ..spec }),
            ("lognormal", &[mu, sigma, low, high]) => Ok(Self { mu, sigma, range: [low, high], ..spec }),
            _ => Err(unknown()),
        }
    }
}
