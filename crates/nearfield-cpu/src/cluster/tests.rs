//! The pair list against all pairs, and kernels of every instruction set against float64.

use super::{
    BLOCK, Clusters, Keeping, Moving, Output,
    lennard_jones::{Kernel, Law, Plain, Typed},
    list::Pairs,
    quad::{CLUSTER, own_pairs},
    sums::Parts,
};
use crate::{Grid, Input, InputRadii, Structure, lanes::Isa, physics::Physics, testing::uniform_points};
use nearfield_core::{
    Boundary, Interaction, ParticleType, Particles, Radii, SimBox, System, Truncation, Vec3s, oracle,
    predicate::{displacement, squared_length},
};
use std::collections::BTreeMap;

/// A system in clusters, with particles in the order of the blocks.
struct Built {
    system: System,
    physics: Physics,
    clusters: Clusters,
}

fn gas(n: usize, lengths: [f32; 3], boundary: Boundary, cutoff: f32, seed: u64) -> System {
    let mut particles = Particles::at(uniform_points(seed, n, lengths));
    for (i, v) in uniform_points(seed + 1, n, [1.0; 3]).into_iter().enumerate() {
        particles.velocity.set(i, v.map(|v| v - 0.5));
    }
    System {
        sim_box: SimBox::new([0.0; 3], lengths, [boundary; 3]).unwrap(),
        particles,
        radii: Radii::Uniform(cutoff),
        interaction: Interaction::lennard_jones(),
    }
}

/// Particles that move by a tenth of a unit or less in a step.
fn moving(particles: &Particles) -> Moving<'_> {
    let [position, velocity] = [&particles.position, &particles.velocity].map(|of| of.axes().map(|axis| &axis[..]));
    Moving { position, velocity, force: [&[]; 3], kind: &[], types: &[], dt: 0.02 }
}

/// `life` is how many steps the list is thought to serve.
fn build(mut system: System, skin: f32, life: u32) -> Built {
    let physics = Physics::new(&system);
    let grid = sort(&mut system, skin);
    let mut clusters = Clusters::default();
    clusters.blocks.motion.life = life;
    assert!(clusters.build(&grid, &physics, moving(&system.particles), Keeping::Strict { skin }, u64::MAX));
    Built { system, physics, clusters }
}

/// Puts the particles into the order of clusters. Gives the grid that they are in.
fn sort(system: &mut System, skin: f32) -> Grid {
    let mut grid = Grid::default();
    let [x, y, z] = system.particles.position.axes();
    let radii = InputRadii::Uniform(system.radii.largest() + skin);
    grid.build(&Input { sim_box: &system.sim_box, position: [x, y, z], radii, kind: &[] });
    let order = grid.order().to_vec();
    assert_eq!(order.len(), grid.slots().len());
    let sorted = |of: &Vec3s| order.iter().map(|&i| of.get(i as usize)).collect::<Vec<_>>();
    let (position, velocity) = (sorted(&system.particles.position), sorted(&system.particles.velocity));
    system.particles = Particles::at(position);
    velocity.iter().enumerate().for_each(|(i, v)| system.particles.velocity.set(i, *v));
    grid
}

impl Built {
    /// How often each pair of particles and image is listed, as (i, j, image) with i < j.
    fn listed(&self, lists: impl Fn(&super::list::Task) -> &Pairs) -> BTreeMap<(usize, usize, [i8; 3]), u32> {
        let blocks = &self.clusters.blocks;
        let particle = |b: usize, lane: usize| {
            let particles = blocks.particles(b);
            (lane < particles.len()).then(|| particles.start + lane)
        };
        let mut seen = BTreeMap::new();
        for list in self.clusters.list.tasks.iter().map(lists) {
            for segment in &list.segments {
                let (cluster, half) = (segment.cluster as usize, segment.cluster as usize % 2);
                for (k, &b) in list.blocks[segment.start as usize..segment.end as usize].iter().enumerate() {
                    assert_eq!(segment.own && k == 0, b as usize == cluster / 2, "a cluster's own block comes first");
                    for i in 0..CLUSTER {
                        for j in 0..BLOCK {
                            let pair = own_pairs(cluster)[i / 2] >> (8 * (i % 2) + j) & 1 == 1;
                            if segment.own && k == 0 && !pair {
                                continue;
                            }
                            let (i, j) = (particle(cluster / 2, CLUSTER * half + i), particle(b as usize, j));
                            let (Some(i), Some(j)) = (i, j) else { continue };
                            assert!(i < j, "{i} {j}");
                            *seen.entry((i, j, segment.image)).or_insert(0) += 1;
                        }
                    }
                }
            }
        }
        seen
    }

