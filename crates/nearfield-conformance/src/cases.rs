//! Inputs, each a named system that has gone wrong in some program before.
//!
//! Their interaction is the Gaussian core, finite everywhere, so that forces can be compared whatever the positions.

use nearfield_core::{
    Boundary::{self, Open, Periodic, Wall},
    Interaction, Particles, Radii, SimBox, System,
    potentials::{Gaussian, Potential},
};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, LogNormal, StandardNormal};
use rand_pcg::Pcg64Mcg;

/// A system and what it is called in messages.
pub struct Case {
    /// Its name.
    pub name: String,
    /// The system, wrapped and valid.
    pub system: System,
}

/// A soft system, wrapped and checked.
///
/// # Panics
/// When it is not valid.
pub fn soft(sim_box: SimBox, positions: Vec<[f32; 3]>, radii: Radii) -> System {
    let interaction = Interaction { potential: Potential::Gaussian(Gaussian), ..Interaction::lennard_jones() };
    let mut system = System { sim_box, particles: Particles::at(positions), radii, interaction };
    system.wrap();
    system.validate().expect("a case is valid");
    system
}

/// A random generator of this suite.
pub fn rng(seed: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed)
}

/// A cube `[0, length)`.
pub fn cube(length: f32, boundary: [Boundary; 3]) -> SimBox {
    SimBox::new([0.0; 3], [length; 3], boundary).expect("a valid box")
}

/// `n` uniform points in a box.
pub fn uniform(n: usize, sim_box: &SimBox, seed: u64) -> Vec<[f32; 3]> {
    let (mut rng, lo, hi) = (rng(seed), sim_box.lo(), sim_box.hi());
    (0..n).map(|_| std::array::from_fn(|a| rng.random_range(lo[a]..hi[a]))).collect()
}

/// The boundary combinations worth their own run.
pub const BOUNDARIES: [(&str, [Boundary; 3]); 5] = [
    ("ppp", [Periodic; 3]),
    ("www", [Wall; 3]),
    ("ooo", [Open; 3]),
    ("ppw", [Periodic, Periodic, Wall]),
    ("pow", [Periodic, Open, Wall]),
];

/// Every input of up to a few hundred particles.
pub fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |name: &str, system: System| cases.push(Case { name: name.into(), system });
    for n in [0, 1, 2, 17] {
        let sim_box = cube(4.0, [Periodic; 3]);
        add(&format!("{n} particles"), soft(sim_box, uniform(n, &sim_box, 1 + n as u64), Radii::Uniform(1.5)));
    }
    for (name, boundary) in BOUNDARIES {
        let sim_box = cube(10.0, boundary);
        for cutoff in [0.7, 2.5] {
            let positions = uniform(250, &sim_box, 7);
            add(&format!("random {name}, cutoff {cutoff}"), soft(sim_box, positions, Radii::Uniform(cutoff)));
        }
        add(&format!("faces {name}"), soft(sim_box, on_faces(&sim_box), Radii::Uniform(2.5)));
        add(&format!("radii 1:300 {name}"), size_ratios(boundary));
    }
    add("dense, nearly all pairs", half_box(120, 4.9));
    add("cutoff of exactly half the box", half_box(120, 5.0));
    add("outside an open box", outside_open_box());
    add("box far from the origin", far_from_origin());
    add("long box with an odd corner", long_box());
    add("box of a thousandth", tiny_box());
    for (spacing, cutoffs) in [(1.0, [1.0, 2.0, 3.0]), (0.1, [0.1, 0.2, 0.3])] {
        for cutoff in cutoffs {
            add(&format!("lattice of {spacing}, cutoff {cutoff}"), lattice(6, spacing, cutoff, [Periodic; 3]));
        }
    }
    for squared in [1.0f32, 2.0, 3.0, 6.0] {
        let cutoff = squared.sqrt();
        for (cutoff, side) in [(cutoff.next_down(), "below"), (cutoff.next_up(), "above")] {
            let system = lattice(6, 1.0, cutoff, [Periodic; 3]);
            add(&format!("lattice, cutoff just {side} the root of {squared}"), system);
        }
    }
    add("offsets on diagonals", diagonals([Periodic; 3]));
    add("offsets on diagonals, open", diagonals([Open; 3]));
    add("far outliers of an open box", outliers());
    add("lattice between walls", lattice(6, 1.0, 2.0, [Wall; 3]));
    add("coincident triples", coincident([Periodic; 3]));
    add("coincident triples, open", coincident([Open; 3]));
    add("all in one place", soft(cube(10.0, [Periodic; 3]), vec![[9.5, 0.0, 3.0]; 60], Radii::Uniform(1.0)));
    add("sphere surface", sphere_surface([Periodic; 3]));
    add("sphere surface, open", sphere_surface([Open; 3]));
    add("clusters", clusters());
    add("points on a line", line());
    cases
}

