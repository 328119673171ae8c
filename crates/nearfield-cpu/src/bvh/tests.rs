//! The tree against brute force: what it proposes, once filtered by the predicate, is exactly the set of pairs.

use super::{Bvh, Probe, Refit};
use crate::{GroupBox, Input, InputRadii, Run, Structure, Vicinity};
use nearfield_core::predicate::{displacement, is_neighbor, squared_length};
use nearfield_core::{Boundary, Images, SimBox};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg as Rng;

const BOUNDARIES: [[Boundary; 3]; 5] = {
    use Boundary::{Open, Periodic, Wall};
    [[Periodic; 3], [Wall; 3], [Open; 3], [Periodic, Wall, Open], [Open, Periodic, Periodic]]
};

/// A pair found from i: i, j, image.
type Pair = (u32, u32, [i8; 3]);

struct Case {
    name: String,
    sim_box: SimBox,
    positions: Vec<[f32; 3]>,
    radii: Option<Vec<f32>>,
    cutoff: f32,
}

impl Case {
    fn with_input<T>(&self, use_input: impl FnOnce(&Input) -> T) -> T {
        let axes: [Vec<f32>; 3] = std::array::from_fn(|axis| self.positions.iter().map(|p| p[axis]).collect());
        let radii = self.radii.as_deref().map_or(InputRadii::Uniform(self.cutoff), InputRadii::PerParticle);
        let position = [axes[0].as_slice(), &axes[1], &axes[2]];
        use_input(&Input { sim_box: &self.sim_box, position, radii, kind: &[] })
    }

    fn radius(&self, i: u32) -> f32 {
        self.radii.as_ref().map_or(self.cutoff, |radii| radii[i as usize])
    }

    fn holds(&self, pair: Pair) -> bool {
        let (i, j, image) = pair;
        let dr = displacement(self.positions[i as usize], self.positions[j as usize], self.sim_box.shift(image));
        (i != j || image != [0; 3]) && is_neighbor(squared_length(dr), self.radius(j))
    }

    fn pairs(&self) -> Vec<Pair> {
        let n = self.positions.len() as u32;
        let mut images = self.sim_box.images();
        images.sort();
        let mut pairs = Vec::new();
        for i in 0..n {
            for j in 0..n {
                pairs.extend(images.iter().map(|&image| (i, j, image)).filter(|&pair| self.holds(pair)));
            }
        }
        pairs
    }

    /// Moves every particle by up to `step` on each axis, as an integrator would.
    fn drift(&mut self, step: f32, rng: &mut Rng) {
        let (lo, hi) = (self.sim_box.lo(), self.sim_box.hi());
        for position in &mut self.positions {
            let moved: [f32; 3] = position.map(|c| c + rng.random_range(-step..=step));
            *position = self.sim_box.wrap(moved).0;
            for axis in 0..3 {
                if self.sim_box.boundary()[axis] == Boundary::Wall {
                    position[axis] = position[axis].clamp(lo[axis], hi[axis]);
                }
            }
        }
    }
}

/// Every pair that the tree proposes and the predicate accepts.
fn traced(bvh: &Bvh, case: &Case) -> Vec<Pair> {
    let (slots, mut runs, mut pairs) = (bvh.slots(), Vec::new(), Vec::new());
    for g in 0..bvh.n_groups() {
        let real: Vec<usize> = bvh.group(g).filter(|&slot| slots.particle[slot] != u32::MAX).collect();
        let group = GroupBox::around(slots, bvh.group(g), case.cutoff).expect("groups hold particles");
        runs.clear();
        bvh.runs(&group, &mut Vicinity::default(), &mut runs);
        assert_proposed_once(&runs, bvh, &case.name);
        for &i in &real {
            for run in &runs {
                let candidates = &slots.particle[run.start as usize..run.end as usize];
                let candidates = candidates.iter().filter(|&&j| j != u32::MAX);
                let of_i = candidates.map(|&j| (slots.particle[i], j, run.image));
                pairs.extend(of_i.filter(|&pair| case.holds(pair)));
            }
        }
    }
    pairs.sort();
    pairs
}

fn assert_proposed_once(runs: &[Run], bvh: &Bvh, name: &str) {
    let particle = &bvh.slots().particle;
    let slot_images = |run: &Run| (run.start..run.end).map(move |s| (s, run.image)).collect::<Vec<_>>();
    let mut proposed: Vec<_> = runs.iter().flat_map(slot_images).collect();
    proposed.retain(|&(slot, _)| particle[slot as usize] != u32::MAX);
    let mut particles: Vec<_> = proposed.iter().map(|&(slot, image)| (particle[slot as usize], image)).collect();
    let n = proposed.len();
    proposed.sort();
    proposed.dedup();
    particles.sort();
    particles.dedup();
    assert_eq!((proposed.len(), particles.len()), (n, n), "{name}: proposed twice");
}