    /// The pairs within `range`, as (i, j, image) with i < j.
    fn pairs_within(&self, range: f32) -> Vec<(usize, usize, [i8; 3])> {
        let (sim_box, positions) = (&self.system.sim_box, &self.system.particles.position);
        let mut pairs = Vec::new();
        for i in 0..positions.len() {
            for j in i + 1..positions.len() {
                for image in sim_box.images() {
                    let d = displacement(positions.get(i), positions.get(j), sim_box.shift(image));
                    if squared_length(d) < range * range {
                        pairs.push((i, j, image));
                    }
                }
            }
        }
        pairs
    }
}

/// Boxes that are large, barely two cutoffs wide, flat and long; systems of nothing, one, seven, and more.
fn systems() -> Vec<System> {
    let mut systems = Vec::new();
    for boundary in [Boundary::Periodic, Boundary::Open, Boundary::Wall] {
        for n in [0, 1, 2, 7, 8, 9, 33, 400] {
            systems.push(gas(n, [8.0; 3], boundary, 1.5, n as u64));
            systems.push(gas(n, [3.6; 3], boundary, 1.5, n as u64 + 1));
            systems.push(gas(n, [40.0, 3.7, 4.0], boundary, 1.5, n as u64 + 2));
            systems.push(gas(n, [3.7, 3.9, 60.0], boundary, 1.5, n as u64 + 3));
        }
    }
    systems
}

#[test]
fn every_pair_within_cutoff_and_skin_is_listed_once() {
    for system in systems() {
        let what = format!("{:?}, {} particles", system.sim_box, system.particles.len());
        let built = build(system, 0.3, 0);
        let outer = built.listed(|task| &task.outer);
        for pair in built.pairs_within(1.8) {
            assert_eq!(outer.get(&pair), Some(&1), "{what}: {pair:?}");
        }
        assert!(outer.values().all(|&count| count == 1), "{what}: a pair is listed twice");
        let inner = built.listed(|task| &task.inner);
        for pair in built.pairs_within(1.5) {
            assert_eq!(inner.get(&pair), Some(&1), "{what}: {pair:?} is pruned");
        }
        assert!(inner.keys().all(|pair| outer.contains_key(pair)), "{what}");
    }
}

#[test]
fn padding_is_listed_nowhere_and_blocks_hold_every_particle_once() {
    for system in systems() {
        let built = build(system, 0.3, 0);
        let blocks = &built.clusters.blocks;
        let n = built.system.particles.len();
        let mut next = 0;
        for b in 0..blocks.len() {
            let particles = blocks.particles(b);
            assert_eq!(particles.start, next);
            assert!((1..=BLOCK).contains(&particles.len()));
            next = particles.end;
            for lane in 0..BLOCK {
                let at = [0, 1, 2].map(|axis| blocks.position[b].0[axis][lane]);
                match particles.start + lane {
                    i if i < particles.end => assert_eq!(at, built.system.particles.position.get(i)),
                    _ => assert!(at[0] > 1e37),
                }
            }
        }
        assert_eq!(next, n);
    }
}

/// Neighbours of each particle, and the forces on them.
fn evaluate(built: &mut Built, grid: Option<&Grid>) -> (Vec<u32>, [Vec<f32>; 3]) {
    let n = built.system.particles.len();
    let mut neighbors = vec![0; n];
    let mut force = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
    let out = Output {
        force: force.each_mut().map(|axis| &mut axis[..]),
        energy: &mut vec![0.0; n],
        virial: &mut vec![0.0; n],
        neighbors: &mut neighbors,
    };
    assert!(built.clusters.evaluate(&built.physics, grid, false, out));
    (neighbors, force)
}

fn neighbors_by_oracle(system: &System) -> Vec<u32> {
    let mut neighbors = vec![0; system.particles.len()];
    for pair in oracle::pairs(&system.sim_box, &system.particles, &system.radii) {
        neighbors[pair.i as usize] += 1;
        neighbors[pair.j as usize] += 1;
    }
    neighbors
}

/// Particles drift, cross faces and meet; the lists are asked for as in a run. Some do what their velocities foretell,
/// others stop or turn back halfway.
#[test]
fn no_pair_is_missed_while_particles_move_and_cross_faces() {
    for life in [0, 30, 1000] {
        let mut built = build(gas(300, [5.0, 6.0, 7.0], Boundary::Periodic, 1.5, 5), 0.6, life);
        let n = built.system.particles.len();
        let (mut served, mut crossed) = (0, 0);
        for step in 0..60 {
            for i in 0..n {
                let particles = &mut built.system.particles;
                if step == 7 && i % 3 > 0 {
                    let turned = particles.velocity.get(i).map(|v| -v * (i % 3 - 1) as f32);
                    particles.velocity.set(i, turned);
                }
                let (x, v) = (particles.position.get(i), particles.velocity.get(i));
                let moved = [0, 1, 2].map(|axis| x[axis] + 0.02 * v[axis]);
                let (wrapped, crossings) = built.system.sim_box.wrap(moved);
                crossed += u32::from(crossings != [0; 3]);
                particles.position.set(i, wrapped);
            }
            if !built.clusters.refresh(moving(&built.system.particles), || true) {
                break;
            }
            served += 1;
            assert_eq!(evaluate(&mut built, None).0, neighbors_by_oracle(&built.system), "after {served} evaluations");
        }
        assert!((10..60).contains(&served), "the list served {served} evaluations");
        assert!(crossed > 10, "{crossed} particles crossed a face");
    }
}

