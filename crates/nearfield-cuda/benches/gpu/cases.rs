//! The systems that are measured.

use nearfield::generate::{Distribution, Generate, Positions, RadiiSpec, sphere_surface_cutoff};
use nearfield_core::{Boundary, Dynamics, Interaction, Radii, System};

/// A system, how it moves, and what it is called.
pub struct Case {
    /// Unique within a suite.
    pub name: String,
    /// The system.
    pub system: System,
    /// How it moves.
    pub dynamics: Dynamics,
}

/// Paper A's positions.
pub const POSITIONS: [Positions; 3] = [Positions::Lattice, Positions::Disordered, Positions::Cluster];

/// Paper A's search radii.
pub const RADII: [&str; 4] = ["r=1", "r=160", "U[1,160]", "LN(1,2)"];

fn case(name: String, generate: &Generate, cutoff: f32, boundary: Boundary, dynamics: Dynamics) -> Case {
    let start = generate.build([boundary; 3], 1.0).expect("a case can be generated");
    let mut system = System {
        sim_box: start.sim_box,
        particles: start.particles,
        radii: start.radii.unwrap_or(Radii::Uniform(cutoff)),
        interaction: Interaction::lennard_jones(),
    };
    system.wrap();
    system.validate().expect("a case is valid");
    Case { name, system, dynamics }
}

/// A case of paper A: box 1000, sigma from the radius; overlapping starts run by a limit of the displacement.
pub fn orcs(n: usize, positions: Positions, radii: &'static str, boundary: Boundary) -> Case {
    let uniform = RadiiSpec { distribution: Distribution::Uniform, range: [1.0, 160.0], ..RadiiSpec::default() };
    let (cutoff, spec) = match radii {
        "r=1" => (1.0, None),
        "r=160" => (160.0, None),
        "U[1,160]" => (0.0, Some(uniform)),
        _ => (0.0, Some(RadiiSpec::default())),
    };
    let generate = Generate {
        positions,
        n,
        lengths: Some([1000.0; 3]),
        temperature: 1.0,
        center: Some([500.0; 3]),
        radii: spec,
        ..Generate::default()
    };
    let name = format!("{positions:?} {radii} {boundary:?} {n}").to_lowercase();
    let dynamics = Dynamics { max_displacement: 0.01, ..Dynamics::nve(1e-3) };
    let mut case = case(name, &generate, cutoff, boundary, dynamics);
    // Paper A's sigma is the radius over 2.5, also where one radius serves all.
    if cutoff > 0.0 {
        case.system.interaction.types[0].sigma = cutoff / 2.5;
    }
    case
}

/// Uniform random points of unit density in a periodic box with `k` neighbours on average.
pub fn uniform(n: usize, k: f64) -> Case {
    let generate =
        Generate { positions: Positions::Disordered, n, density: Some(1.0), temperature: 0.0, ..Generate::default() };
    let cutoff = (k / (4.0 / 3.0 * std::f64::consts::PI)).cbrt() as f32;
    case(format!("uniform k={k} {n}"), &generate, cutoff, Boundary::Periodic, Dynamics::nve(1e-3))
}

/// Points on the unit sphere with `k` neighbours on average.
pub fn sphere(n: usize, k: f64) -> Case {
    let generate = Generate {
        positions: Positions::SphereSurface,
        n,
        lengths: Some([2.0; 3]),
        temperature: 0.0,
        ..Generate::default()
    };
    let cutoff = sphere_surface_cutoff(n, k) as f32;
    case(format!("sphere k={k} {n}"), &generate, cutoff, Boundary::Open, Dynamics::nve(1e-3))
}

/// A normal cluster of standard deviation 25 and radius 1.
pub fn cluster(n: usize) -> Case {
    let generate = Generate {
        positions: Positions::Cluster,
        n,
        lengths: Some([1000.0; 3]),
        temperature: 0.0,
        center: Some([500.0; 3]),
        ..Generate::default()
    };
    case(format!("cluster r=1 {n}"), &generate, 1.0, Boundary::Open, Dynamics::nve(1e-3))
}

/// The melt of LAMMPS's benchmark: density 0.8442, cutoff 2.5, from an fcc crystal.
pub fn melt(n: usize) -> Case {
    let generate = Generate { n, density: Some(0.8442), temperature: 1.44, ..Generate::default() };
    case(format!("melt {n}"), &generate, 2.5, Boundary::Periodic, Dynamics::nve(0.005))
}

/// A dilute Lennard-Jones gas on a lattice of density 0.4, cutoff 2.5: any number of particles.
pub fn gas(n: usize) -> Case {
    let generate =
        Generate { positions: Positions::Lattice, n, density: Some(0.4), temperature: 1.0, ..Generate::default() };
    case(format!("gas {n}"), &generate, 2.5, Boundary::Periodic, Dynamics::nve(0.002))
}
