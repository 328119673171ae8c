//! Systems that tests of structures and consumers share.

use crate::{Brute, GroupBox, Input, InputRadii, Run, Slots, Structure, Vicinity};
use nearfield_core::philox::{Stream, normals, uniforms};
use nearfield_core::{Boundary, Particles, Radii, SimBox};
use std::ops::Range;

/// A system to search.
pub struct Case {
    pub name: String,
    pub sim_box: SimBox,
    pub particles: Particles,
    pub radii: Radii,
}

impl Case {
    pub fn new(name: &str, sim_box: SimBox, positions: Vec<[f32; 3]>, radii: Radii) -> Self {
        let particles = Particles::at(positions.into_iter().map(|p| sim_box.wrap(p).0));
        radii.validate(particles.len(), &sim_box).unwrap();
        Self { name: format!("{name}, {} particles", particles.len()), sim_box, particles, radii }
    }

    pub fn input(&self) -> Input<'_> {
        let position = &self.particles.position;
        Input {
            sim_box: &self.sim_box,
            position: [&position.x, &position.y, &position.z],
            radii: match &self.radii {
                Radii::Uniform(r) => InputRadii::Uniform(*r),
                Radii::PerParticle(radii) => InputRadii::PerParticle(radii),
            },
            kind: &[],
        }
    }
}

fn uniform(seed: u64, k: usize) -> [f32; 3] {
    let [x, y, z, _] = uniforms(seed, Stream::Langevin, 0, k as u32);
    [x, y, z].map(|u| u as f32)
}

fn normal(seed: u64, k: usize) -> [f32; 3] {
    let [x, y, z, _] = normals(seed, Stream::Langevin, 0, k as u32);
    [x, y, z].map(|u| u as f32)
}

/// `n` points uniform in `[0, lengths)`.
pub fn uniform_points(seed: u64, n: usize, lengths: [f32; 3]) -> Vec<[f32; 3]> {
    (0..n).map(|k| uniform(seed, k)).map(|u| std::array::from_fn(|axis| u[axis] * lengths[axis])).collect()
}

/// `n` log-normal radii within `[1, largest]`.
fn lognormal_radii(seed: u64, n: usize, largest: f32) -> Radii {
    Radii::PerParticle((0..n).map(|k| (1.0 + 2.0 * normal(seed, k)[0]).exp().clamp(1.0, largest)).collect())
}

fn lattice(n: usize, spacing: f32) -> Vec<[f32; 3]> {
    (0..n * n * n).map(|k| [k % n, k / n % n, k / n / n].map(|c| c as f32 * spacing)).collect()
}