/// How often lists are pruned while particles fall from rest for some steps, with forces known or not.
fn prunings_of_a_fall(forces_known: bool) -> u64 {
    let mut system = gas(300, [5.0, 6.0, 7.0], Boundary::Periodic, 1.5, 5);
    system.particles.velocity = Vec3s::zeros(300);
    let types = [ParticleType { mass: 0.5, ..ParticleType::default() }];
    let mut built = build(system, 0.6, 0);
    // An acceleration of ten along x.
    let (force, zero) = ([5.0; 300], [0.0; 300]);
    let force = if forces_known { [&force[..], &zero, &zero] } else { [&[][..]; 3] };
    for step in 0..6 {
        let particles = &mut built.system.particles;
        for i in (0..300).filter(|_| step > 0) {
            let ([x, y, z], v) = (particles.position.get(i), 0.2 * (step as f32 - 0.5));
            particles.velocity.set(i, [v, 0.0, 0.0]);
            particles.position.set(i, built.system.sim_box.wrap([x + 0.02 * v, y, z]).0);
        }
        let moving = Moving { force, types: &types, ..moving(particles) };
        if step == 0 {
            assert!(built.clusters.blocks.plan_motion(moving));
            built.clusters.prune();
        } else {
            assert!(built.clusters.refresh(moving, || true));
        }
        assert_eq!(evaluate(&mut built, None).0, neighbors_by_oracle(&built.system), "at step {step}");
    }
    built.clusters.prunings
}

#[test]
fn lists_are_pruned_less_often_where_forces_are_known() {
    let (known, unknown) = (prunings_of_a_fall(true), prunings_of_a_fall(false));
    assert_eq!(known, 2, "when they are made, and once by the test");
    assert!(unknown > known, "{unknown}");
}

/// The list is pruned while a particle is beyond the face.
#[test]
fn a_particle_that_crosses_a_face_to_and_fro_keeps_its_pairs() {
    let mut built = build(gas(300, [5.0, 6.0, 7.0], Boundary::Periodic, 1.5, 5), 0.6, 0);
    let x = |particles: &Particles, i: usize| particles.position.get(i)[0];
    let particles = &built.system.particles;
    let last = (0..particles.len()).max_by(|&a, &b| x(particles, a).total_cmp(&x(particles, b))).unwrap();
    assert!(x(particles, last) > 4.95);
    for (step, to) in [4.999, 0.001, 4.999, 0.002, 4.998, 0.001].into_iter().enumerate() {
        let [_, y, z] = built.system.particles.position.get(last);
        built.system.particles.position.set(last, [to, y, z]);
        assert!(built.clusters.refresh(moving(&built.system.particles), || true));
        if step == 1 {
            assert!(built.clusters.blocks.plan_motion(moving(&built.system.particles)));
            built.clusters.prune();
        }
        assert_eq!(evaluate(&mut built, None).0, neighbors_by_oracle(&built.system), "at step {step}");
    }
}

#[test]
fn batches_find_the_pairs_of_lists_and_give_their_forces() {
    for mut system in systems() {
        let what = format!("{:?}, {} particles", system.sim_box, system.particles.len());
        let mut clusters = Clusters::default();
        let grid = sort(&mut system, 0.0);
        let mut listed = build(system.clone(), 0.3, 0);
        let expected = listed.system.particles.position.clone();
        clusters.build_without_list(&grid, &listed.physics, moving(&system.particles));
        let mut built = Built { physics: Physics::new(&system), system, clusters };
        let (neighbors, force) = evaluate(&mut built, Some(&grid));
        assert_eq!(neighbors, neighbors_by_oracle(&built.system), "{what}");
        if expected == built.system.particles.position {
            let (_, by_list) = evaluate(&mut listed, None);
            let largest = force.iter().flatten().fold(0.0f32, |m, f| m.max(f.abs()));
            for (a, b) in force.iter().flatten().zip(by_list.iter().flatten()) {
                assert!((a - b).abs() <= 1e-5 * largest, "{what}: {a} {b}");
            }
        }
    }
}

