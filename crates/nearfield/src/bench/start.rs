//! Systems that are measured, as recipes.

use crate::{
    Result,
    generate::{Distribution, Generate, Positions, RadiiSpec, Workload},
};
use nearfield_core::{Boundary, Dynamics, Interaction, Radii, System};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// All that another machine needs to make the same input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Start {
    /// Positions, velocities, radii, box and seed.
    pub generate: Generate,
    /// Search radius of all particles, where they have none of their own, \[length\].
    pub cutoff: f64,
    /// Lennard-Jones sigma where one radius serves all, \[length\].
    pub sigma: f64,
    /// Boundary of all faces.
    pub boundary: Boundary,
    /// How particles move.
    pub dynamics: Dynamics,
}

/// Positions of paper A.
pub(super) const POSITIONS: [Positions; 3] = [Positions::Lattice, Positions::Disordered, Positions::Cluster];

/// Search radii of paper A.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PaperRadii {
    One,
    Large,
    Uniform,
    LogNormal,
}

impl PaperRadii {
    pub const ALL: [Self; 4] = [Self::One, Self::Large, Self::Uniform, Self::LogNormal];

    pub fn name(self) -> &'static str {
        match self {
            Self::One => "r=1",
            Self::Large => "r=160",
            Self::Uniform => "r=U[1,160]",
            Self::LogNormal => "r=LN[1,330]",
        }
    }
}

/// Length of paper A's box.
const PAPER_BOX: f64 = 1000.0;

impl Start {
    /// The system.
    ///
    /// # Errors
    /// When the recipe cannot be followed.
    pub fn build(&self) -> Result<System> {
        let start = self.generate.build([self.boundary; 3], 1.0)?;
        let mut interaction = Interaction::lennard_jones();
        interaction.types[0].sigma = self.sigma as f32;
        let mut system = System {
            sim_box: start.sim_box,
            particles: start.particles,
            radii: start.radii.unwrap_or(Radii::Uniform(self.cutoff as f32)),
            interaction,
        };
        system.wrap();
        system.validate()?;
        Ok(system)
    }

    /// Particles per volume times the cube of the cutoff: what mean numbers of neighbours are proportional to within a
    /// family of cases.
    pub(super) fn crowding(&self) -> f64 {
        let generate = &self.generate;
        let volume = |lengths: [f64; 3]| lengths.iter().product::<f64>();
        let density = generate.density.or(generate.lengths.map(|l| generate.n as f64 / volume(l))).unwrap_or(1.0);
        density * if self.cutoff > 0.0 { self.cutoff.powi(3) } else { 1.0 }
    }

    /// Paper A, section 4: a box of length 1000, or `scale` times that with all lengths but small radii scaled alike.
    /// Sigma is the radius over 2.5. Starts overlap, so the displacement of a step is limited.
    pub(super) fn paper_a(n: usize, positions: Positions, radii: PaperRadii, boundary: Boundary, scale: f64) -> Self {
        let (cutoff, spec) = match radii {
            PaperRadii::One => (1.0, None),
            PaperRadii::Large => (160.0 * scale, None),
            PaperRadii::Uniform => (0.0, Some(varied(Distribution::Uniform, 160.0 * scale))),
            PaperRadii::LogNormal => (0.0, Some(varied(Distribution::Lognormal, 330.0 * scale))),
        };
        let length = PAPER_BOX * scale;
        let generate = Generate {
            positions,
            n,
            lengths: Some([length; 3]),
            temperature: 1.0,
            // The paper draws the centre; in the middle, walls and periodic faces give the same start.
            center: Some([0.5 * length; 3]),
            spread: 25.0 * scale,
            radii: spec,
            ..Generate::default()
        };
        let dynamics = Dynamics { max_displacement: 0.01, ..Dynamics::nve(1e-3) };
        Self { generate, cutoff, sigma: if cutoff > 0.0 { cutoff / 2.5 } else { 1.0 }, boundary, dynamics }
    }

    /// Uniform random points of unit density in a periodic box, with `k` neighbours on average.
    pub(crate) fn uniform(n: usize, k: f64) -> Self {
        let positions = Positions::Disordered;
        let generate = Generate { positions, n, density: Some(1.0), temperature: 0.0, ..Generate::default() };
        Self::at_rest(generate, (k / (4.0 / 3.0 * PI)).cbrt(), Boundary::Periodic)
    }

    /// A workload of paper B.
    pub(super) fn paper_b(workload: Workload) -> Self {
        Self::at_rest(workload.start, workload.cutoff, Boundary::Open)
    }

    /// The melt of LAMMPS' benchmark: density 0.8442, cutoff 2.5, from an fcc crystal of the nearest possible size.
    pub(super) fn melt(n: usize) -> Self {
        let cells = (n as f64 / 4.0).cbrt().round().max(1.0) as usize;
        let n = 4 * cells.pow(3);
        let generate = Generate { n, density: Some(0.8442), temperature: 1.44, ..Generate::default() };
        Self { generate, cutoff: 2.5, sigma: 1.0, boundary: Boundary::Periodic, dynamics: Dynamics::nve(0.005) }
    }

    /// A Lennard-Jones gas on a lattice of density 0.4, cutoff 2.5: any number of particles.
    pub(super) fn gas(n: usize) -> Self {
        let generate =
            Generate { positions: Positions::Lattice, n, density: Some(0.4), temperature: 1.0, ..Generate::default() };
        Self { generate, cutoff: 2.5, sigma: 1.0, boundary: Boundary::Periodic, dynamics: Dynamics::nve(0.002) }
    }

    fn at_rest(generate: Generate, cutoff: f64, boundary: Boundary) -> Self {
        // With a limit of the displacement, forces of overlapping particles are capped instead of refused.
        let dynamics = Dynamics { max_displacement: 0.01 * cutoff as f32, ..Dynamics::nve(1e-3) };
        Self { generate, cutoff, sigma: cutoff / 2.5, boundary, dynamics }
    }
}

fn varied(distribution: Distribution, largest: f64) -> RadiiSpec {
    RadiiSpec { distribution, range: [1.0, largest], ..RadiiSpec::default() }
}