/// Every kind of system that is easy to get wrong.
pub fn cases() -> Vec<Case> {
    use Boundary::{Open, Periodic, Wall};
    let mut cases = Vec::new();
    for k in 0..27 {
        let boundary = [k % 3, k / 3 % 3, k / 9].map(|b| [Periodic, Wall, Open][b]);
        let lengths = [10.0, 8.0, 13.0];
        let sim_box = SimBox::new([-1.0, 0.0, 100.0], [9.0, 8.0, 113.0], boundary).unwrap();
        let moved = |points: Vec<[f32; 3]>| points.iter().map(|p| [p[0] - 1.0, p[1], p[2] + 100.0]).collect();
        let points = moved(uniform_points(k as u64, 400, lengths));
        cases.push(Case::new(&format!("uniform, seed {k}, {boundary:?}"), sim_box, points, Radii::Uniform(1.3)));
        let points = moved(uniform_points(100 + k as u64, 300, lengths));
        let radii = (0..300).map(|i| 0.01 * 300f32.powf(uniform(k as u64, i)[2])).collect();
        let name = format!("radii 1 to 300, seed {k}, {boundary:?}");
        cases.push(Case::new(&name, sim_box, points, Radii::PerParticle(radii)));
    }
    for boundary in [Periodic, Open] {
        let cubic = |length| SimBox::cubic(length, boundary).unwrap();
        let named = |name: &str| format!("{name}, {boundary:?}");
        for n in 0..4 {
            let points = uniform_points(3, n, [1.0; 3]);
            cases.push(Case::new(&named("a few"), cubic(1.0), points.clone(), Radii::Uniform(0.5)));
            cases.push(Case::new(&named("a few, radii"), cubic(1.0), points, Radii::PerParticle(vec![0.4; n])));
        }
        cases.push(Case::new(&named("lattice, ties"), cubic(12.0), lattice(12, 1.0), Radii::Uniform(1.0)));
        cases.push(Case::new(
            &named("lattice, diagonal ties"),
            cubic(12.0),
            lattice(12, 1.0),
            Radii::Uniform(5f32.sqrt()),
        ));
        cases.push(Case::new(&named("lattice at half a box"), cubic(4.0), lattice(4, 1.0), Radii::Uniform(2.0)));
        cases.push(Case::new(&named("2 x 2 x 2 at half a box"), cubic(2.0), lattice(2, 1.0), Radii::Uniform(1.0)));
        let points = uniform_points(4, 200, [2.0; 3]);
        cases.push(Case::new(&named("uniform at half a box, seed 4"), cubic(2.0), points, Radii::Uniform(1.0)));
        cases.push(Case::new(&named("coincident"), cubic(9.0), vec![[4.5; 3]; 70], Radii::Uniform(1.0)));
        let faces = (0..300).map(|k| uniform(5, k)).enumerate().map(|(k, u)| {
            let mut p = u.map(|u| u * 7.0);
            p[k % 3] = [0.0, 7f32.next_down(), -0.0, 1e-30][k % 4];
            p
        });
        cases.push(Case::new(&named("on faces, seed 5"), cubic(7.0), faces.collect(), Radii::Uniform(0.9)));
        let cluster: Vec<_> = (0..1500).map(|k| normal(6, k).map(|u| 500.0 + 2.5 * u)).collect();
        cases.push(Case::new(&named("cluster, seed 6"), cubic(1000.0), cluster.clone(), Radii::Uniform(1.0)));
        cases.push(Case::new(&named("cluster, radii"), cubic(1000.0), cluster, lognormal_radii(7, 1500, 330.0)));
        let sphere = (0..1500).map(|k| normal(8, k)).map(|u| {
            let length = u.iter().map(|x| x * x).sum::<f32>().sqrt();
            u.map(|x| 1.5 + x / length)
        });
        cases.push(Case::new(&named("sphere surface, seed 8"), cubic(3.0), sphere.collect(), Radii::Uniform(0.12)));
        let points = uniform_points(9, 1000, [1000.0; 3]);
        cases.push(Case::new(&named("log-normal, seed 9"), cubic(1000.0), points, lognormal_radii(9, 1000, 330.0)));
        let points = uniform_points(10, 1200, [1000.0; 3]);
        cases.push(Case::new(&named("sparse, seed 10"), cubic(1000.0), points.clone(), Radii::Uniform(1.0)));
        cases.push(Case::new(&named("dense, seed 10"), cubic(1000.0), points, Radii::Uniform(160.0)));
        let points = uniform_points(11, 500, [100.0, 0.0, 0.0]);
        cases.push(Case::new(&named("line along x, seed 11"), cubic(100.0), points, Radii::Uniform(1.0)));
        let points = uniform_points(12, 500, [0.0, 0.0, 100.0]);
        cases.push(Case::new(&named("line along z, seed 12"), cubic(100.0), points, Radii::Uniform(1.0)));
        let points = uniform_points(13, 500, [30.0, 0.0, 30.0]);
        cases.push(Case::new(&named("sheet, seed 13"), cubic(30.0), points, Radii::Uniform(2.0)));
        let thin = SimBox::new([0.0; 3], [2.0, 50.0, 3.0], [boundary; 3]).unwrap();
        cases.push(Case::new(
            &named("thin, seed 14"),
            thin,
            uniform_points(14, 900, [2.0, 50.0, 3.0]),
            Radii::Uniform(1.0),
        ));
    }
    let mut outliers: Vec<_> = (0..900).map(|k| normal(15, k)).collect();
    outliers[10] = [1e30, 0.0, 0.0];
    outliers[11] = [1e30, 0.0, 1.0];
    outliers[12] = [-1e9, 3e20, -4e15];
    outliers[13] = [2e8; 3];
    outliers[14] = [2e8, 2e8, 2e8f32.next_up()];
    let open = SimBox::cubic(1.0, Open).unwrap();
    cases.push(Case::new("far outliers, seed 15", open, outliers, Radii::Uniform(0.5)));
    cases
}

/// A structure that proposes only d < r_j, as one built over the particles' boxes does.
pub struct SeesLarger(pub Brute);

impl Structure for SeesLarger {
    fn slots(&self) -> &Slots {
        self.0.slots()
    }

    fn n_groups(&self) -> usize {
        self.0.n_groups()
    }

    fn group(&self, g: usize) -> Range<usize> {
        self.0.group(g)
    }

    fn runs(&self, group: &GroupBox, vicinity: &mut Vicinity, out: &mut Vec<Run>) {
        let mut images = Vec::new();
        self.0.runs(group, vicinity, &mut images);
        let slots = self.slots();
        for Run { image, .. } in images {
            for j in 0..slots.len() as u32 {
                // Which images reach the group is not known here: those of large particles are all proposed.
                let near = (0..3).all(|axis| {
                    let x = slots.at(j as usize)[axis];
                    let r = slots.radius[j as usize] * 1.001;
                    image[axis] != 0 || (x + r >= group.lo[axis] && x - r <= group.hi[axis])
                });
                if near {
                    out.push(Run { start: j, end: j + 1, image });
                }
            }
        }
    }

    fn complete(&self) -> bool {
        false
    }
}
