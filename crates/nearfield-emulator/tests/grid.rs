//! Cells and testing all pairs find the neighbours of the reference, whatever the system.

use nearfield_conformance::cases::{self, Case};
use nearfield_core::{Boundary, ListKind, NeighborList, Radii, System, oracle};
use nearfield_cuda::{
    Buffer, DeviceList, Gpu,
    grid::{self, Candidates, ForceQuery, Grid, ListQuery, Pairs, Survey},
};
use nearfield_emulator::Emulator;
use nearfield_kernels::{
    Float4, Ptr,
    layouts::{Box3, Law, Results},
};
use std::sync::Arc;

/// How forces are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum By {
    Cells,
    CellsOnce,
    AllPairs,
}

const EVERY_WAY: [By; 3] = [By::Cells, By::CellsOnce, By::AllPairs];

/// A system on the emulator, in an order of memory that is not that of the input.
struct Device {
    gpu: Arc<dyn Gpu>,
    n: usize,
    space: Box3,
    law: Law,
    grid: Grid,
    position: Buffer<Float4>,
    velocity: Buffer<Float4>,
    id: Buffer<u32>,
    input: Vec<u32>,
    pairs: Buffer<Float4>,
    force: Buffer<Float4>,
    energy: Buffer<f64>,
    virial: Buffer<f64>,
    neighbors: Buffer<u32>,
    exact: Buffer<i64>,
}

impl Device {
    fn new(system: &System) -> Self {
        let gpu: Arc<dyn Gpu> = Arc::new(Emulator::new().expect("kernels were compiled"));
        let (n, sim_box) = (system.particles.len(), &system.sim_box);
        let input: Vec<u32> = (0..n as u32).rev().collect();
        let position: Vec<Float4> = input
            .iter()
            .map(|&i| {
                let ([x, y, z], r) = (system.particles.position.get(i as usize), system.radii.get(i as usize));
                Float4::new(x, y, z, if system.radii.is_uniform() { 0.0 } else { r })
            })
            .collect();
        let cutoff = system.radii.is_uniform().then(|| system.radii.largest());
        let space = Box3 {
            lo: sim_box.lo(),
            hi: sim_box.hi(),
            length: sim_box.lengths(),
            boundary: sim_box.boundary().map(|b| b as u32),
        };
        let mut device = Self {
            n,
            space,
            law: Law::default(),
            grid: Grid::new(&gpu),
            position: Buffer::new(&gpu, "positions"),
            velocity: Buffer::new(&gpu, "velocities"),
            id: Buffer::new(&gpu, "input indices"),
            pairs: Buffer::new(&gpu, "coefficients"),
            force: Buffer::new(&gpu, "forces"),
            energy: Buffer::new(&gpu, "energies"),
            virial: Buffer::new(&gpu, "virials"),
            neighbors: Buffer::new(&gpu, "neighbour counts"),
            exact: Buffer::new(&gpu, "exact sums"),
            input,
            gpu,
        };
        device.position.upload(&position).unwrap();
        device.velocity.upload(&vec![Float4::default(); n]).unwrap();
        device.id.upload(&device.input).unwrap();
        let sigma = 0.4 * system.radii.largest();
        device.pairs.upload(&[Float4::new(1.0, sigma, 0.0, 0.0)]).unwrap();
        device.law = Law {
            potential: 4,
            n_types: 1,
            variable: u32::from(cutoff.is_none()),
            cutoff: cutoff.unwrap_or(0.0),
            sigma_per_range: 0.4,
            cap: f32::INFINITY,
            force_quanta: 2f32.powi(34),
            energy_quanta: 2f32.powi(34),
            pairs: device.pairs.ptr(),
            ..Law::default()
        };
        device.grid.plan(&Survey { n, sample: &position, sim_box, cutoff, largest: system.radii.largest() });
        device.build();
        device
    }

    fn build(&mut self) {
        // SAFETY: there are n positions.
        unsafe { self.grid.build(&*self.gpu, self.position.ptr(), self.n, self.law.variable != 0) }.unwrap();
    }