fn assert_exact(bvh: &Bvh, case: &Case, when: &str) {
    bvh.validate().unwrap_or_else(|problem| panic!("{} {when}: {problem}", case.name));
    let (found, expected) = (traced(bvh, case), case.pairs());
    assert!(found == expected, "{} {when}: {} pairs found, {} expected", case.name, found.len(), expected.len());
}

fn placements(n: usize, length: f32, rng: &mut Rng) -> Vec<(&'static str, Vec<[f32; 3]>)> {
    let uniform: Vec<[f32; 3]> = (0..n).map(|_| [0; 3].map(|_| rng.random_range(0.0..length))).collect();
    let side = (n as f64).cbrt().ceil() as usize;
    let place = |k: usize| [k % side, k / side % side, k / side / side].map(|c| c as f32 * length / side as f32);
    let ball = |scale: f32, rng: &mut Rng| -> Vec<[f32; 3]> {
        let around = |rng: &mut Rng| length / 2.0 + scale * rng.random_range(-1.0..1.0f32).powi(3);
        (0..n).map(|_| [0; 3].map(|_| around(rng))).collect()
    };
    let mut outlier = ball(1e-3 * length, rng);
    if let Some(first) = outlier.first_mut() {
        *first = [0.0; 3];
    }
    let shell = uniform.iter().map(|p| {
        let from_center = p.map(|c| c - length / 2.0);
        let norm = squared_length(from_center).sqrt();
        from_center.map(|c| length / 2.0 + 0.49 * length * c / norm)
    });
    vec![
        ("shell", shell.collect()),
        ("lattice", (0..n).map(place).collect()),
        ("coincident", uniform.iter().map(|_| uniform[rng.random_range(0..n.div_ceil(5))]).collect()),
        ("all equal", vec![[0.0; 3]; n]),
        ("cluster and outlier", outlier),
        ("uniform", uniform),
    ]
}

fn cases(seed: u64) -> Vec<Case> {
    println!("seed {seed}");
    let rng = &mut Rng::seed_from_u64(seed);
    let mut cases = Vec::new();
    for boundary in BOUNDARIES {
        for n in [0, 1, 2, 16, 17, 343] {
            for (name, offsets) in placements(n, 7.0, rng) {
                for (origin, varied) in [(0.0, false), (0.0, true), (-3.5, true), (1e6, false)] {
                    if origin != 0.0 && name != "uniform" {
                        continue;
                    }
                    let sim_box = SimBox::new([origin; 3], [origin + 7.0; 3], boundary).unwrap();
                    // Open axes let particles out, three times as far as the box.
                    let stretch = boundary.map(|b| if b == Boundary::Open { 3.0 } else { 1.0 });
                    let at = |p: &[f32; 3]| sim_box.wrap(std::array::from_fn(|a| origin + p[a] * stretch[a])).0;
                    let positions: Vec<[f32; 3]> = offsets.iter().map(at).collect();
                    let log_uniform = |rng: &mut Rng| 3.5 / 300f32.powf(rng.random());
                    cases.push(Case {
                        name: format!("{name}, {n} at {origin}, {boundary:?}, varied radii: {varied}"),
                        radii: varied.then(|| (0..n).map(|_| log_uniform(rng)).collect()),
                        sim_box,
                        positions,
                        // The spacing of the lattice: ties.
                        cutoff: 1.0,
                    });
                }
            }
        }
    }
    cases
}

fn is_exact_after_build_and_refits(images: Images) {
    for probe in Probe::ALL {
        is_exact_with(probe, images);
    }
}

fn is_exact_with(probe: Probe, images: Images) {
    let rng = &mut Rng::seed_from_u64(11);
    let mut bvh = Bvh::with_probe(probe, images);
    for mut case in cases(3) {
        if case.radii.is_some() && probe != Probe::Point {
            continue;
        }
        case.name = format!("{probe:?}, {}", case.name);
        case.with_input(|input| bvh.build(input));
        assert_exact(&bvh, &case, "after build");
        for step in [0.01, 0.1, 2.0] {
            case.drift(step, rng);
            let refit = case.with_input(|input| bvh.refit(input));
            assert!(images == Images::Ghosts || refit == Refit::Done);
            if refit == Refit::NeedsBuild {
                case.with_input(|input| bvh.build(input));
            }
            assert_exact(&bvh, &case, &format!("after drift {step}, {refit:?}"));
        }
    }
}

