//! The request: what `[system.generate]` and `nearfield generate` say.

use super::{Error, RadiiSpec, Result, cluster, disordered, fcc, lattice, sphere_surface, velocities};
use nearfield_core::{Boundary, Particles, Radii, SimBox};
use serde::{Deserialize, Serialize, de::IntoDeserializer};
use std::str::FromStr;

/// Arrangements of particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Positions {
    /// Face-centred cubic crystal.
    Fcc,
    /// Simple cubic grid.
    Lattice,
    /// Uniformly random; also called `uniform`.
    #[serde(alias = "uniform")]
    Disordered,
    /// Normally distributed about a centre.
    Cluster,
    /// Uniformly random on a sphere.
    SphereSurface,
}

impl FromStr for Positions {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        Self::deserialize(name.into_deserializer())
            .map_err(|_: serde::de::value::Error| Error::UnknownPositions(name.into()))
    }
}

/// Initial conditions to be generated.
///
/// ```
/// use nearfield::generate::{Generate, Positions};
/// use nearfield_core::Boundary;
/// let melt = Generate { n: 4000, density: Some(0.8442), ..Generate::default() };
/// let start = melt.build([Boundary::Periodic; 3], 1.0)?;
/// assert_eq!(start.particles.len(), 4000);
/// assert!((start.sim_box.volume() - 4000.0 / 0.8442).abs() < 0.01);
/// # Ok::<(), nearfield::generate::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Generate {
    /// Arrangement.
    pub positions: Positions,
    /// Number of particles.
    pub n: usize,
    /// Particles per volume, [1/length³]: makes a cubic box.
    pub density: Option<f64>,
    /// Box lengths, \[length\]; the box starts at the origin.
    #[serde(rename = "box")]
    pub lengths: Option<[f64; 3]>,
    /// Temperature of the velocities, \[energy\].
    pub temperature: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Centre of a cluster, \[length\]; random when absent.
    pub center: Option<[f64; 3]>,
    /// Standard deviation of a cluster on each axis, \[length\].
    pub spread: f64,
    /// Search radius of each particle; absent for one cutoff.
    pub radii: Option<RadiiSpec>,
}

impl Default for Generate {
    fn default() -> Self {
        Self {
            positions: Positions::Fcc,
            n: 32_000,
            density: None,
            lengths: None,
            temperature: 1.44,
            seed: 1,
            center: None,
            spread: 25.0,
            radii: None,
        }
    }
}

/// Generated initial conditions.
#[derive(Clone, Debug, PartialEq)]
pub struct Generated {
    /// The box.
    pub sim_box: SimBox,
    /// Positions and velocities of particles of type 0.
    pub particles: Particles,
    /// Search radii, when they were asked for.
    pub radii: Option<Radii>,
}

impl Generate {
    /// Generates particles of type 0 and the given mass in a box with the given boundaries.
    ///
    /// # Errors
    /// [`Error`], naming the key at fault.
    pub fn build(&self, boundary: [Boundary; 3], mass: f64) -> Result<Generated> {
        self.validate()?;
        let sim_box = self.sim_box(boundary)?;
        let position = match self.positions {
            Positions::Fcc => fcc(self.n, &sim_box)?,
            Positions::Lattice => lattice(self.n, &sim_box),
            Positions::Disordered => disordered(self.n, &sim_box, self.seed),
            Positions::Cluster => cluster(self.n, &sim_box, self.center, self.spread, self.seed)?,
            Positions::SphereSurface => sphere_surface(self.n, &sim_box, self.seed),
        };
        let mut particles = Particles::at(position.iter());
        particles.velocity = velocities(&particles.kind, &[mass], self.temperature, self.seed);
        let radii = self.radii.as_ref().map(|radii| radii.draw(self.n, self.seed)).transpose()?;
        Ok(Generated { sim_box, particles, radii })
    }

    fn sim_box(&self, boundary: [Boundary; 3]) -> Result<SimBox> {
        let lengths = match (self.density, self.lengths) {
            (Some(density), None) => [libm::cbrt(self.n as f64 / density); 3],
            (None, Some(lengths)) => lengths,
            (density, _) => return Err(Error::BoxSize { both: density.is_some() }),
        };
        Ok(SimBox::new([0.0; 3], lengths.map(|length| length as f32), boundary)?)
    }

    /// Checks every parameter.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] and [`Error::BoxSize`].
    pub fn validate(&self) -> Result<()> {
        let check = |ok: bool, key, value: String, reason| {
            if ok { Ok(()) } else { Err(Error::InvalidParameter { key, value, reason }) }
        };
        // In f32, where lengths live: a tiny positive f64 may be zero there.
        let positive = |value: f64| (value as f32).is_finite() && value as f32 > 0.0;
        check(self.n > 0, "n", self.n.to_string(), "at least one particle is needed")?;
        check(self.n <= i32::MAX as usize, "n", self.n.to_string(), "must be at most 2147483647")?;
        if self.density.is_some() == self.lengths.is_some() {
            return Err(Error::BoxSize { both: self.density.is_some() });
        }
        if let Some(density) = self.density {
            check(positive(density), "density", density.to_string(), "must be positive and finite")?;
        }
        if let Some(lengths) = self.lengths {
            check(
                lengths.into_iter().all(positive),
                "box",
                format!("{lengths:?}"),
                "must be three positive, finite lengths",
            )?;
        }
        let temperature = self.temperature;
        check(
            temperature.is_finite() && temperature >= 0.0,
            "temperature",
            temperature.to_string(),
            "must be finite and not negative",
        )?;
        if let Some(center) = self.center {
            check(center.iter().all(|&x| (x as f32).is_finite()), "center", format!("{center:?}"), "must be finite")?;
        }
        check(positive(self.spread), "spread", self.spread.to_string(), "must be positive and finite")?;
        self.radii.as_ref().map_or(Ok(()), RadiiSpec::validate)
    }
}