    fn candidates(&self, cells: bool) -> Candidates<'_> {
        if cells { Candidates::Cells(&self.grid) } else { Candidates::All { position: self.position.ptr(), n: self.n } }
    }

    fn zero(&mut self) {
        self.force.upload(&vec![Float4::default(); self.n]).unwrap();
        self.energy.upload(&vec![0.0; self.n]).unwrap();
        self.virial.upload(&vec![0.0; self.n]).unwrap();
        self.neighbors.upload(&vec![0; self.n]).unwrap();
        self.exact.upload(&vec![0; 5 * self.n]).unwrap();
    }

    fn evaluate(&mut self, by: By, energy: bool, exact: bool) {
        self.zero();
        let results = Results {
            force: self.force.ptr(),
            energy: self.energy.ptr(),
            virial: self.virial.ptr(),
            neighbors: self.neighbors.ptr(),
            exact: self.exact.ptr(),
        };
        let (law, space, velocity) = (self.law, self.space, self.velocity.ptr());
        let pairs = if by == By::CellsOnce { Pairs::Once } else { Pairs::Directed };
        let query = ForceQuery { law, space, velocity, results, energy, exact, pairs };
        // SAFETY: all arrays are as long as results need them to be.
        unsafe { grid::forces(&*self.gpu, self.candidates(by != By::AllPairs), &query) }.unwrap();
    }

    /// Forces, energies and neighbour counts in input order.
    fn results(&self) -> Vec<([f32; 3], f64, u32)> {
        let (force, energy) = (self.force.download().unwrap(), self.energy.download().unwrap());
        let neighbors = self.neighbors.download().unwrap();
        let mut out = vec![Default::default(); self.n];
        for (place, &id) in self.input.iter().enumerate() {
            let f = force[place];
            out[id as usize] = ([f.x, f.y, f.z], energy[place], neighbors[place]);
        }
        out
    }

    fn list_on_device(&self, cells: bool, kind: ListKind, images: bool) -> DeviceList {
        let mut list = DeviceList::new(&self.gpu);
        let query = ListQuery { law: self.law, space: self.space, id: self.id.ptr(), kind, images };
        // SAFETY: every input index is there once.
        unsafe { grid::list(&*self.gpu, self.candidates(cells), &query, &mut list) }.unwrap();
        list
    }

    fn list(&self, cells: bool, kind: ListKind) -> NeighborList {
        let list = self.list_on_device(cells, kind, true);
        let image = |c: u8| [(c % 3) as i8 - 1, (c / 3 % 3) as i8 - 1, (c / 9) as i8 - 1];
        NeighborList {
            kind,
            offsets: list.offset.download().unwrap(),
            indices: list.index.download().unwrap(),
            shifts: Some(list.image.download().unwrap().into_iter().map(image).collect()),
            distances: None,
        }
    }
}

/// Sorted rows.
fn rows(list: &DeviceList) -> Vec<Vec<u32>> {
    let (offsets, indices) = (list.offset.download().unwrap(), list.index.download().unwrap());
    let row = |ends: &[u64]| {
        let mut row = indices[ends[0] as usize..ends[1] as usize].to_vec();
        row.sort_unstable();
        row
    };
    offsets.windows(2).map(row).collect()
}

fn systems() -> Vec<Case> {
    let mut all = cases::all();
    all.extend((0..20).map(|seed| Case { name: format!("random {seed}"), system: cases::random(seed) }));
    all.retain(|case| !case.system.particles.is_empty());
    all
}