#[test]
fn axis_and_edge_rays_find_offsets_on_diagonals_and_edges_of_their_geometry() {
    let side = 6;
    let place = |k: usize| [k % side, k / side % side, k / side / side].map(|c| c as f32);
    for (spacing, cutoffs) in [(1.0f32, [1.0, 2.0, 3.0, 5.0, 6.0]), (0.1, [1.0, 2.0, 3.0, 5.0, 6.0])] {
        for squared in cutoffs {
            let exactly = spacing * f32::sqrt(squared);
            for cutoff in [exactly.next_down(), exactly, exactly.next_up()] {
                for boundary in [[Boundary::Periodic; 3], [Boundary::Open; 3]] {
                    let sim_box = SimBox::new([0.0; 3], [side as f32 * spacing; 3], boundary).unwrap();
                    let case = Case {
                        name: format!("lattice of {spacing}, cutoff {cutoff}, {boundary:?}"),
                        sim_box,
                        positions: (0..side.pow(3)).map(|k| place(k).map(|c| c * spacing)).collect(),
                        radii: None,
                        cutoff,
                    };
                    for (probe, &images) in Probe::ALL.iter().flat_map(|p| Images::ALL.iter().map(move |i| (p, i))) {
                        let mut bvh = Bvh::with_probe(*probe, images);
                        case.with_input(|input| bvh.build(input));
                        assert_exact(&bvh, &case, &format!("by {probe:?} and {images}"));
                    }
                }
            }
        }
    }
}

#[test]
fn gamma_rays_find_exactly_the_pairs() {
    is_exact_after_build_and_refits(Images::Gamma);
}

#[test]
fn instances_find_exactly_the_pairs() {
    is_exact_after_build_and_refits(Images::Instances);
}

#[test]
fn ghosts_find_exactly_the_pairs() {
    is_exact_after_build_and_refits(Images::Ghosts);
}

fn periodic_case(n: usize, seed: u64) -> Case {
    println!("seed {seed}");
    let rng = &mut Rng::seed_from_u64(seed);
    Case {
        name: format!("periodic {n}"),
        sim_box: SimBox::cubic(7.0, Boundary::Periodic).unwrap(),
        positions: (0..n).map(|_| [0; 3].map(|_| rng.random_range(0.0..7.0))).collect(),
        radii: None,
        cutoff: 1.0,
    }
}

#[test]
fn ghosts_last_while_particles_stay_within_the_margin_even_if_wrapped() {
    let mut case = periodic_case(1000, 5);
    let mut bvh = Bvh::new(Images::Ghosts);
    case.with_input(|input| bvh.build(input));
    let before = case.positions.clone();
    case.drift(0.19, &mut Rng::seed_from_u64(6));
    let wrapped = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).any(|axis| (a[axis] - b[axis]).abs() > 3.5);
    assert!(before.iter().zip(&case.positions).any(wrapped), "the test needs particles that cross a face");
    assert_eq!(case.with_input(|input| bvh.refit(input)), Refit::Done);
    assert_exact(&bvh, &case, "after drift");
}

#[test]
fn outrun_ghosts_need_a_build() {
    let mut case = periodic_case(1000, 7);
    let mut bvh = Bvh::new(Images::Ghosts);
    case.with_input(|input| bvh.build(input));
    case.drift(1.0, &mut Rng::seed_from_u64(8));
    assert_eq!(case.with_input(|input| bvh.refit(input)), Refit::NeedsBuild);
    case.with_input(|input| bvh.build(input));
    assert_exact(&bvh, &case, "after build");
}

#[test]
fn an_input_of_another_size_or_kind_of_radii_needs_a_build() {
    let mut case = periodic_case(40, 9);
    let mut bvh = Bvh::new(Images::Gamma);
    assert_eq!(case.with_input(|input| bvh.refit(input)), Refit::NeedsBuild, "before any build");
    case.with_input(|input| bvh.build(input));
    case.radii = Some(vec![1.0; 40]);
    assert_eq!(case.with_input(|input| bvh.refit(input)), Refit::NeedsBuild, "other kind of radii");
    case.radii = None;
    case.positions.pop();
    assert_eq!(case.with_input(|input| bvh.refit(input)), Refit::NeedsBuild, "other size");
}