/// A system with nothing fixed but its seed.
pub fn random(seed: u64) -> System {
    let mut rng = rng(seed);
    let scale = 10f32.powi(rng.random_range(-2..4));
    let lo: [f32; 3] = std::array::from_fn(|_| scale * rng.random_range(-5.0..5.0));
    let hi = std::array::from_fn(|a| lo[a] + scale * rng.random_range(1.0..4.0));
    let boundary = std::array::from_fn(|_| [Periodic, Wall, Open][rng.random_range(0..3)]);
    let sim_box = SimBox::new(lo, hi, boundary).expect("a valid box");
    let (n, lengths) = (rng.random_range(2..150), sim_box.lengths());
    let mut points = uniform(n, &sim_box, seed + 1000);
    if rng.random::<bool>() {
        let steps = rng.random_range(2..10) as f32;
        for point in &mut points {
            *point =
                std::array::from_fn(|a| lo[a] + ((point[a] - lo[a]) / lengths[a] * steps).floor() / steps * lengths[a]);
        }
    }
    let largest = 0.5 * lengths.into_iter().fold(f32::MAX, f32::min);
    let radii = match rng.random_range(0..3) {
        0 => Radii::Uniform(largest),
        1 => Radii::Uniform(largest * rng.random_range(0.05..1.0)),
        _ => Radii::PerParticle((0..n).map(|_| largest * rng.random_range(0.02f32..1.0).powi(3)).collect()),
    };
    soft(sim_box, points, radii)
}

/// A few thousand particles.
pub fn thousands() -> Vec<Case> {
    let fluid = cube(12.0, [Periodic; 3]);
    let slab = cube(12.0, [Periodic, Periodic, Wall]);
    let mut rng = rng(5);
    let radii = (0..2000).map(|_| rng.random_range(0.3..1.5)).collect();
    vec![
        Case { name: "fluid".into(), system: soft(fluid, uniform(2000, &fluid, 3), Radii::Uniform(2.0)) },
        Case { name: "radii".into(), system: soft(slab, uniform(2000, &slab, 4), Radii::PerParticle(radii)) },
    ]
}

/// A hundred thousand particles at the density of a liquid.
pub fn hundred_thousand() -> System {
    let sim_box = cube(50.0, [Periodic; 3]);
    soft(sim_box, uniform(100_000, &sim_box, 11), Radii::Uniform(1.4))
}

/// Every corner, edge and face centre, the last representable number below each upper face, and points just inside.
fn on_faces(sim_box: &SimBox) -> Vec<[f32; 3]> {
    let (lo, hi) = (sim_box.lo(), sim_box.hi());
    let levels = |a: usize| [lo[a], 0.5 * (lo[a] + hi[a]), hi[a].next_down(), lo[a] + 0.3, hi[a] - 0.3];
    let mut points = Vec::new();
    for x in levels(0) {
        for y in levels(1) {
            for z in levels(2) {
                points.push([x, y, z]);
            }
        }
    }
    points
}