/// Neighbours of each particle by the reference.
fn expected_counts(system: &System) -> Vec<u32> {
    let mut count = vec![0; system.particles.len()];
    for pair in oracle::pairs(&system.sim_box, &system.particles, &system.radii) {
        count[pair.i as usize] += 1;
        count[pair.j as usize] += 1;
    }
    count
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn neighbour_counts_are_those_of_the_reference() {
    for Case { name, system } in systems() {
        let expected = expected_counts(&system);
        let mut device = Device::new(&system);
        for by in EVERY_WAY {
            device.evaluate(by, true, false);
            let counts: Vec<u32> = device.results().iter().map(|r| r.2).collect();
            assert_eq!(counts, expected, "{name}, by {by:?}");
        }
    }
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn lists_are_those_of_the_reference() {
    for Case { name, system } in systems() {
        let expected = oracle::pairs(&system.sim_box, &system.particles, &system.radii);
        let device = Device::new(&system);
        for cells in [true, false] {
            for kind in [ListKind::Full, ListKind::Half] {
                let list = device.list(cells, kind);
                assert_eq!(oracle::canonical(&list), expected, "{name}, cells {cells}, {kind:?}");
                let ascending = (0..list.n_particles())
                    .all(|i| kind == ListKind::Full || list.row_range(i).all(|e| list.indices[e] as usize > i));
                assert!(ascending, "{name}: a half list holds larger indices only");
            }
        }
    }
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn lists_found_by_one_search_hold_what_those_found_by_two_do() {
    let mut n_at_once = 0;
    for Case { name, system } in systems() {
        let device = Device::new(&system);
        for kind in [ListKind::Full, ListKind::Half] {
            let list = device.list_on_device(true, kind, false);
            n_at_once += usize::from(list.at_once);
            assert_eq!(rows(&list), rows(&device.list_on_device(true, kind, true)), "{name}, {kind:?}");
        }
    }
    assert!(n_at_once > 10, "{n_at_once} lists were found by one search");
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn a_list_with_rows_longer_than_expected_is_found_by_two_searches() {
    // A clump of 120 among 4000 that have hardly any neighbours.
    let sim_box = cases::cube(100.0, [Boundary::Periodic; 3]);
    let mut positions = cases::uniform(4000, &sim_box, 1);
    for (i, position) in positions[..120].iter_mut().enumerate() {
        *position = [50.0 + 0.001 * i as f32, 50.0, 50.0];
    }
    let system = cases::soft(sim_box, positions, Radii::Uniform(1.0));
    let device = Device::new(&system);
    let list = device.list_on_device(true, ListKind::Full, false);
    assert!(!list.at_once);
    let rows = rows(&list);
    assert!(rows[..120].iter().all(|row| row.len() >= 119));
    assert_eq!(rows.iter().map(|row| row.len() as u32).collect::<Vec<_>>(), expected_counts(&system));
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn order_independent_sums_are_the_same_by_cells_and_by_all_pairs() {
    for Case { name, system } in systems() {
        let mut device = Device::new(&system);
        // One class of cells stores numbers, several leave quanta: the numbers are of tests of their own.
        if Candidates::Cells(&device.grid).scatters(Pairs::Directed) {
            continue;
        }
        let mut found = [By::Cells, By::AllPairs].map(|by| {
            device.evaluate(by, true, true);
            device.results()
        });
        let [cells, all] = &mut found;
        assert_eq!(cells, all, "{name}");
    }
}

/// Compared by the largest force there is, and at least by that of one pair: on lattices the sums cancel.
#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn fast_kernels_give_the_forces_of_those_for_any_law() {
    for Case { name, system } in systems() {
        let mut device = Device::new(&system);
        let sigma = 0.4 * f64::from(system.radii.largest());
        let uniform = matches!(system.radii, Radii::Uniform(_));
        device.law.potential = 0;
        device.law.cap = (100.0 / (sigma * sigma)) as f32;
        device.law.lj_repulsion = if uniform { (48.0 * sigma.powi(12)) as f32 } else { 1.0 };
        device.law.lj_attraction = (24.0 * sigma.powi(6)) as f32;
        // The fast kernels compute sigma^12, which must be a normal number.
        if uniform && !(1e-36..1e36).contains(&sigma.powi(12)) {
            continue;
        }
        device.evaluate(By::AllPairs, true, false);
        let expected = device.results();
        let scale = expected.iter().flat_map(|r| r.0).fold(100.0 / sigma as f32, |m, f| m.max(f.abs()));
        for by in EVERY_WAY {
            device.evaluate(by, false, false);
            for (i, (found, expected)) in device.results().iter().zip(&expected).enumerate() {
                for axis in 0..3 {
                    let difference = (found.0[axis] - expected.0[axis]).abs();
                    assert!(difference < 1e-5 * scale, "{name}, by {by:?}, {i}: {found:?} and {expected:?}");
                }
            }
        }
    }
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn cells_planned_for_other_positions_are_right() {
    for seed in 20..40 {
        let mut system = cases::random(seed);
        let mut device = Device::new(&system);
        let (lo, length) = (system.sim_box.lo(), system.sim_box.lengths());
        let squeezed = |p: [f32; 3]| std::array::from_fn(|a| lo[a] + 0.2 * (p[a] - lo[a]) + 0.7 * length[a]);
        let moved: Vec<[f32; 3]> = (0..device.n).map(|i| squeezed(system.particles.position.get(i))).collect();
        system = cases::soft(system.sim_box, moved, system.radii);
        let mut position = device.position.download().unwrap();
        for (place, &id) in device.input.iter().enumerate() {
            let [x, y, z] = system.particles.position.get(id as usize);
            position[place] = Float4 { x, y, z, ..position[place] };
        }
        device.position.upload(&position).unwrap();
        device.build();
        for by in [By::Cells, By::CellsOnce] {
            device.evaluate(by, true, false);
            let counts: Vec<u32> = device.results().iter().map(|r| r.2).collect();
            assert_eq!(counts, expected_counts(&system), "seed {seed}, by {by:?}");
        }
    }
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn a_run_that_has_blown_up_stays_within_its_memory() {
    let mut system = cases::random(3);
    system = cases::soft(system.sim_box, (0..100).map(|_| system.sim_box.lo()).collect(), Radii::Uniform(0.01));
    let mut device = Device::new(&system);
    let wild = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3e38, -3e38, 0.0, 1e-40];
    let at = |k: usize| wild[k % wild.len()];
    let position: Vec<Float4> = (0..100).map(|i| Float4::new(at(i), at(i / 7), at(i / 3), 0.0)).collect();
    device.position.upload(&position).unwrap();
    device.build();
    device.evaluate(By::Cells, true, false);
    device.evaluate(By::CellsOnce, true, false);
    let mut places = device.grid.order().download().unwrap();
    places.sort_unstable();
    assert!(places.into_iter().eq(0..100), "every particle has a slot");
    let list = device.list(true, ListKind::Full);
    assert_eq!(*list.offsets.last().unwrap(), list.indices.len() as u64);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn no_particles_are_no_work() {
    let system = cases::soft(cases::cube(4.0, [nearfield_core::Boundary::Open; 3]), Vec::new(), Radii::Uniform(1.0));
    let mut device = Device::new(&system);
    device.evaluate(By::CellsOnce, true, false);
    assert_eq!(device.list(true, ListKind::Full).offsets, [0]);
    assert_eq!(device.grid.layout().particle.address(), Ptr::<u32>::NULL.address());
}