#[test]
fn large_inputs_take_the_parallel_paths_and_stay_valid() {
    for images in Images::ALL {
        let mut case = periodic_case(70_000, 10);
        let mut bvh = Bvh::new(*images);
        case.with_input(|input| bvh.build(input));
        bvh.validate().unwrap();
        let fresh = bvh.quality();
        case.drift(0.1, &mut Rng::seed_from_u64(12));
        assert_eq!(case.with_input(|input| bvh.refit(input)), Refit::Done);
        bvh.validate().unwrap();
        assert!(bvh.quality() > fresh, "{images}: motion must show in the quality");
    }
}

#[test]
fn size_classes_keep_large_boxes_out_of_the_leaves_of_small_ones() {
    let mut case = periodic_case(20_000, 13);
    let quality = |case: &Case| {
        let mut bvh = Bvh::new(Images::Gamma);
        case.with_input(|input| bvh.build(input));
        bvh.quality()
    };
    case.cutoff = 0.01;
    let small = quality(&case);
    case.radii = Some((0..20_000).map(|i| if i % 200 == 0 { 1.0 } else { 0.01 }).collect());
    assert!(quality(&case) < 2.0 * small, "{} against {small}", quality(&case));
}

#[test]
fn a_repeated_build_allocates_nothing() {
    let case = periodic_case(20_000, 14);
    for images in Images::ALL {
        let mut bvh = Bvh::new(*images);
        case.with_input(|input| bvh.build(input));
        let (bytes, slots) = (bvh.bytes(), bvh.slots().x.as_ptr());
        case.with_input(|input| bvh.build(input));
        assert_eq!((bvh.bytes(), bvh.slots().x.as_ptr()), (bytes, slots), "{images}");
    }
}

#[test]
fn pairs_at_the_edge_of_range_across_a_face_survive_rounding() {
    println!("seed 15");
    let rng = &mut Rng::seed_from_u64(15);
    let mut accepted = 0;
    for (&probe, images) in Probe::ALL.iter().flat_map(|probe| Images::ALL.iter().map(move |images| (probe, images))) {
        let mut bvh = Bvh::with_probe(probe, *images);
        for _ in 0..5000 {
            // Large coordinates, coarser at one face than at the other: all sums round, by far more than the relative
            // error of the radius.
            let origin: f32 = rng.random_range(-2000.0..0.0);
            let upper = [origin + rng.random_range(500.0..2000.0); 3];
            let sim_box = SimBox::new([origin; 3], upper, BOUNDARIES[0]).unwrap();
            let cutoff = rng.random_range(0.5..2.0f32);
            let x = sim_box.hi()[0] - rng.random_range(0.0..cutoff);
            // Along an axis, and where spheres and squares are only just large enough.
            let direction = [[1.0, 0.0, 0.0], [1.0; 3], [1.0, 1.0, 0.0]][rng.random_range(0..3)];
            let step = cutoff / squared_length(direction).sqrt();
            let middle = 0.5 * (origin + upper[0]);
            let start = [x, middle, middle];
            let across = sim_box.wrap(std::array::from_fn(|axis| start[axis] + step * direction[axis])).0;
            for ulps in -6..=6i32 {
                let bits = across[0].to_bits().wrapping_add_signed(ulps);
                let positions = vec![start, [f32::from_bits(bits), across[1], across[2]]];
                let case = Case { name: String::new(), sim_box, positions, radii: None, cutoff };
                if !case.holds((0, 1, [1, 0, 0])) || sim_box.wrap(case.positions[1]).0 != case.positions[1] {
                    continue;
                }
                accepted += 1;
                case.with_input(|input| bvh.build(input));
                let mut runs = Vec::new();
                bvh.runs(
                    &GroupBox { lo: case.positions[0], hi: case.positions[0], radius: cutoff },
                    &mut Vicinity::default(),
                    &mut runs,
                );
                let proposes = |run: &Run| {
                    run.image == [1, 0, 0] && bvh.slots().particle[run.start as usize..run.end as usize].contains(&1)
                };
                assert!(
                    runs.iter().any(proposes),
                    "{probe:?}, {images}: {:?} in {sim_box:?}, cutoff {cutoff}",
                    case.positions
                );
            }
        }
    }
    assert!(accepted > 10_000, "only {accepted} of the trials are in range");
}

#[test]
fn the_box_of_a_group_leaves_padding_out() {
    let case = periodic_case(17, 16);
    let mut bvh = Bvh::new(Images::Gamma);
    case.with_input(|input| bvh.build(input));
    let bounds = GroupBox::around(bvh.slots(), bvh.group(1), 1.0).unwrap();
    let last = case.positions[bvh.slots().particle[16] as usize];
    assert_eq!((bounds.lo, bounds.hi), (last, last));
}