/// Search radii from 1 to 300, most of them small.
fn size_ratios(boundary: [Boundary; 3]) -> System {
    let sim_box = cube(1000.0, boundary);
    let (mut rng, law) = (rng(13), LogNormal::new(1.0f32, 2.0).expect("valid parameters"));
    let mut radii: Vec<f32> = (0..200).map(|_| law.sample(&mut rng).clamp(1.0, 300.0)).collect();
    (radii[0], radii[1]) = (1.0, 300.0);
    soft(sim_box, uniform(200, &sim_box, 14), Radii::PerParticle(radii))
}

/// A cutoff near half the box: with particles at exactly that distance from each other, through either image.
fn half_box(n: usize, cutoff: f32) -> System {
    let sim_box = cube(10.0, [Periodic; 3]);
    let mut points = uniform(n, &sim_box, 17);
    points.extend([[1.0, 1.0, 1.0], [6.0, 1.0, 1.0], [1.0, 6.0, 1.0], [6.0, 6.0, 1.0], [6.0, 6.0, 6.0], [0.0; 3]]);
    soft(sim_box, points, Radii::Uniform(cutoff))
}

fn outside_open_box() -> System {
    let wide = SimBox::new([-20.0; 3], [30.0; 3], [Open; 3]).expect("a valid box");
    soft(cube(10.0, [Open; 3]), uniform(250, &wide, 19), Radii::Uniform(5.0))
}

/// Coordinates near 10⁴, where neighbouring f32 numbers are 0.001 apart.
fn far_from_origin() -> System {
    let sim_box = SimBox::new([1.0e4, -1.0e4, 1.0e4], [10_020.0, -9_980.0, 10_020.0], [Periodic; 3]).expect("valid");
    soft(sim_box, uniform(250, &sim_box, 23), Radii::Uniform(4.0))
}

fn long_box() -> System {
    let sim_box = SimBox::new([-7.3, 2.1, -0.7], [-1.2, 11.3, 40.9], [Periodic; 3]).expect("a valid box");
    soft(sim_box, uniform(250, &sim_box, 29), Radii::Uniform(3.05))
}

fn tiny_box() -> System {
    let sim_box = cube(1e-3, [Periodic; 3]);
    let mut system = soft(sim_box, uniform(200, &sim_box, 31), Radii::Uniform(2e-4));
    system.interaction.types[0].sigma = 1e-4;
    system
}

/// A simple cubic lattice whose neighbours lie exactly at the cutoff, where `spacing` is a binary fraction, and as near
/// to it as rounding leaves them, where it is not.
pub fn lattice(side: usize, spacing: f32, cutoff: f32, boundary: [Boundary; 3]) -> System {
    let mut points = Vec::new();
    for x in 0..side {
        for y in 0..side {
            for z in 0..side {
                points.push([x, y, z].map(|k| k as f32 * spacing));
            }
        }
    }
    let mut system = soft(cube(side as f32 * spacing, boundary), points, Radii::Uniform(cutoff));
    system.interaction.types[0].sigma = spacing;
    system
}

/// Around two places, one of them a corner of the box: neighbours in all directions whose components are equal or zero,
/// at the cutoff and one rounding to both sides of it.
fn diagonals(boundary: [Boundary; 3]) -> System {
    let cutoff = 1.5f32;
    let mut points = Vec::new();
    for centre in [[0.0f32; 3], [8.0, 4.0, 11.3]] {
        points.push(centre);
        for direction in (0..27).map(|k| [k % 3, k / 3 % 3, k / 9].map(|c| c as f32 - 1.0)) {
            let length = direction.iter().map(|c| c * c).sum::<f32>().sqrt();
            if length == 0.0 {
                continue;
            }
            let step = cutoff / length;
            for step in [step.next_down(), step, step.next_up()] {
                points.push(std::array::from_fn(|a| centre[a] + step * direction[a]));
            }
        }
    }
    soft(cube(16.0, boundary), points, Radii::Uniform(cutoff))
}