/// Forces and energies of the blocks' particles by one law and instruction set.
fn by_vectors<P: Law>(isa: Isa, built: &Built, law: P) -> Vec<[f64; 6]> {
    let Clusters { blocks, list, .. } = &built.clusters;
    let zeros = vec![Parts::default(); blocks.len()];
    let (mut force, mut energy, mut only) = (zeros.clone(), zeros.clone(), zeros);
    for task in &list.tasks {
        let list = &task.inner;
        let crossed = &mut Vec::new();
        isa.run(Kernel::<P, true> { law, blocks, list, force: &mut force, energy: &mut energy, crossed });
        isa.run(Kernel::<P, false> { law, blocks, list, force: &mut only, energy: &mut [], crossed });
    }
    let mut sums = vec![[0.0; 6]; built.system.particles.len()];
    for b in 0..blocks.len() {
        for (lane, i) in blocks.particles(b).enumerate() {
            for k in 0..3 {
                let sum = |of: &[Parts]| of[b].0[k][lane] + of[b].0[k][lane + BLOCK];
                assert_eq!(sum(&force), sum(&only), "{isa:?}: energies change forces");
                sums[i][k] = f64::from(sum(&force) * law.scale());
                sums[i][3 + k] = f64::from(sum(&energy));
            }
            sums[i][3] *= f64::from(law.scale());
            sums[i][4] *= f64::from(law.scale());
        }
    }
    sums
}

/// A liquid of three types in a box barely two cutoffs wide, whose positions are no lattice's.
fn mixture(truncation: Truncation) -> System {
    let length = 5.2;
    let jitter = uniform_points(11, 125, [0.12; 3]);
    let place = |k: usize, axis: usize| [k % 5, k / 5 % 5, k / 25][axis] as f32 * (length / 5.0) + jitter[k][axis];
    let mut system = gas(0, [length; 3], Boundary::Periodic, 2.5, 0);
    system.particles = Particles::at((0..125).map(|k| [place(k, 0), place(k, 1), place(k, 2)]));
    system.interaction.truncation = truncation;
    system.interaction.types = [(1.0, 1.0), (0.6, 0.9), (1.7, 0.95)]
        .map(|(epsilon, sigma)| ParticleType { epsilon, sigma, ..ParticleType::default() })
        .to_vec();
    system
}

#[test]
fn kernels_of_every_instruction_set_equal_the_oracle() {
    for truncation in [Truncation::Cut, Truncation::Energy, Truncation::Force] {
        for typed in [false, true] {
            let mut system = mixture(truncation);
            if !typed {
                system.interaction.types.truncate(1);
            }
            let mut built = build(system, 0.1, 0);
            if typed {
                let kinds: Vec<u32> = (0..built.system.particles.len() as u32).map(|i| i * 7 % 3).collect();
                built.system.particles.kind.clone_from(&kinds);
                let blocks = &mut built.clusters.blocks;
                let of = |b: usize| kinds[blocks.particles(b)].to_vec();
                let of_blocks: Vec<Vec<u32>> = (0..blocks.len()).map(of).collect();
                blocks.kind.extend(
                    of_blocks.iter().map(|k| std::array::from_fn::<_, BLOCK, _>(|l| k.get(l).copied().unwrap_or(0))),
                );
            }
            let pairs = oracle::pairs(&built.system.sim_box, &built.system.particles, &built.system.radii);
            let reference = oracle::evaluate_pairs(&built.system, &pairs);
            for isa in Isa::available() {
                let mut found = Vec::new();
                if let (false, Some(law)) = (typed, Plain::new(&built.physics)) {
                    assert!(truncation != Truncation::Force);
                    found.push(by_vectors(isa, &built, law));
                }
                found.push(match truncation {
                    Truncation::Force => by_vectors(isa, &built, Typed::<true>::new(&built.physics)),
                    _ => by_vectors(isa, &built, Typed::<false>::new(&built.physics)),
                });
                for sums in found {
                    let what = format!("{isa:?}, {truncation:?}, types: {typed}");
                    let of = |k: usize| sums.iter().map(|s| s[k]).sum::<f64>();
                    assert_eq!(of(5), 2.0 * reference.pairs as f64, "{what}");
                    let close = |found: f64, exact: f64| (found - exact).abs() < 2e-6 * sums.len() as f64 * 50.0;
                    assert!(close(0.5 * of(3), reference.potential_energy), "{what}: {}", 0.5 * of(3));
                    assert!(close(0.5 * of(4), reference.virial), "{what}: {}", 0.5 * of(4));
                    for (i, sums) in sums.iter().enumerate() {
                        for axis in 0..3 {
                            let (found, exact) = (sums[axis], reference.force[i][axis]);
                            // Each of some fifty terms of up to a hundred is right to a few ulp.
                            assert!((found - exact).abs() < 2e-3, "{what}: force {axis} on {i}: {found}, not {exact}");
                        }
                    }
                }
            }
        }
    }
}