/// Pairs so far outside of an open box that the cutoff is lost in the rounding of their coordinates.
fn outliers() -> System {
    let sim_box = cube(10.0, [Open; 3]);
    let mut points = uniform(100, &sim_box, 53);
    for far in [30.0f32, -3e3, 2e8, -1e30] {
        points.extend([
            [far, 5.0, 5.0],
            [far, 5.0, 5.5],
            [far.next_up(), 5.0, 5.0],
            [far; 3],
            [far; 3],
            [5.0, far, far],
        ]);
    }
    soft(sim_box, points, Radii::Uniform(1.5))
}

fn coincident(boundary: [Boundary; 3]) -> System {
    let sim_box = cube(6.0, boundary);
    let places = uniform(60, &sim_box, 37);
    soft(sim_box, places.iter().cycle().take(180).copied().collect(), Radii::Uniform(1.0))
}

fn sphere_surface(boundary: [Boundary; 3]) -> System {
    let mut rng = rng(41);
    let points = (0..300).map(|_| {
        let v: [f32; 3] = std::array::from_fn(|_| rng.sample(StandardNormal));
        let norm = v.iter().map(|x| x * x).sum::<f32>().sqrt();
        v.map(|x| 10.0 + 9.9 * x / norm)
    });
    soft(cube(20.0, boundary), points.collect(), Radii::Uniform(2.5))
}

/// Tight clusters in a large empty box, one of them across a corner.
fn clusters() -> System {
    let mut rng = rng(43);
    let centres = [[0.0, 0.0, 0.0], [50.0, 50.0, 50.0], [99.0, 20.0, 1.0], [30.0, 70.0, 99.9]];
    let points = (0..240).map(|i| {
        let centre: [f32; 3] = centres[i % 4];
        centre.map(|c| c + 0.8 * rng.sample::<f32, _>(StandardNormal))
    });
    soft(cube(100.0, [Periodic; 3]), points.collect(), Radii::Uniform(1.0))
}

fn line() -> System {
    let points = (0..200).map(|k| [5.0, 5.0, k as f32 * 0.05]);
    soft(cube(10.0, [Periodic; 3]), points.collect(), Radii::Uniform(0.5))
}

/// A face-centred cubic crystal of `cells`³ cells at reduced density 0.8, shaken by up to `shake` on each axis, with
/// Maxwell-Boltzmann velocities of zero total momentum: a Lennard-Jones liquid soon after its start.
pub fn liquid(cells: usize, temperature: f32, shake: f32, cutoff: f32, seed: u64) -> System {
    let spacing = (4.0f32 / 0.8).cbrt();
    let sim_box = cube(cells as f32 * spacing, [Periodic; 3]);
    let mut rng = rng(seed);
    let mut points = Vec::new();
    for cell in 0..cells.pow(3) {
        let corner = [cell % cells, cell / cells % cells, cell / cells / cells];
        for basis in [[0.25, 0.25, 0.25], [0.75, 0.75, 0.25], [0.75, 0.25, 0.75], [0.25, 0.75, 0.75]] {
            points.push(std::array::from_fn(|a| {
                (corner[a] as f32 + basis[a]) * spacing + rng.random_range(-1.0..1.0) * shake
            }));
        }
    }
    let mut system = soft(sim_box, points, Radii::Uniform(cutoff));
    system.interaction = Interaction::lennard_jones();
    thermalize(&mut system, temperature, &mut rng);
    system
}

/// Normal velocities of a temperature, total momentum removed.
pub fn thermalize(system: &mut System, temperature: f32, rng: &mut Pcg64Mcg) {
    let n = system.particles.len();
    for axis in system.particles.velocity.axes_mut() {
        axis.fill_with(|| temperature.sqrt() * rng.sample::<f32, _>(StandardNormal));
        let mean = axis.iter().sum::<f32>() / n as f32;
        axis.iter_mut().for_each(|v| *v -= mean);
    }
}
