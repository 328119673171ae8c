//! The smallest engine that keeps every promise, and ways to break it.

mod integrate;

use nearfield_core::{
    Dynamics, Engine, Error, ListKind, ListRequest, Method, NeighborList, Particles, PerParticle, Plan, Quantities,
    Report, Result, Skin, System, Totals, Vec3s,
    engine::StepCost,
    maintenance::{Action, EnergyCounter, Motion, Policy},
    oracle::{self, Pair, Reference},
    predicate,
};

/// A mistake to plant, for proving that the suite notices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Loses one pair.
    DropPair,
    /// Shifts a position before the subtraction, which rounds differently.
    ShiftFirst,
    /// Gives the image of each neighbour with the wrong sign.
    WrongImageSign,
    /// Takes pairs at exactly the cutoff for neighbours.
    TiesIncluded,
    /// Gives one particle of one pair the other's force.
    WrongForceSign,
    /// Refuses nothing.
    SupportsAll,
    /// Forgets the mass of a particle's type.
    IgnoresMass,
    /// Drifts with the wrong half of the velocity Verlet step.
    FirstOrder,
    /// Noise of a thermostat too strong by a tenth.
    NoiseTooStrong,
    /// Does not stop at walls.
    LeakyWalls,
    /// Refits whatever the policy says.
    NeverRebuilds,
    /// Goes on with infinite forces and positions.
    SilentOverlaps,
    /// Does not limit displacements.
    Unlimited,
    /// Loses the image counts.
    LosesImages,
    /// Rounds the forces of one method differently.
    MethodRounds,
    /// Gives particles back in reverse.
    MemoryOrder,
}

/// Brute force, float64 forces rounded to f32, and f32 velocity Verlet. Methods, images and orders change nothing but
/// the bookkeeping of the report.
#[derive(Default)]
pub struct OracleEngine {
    fault: Option<Fault>,
    loaded: Option<Loaded>,
    record_history: bool,
}

/// The state of a loaded system.
struct Loaded {
    system: System,
    plan: Plan,
    /// Pairs at the present positions.
    pairs: Option<Vec<Pair>>,
    force: Vec3s,
    forces_valid: bool,
    per_particle: PerParticle,
    policy: Box<dyn Policy>,
    /// Positions at the last list build.
    list_positions: Option<Vec3s>,
    list_built_last: bool,
    report: Report,
}

impl OracleEngine {
    /// An engine that keeps its promises.
    pub fn new() -> Self {
        Self::default()
    }

    /// An engine with a fault.
    pub fn broken(fault: Fault) -> Self {
        Self { fault: Some(fault), ..Self::default() }
    }

    fn loaded(&mut self) -> Result<&mut Loaded> {
        self.loaded.as_mut().ok_or(Error::NotLoaded)
    }

    fn has(&self, fault: Fault) -> bool {
        self.fault == Some(fault)
    }

    /// Every pair within range at the present positions.
    fn find_pairs(&mut self) -> Result<Vec<Pair>> {
        let fault = self.fault;
        let Loaded { system, pairs, .. } = self.loaded()?;
        let found = pairs.get_or_insert_with(|| match fault {
            Some(Fault::ShiftFirst | Fault::TiesIncluded) => faulty_pairs(system, fault),
            Some(Fault::DropPair) => {
                let mut found = oracle::pairs(&system.sim_box, &system.particles, &system.radii);
                found.pop();
                found
            }
            _ => oracle::pairs(&system.sim_box, &system.particles, &system.radii),
        });
        Ok(found.clone())
    }

    /// What the policy decides and the list's motion test say, as an engine with structures would count them.
    fn keep_books(&mut self, n_pairs: usize) {
        let (never, record) = (self.has(Fault::NeverRebuilds), self.record_history);
        let Some(Loaded { system, plan, policy, list_positions, list_built_last, report, .. }) = &mut self.loaded
        else {
            return;
        };
        report.evaluations += 1;
        let mut needs_structure = true;
        if plan.method.uses_list() {
            let fits = 8 * n_pairs as u64 <= plan.memory_budget;
            let positions = &system.particles.position;
            let valid =
                list_positions.as_ref().is_some_and(|old| moved_less(system, old, plan.skin.or_usual() / 2.0)) && fits;
            needs_structure = !valid;
            if !valid {
                report.list_builds += 1;
                report.dangerous_builds += u64::from(*list_built_last && plan.skin != Skin::NONE);
                *list_positions = Some(positions.clone());
            }
            *list_built_last = !valid;
            report.batched_evaluations += u64::from(!fits);
        }
        let mut built = false;
        if needs_structure {
            built = !plan.method.uses_bvh()
                || report.builds == 0
                || (!never && policy.decide(Motion::default()) == Action::Build);
            report.builds += u64::from(built);
            report.refits += u64::from(!built);
        }
        let cost = StepCost { built, structure: 0.0, query: 0.0 };
        if needs_structure {
            policy.record(cost);
        }
        if record {
            report.history.push(cost);
        }
    }

    /// Evaluates at the present positions; with `capped`, forces that overflow are limited instead of an error.
    fn compute(&mut self, quantities: Quantities, capped: bool) -> Result<Totals> {
        let pairs = self.find_pairs()?;
        self.keep_books(pairs.len());
        let (wrong_sign, silent) = (self.has(Fault::WrongForceSign), self.has(Fault::SilentOverlaps));
        let method_rounds = self.has(Fault::MethodRounds);
        let Loaded { system, plan, force, forces_valid, per_particle, .. } = self.loaded()?;
        let at = |k: u32| system.particles.position.get(k as usize);
        let coincide = |p: &&Pair| at(p.i) == at(p.j) && p.image == [0; 3];
        let diverges = system.interaction.potential.diverges_at_zero();
        if let Some(pair) = pairs.iter().find(coincide).filter(|_| diverges && !capped && !silent) {
            return Err(Error::Coincident(pair.i as usize, pair.j as usize));
        }
        let apart: Vec<Pair> = pairs.iter().copied().filter(|p| !(diverges && coincide(&p))).collect();
        let mut found = oracle::evaluate_pairs(system, &apart);
        if wrong_sign && !apart.is_empty() {
            found.force[apart[0].i as usize] = found.force[apart[0].i as usize].map(|f| -f);
        }
        let round = |f: f64| if capped { f.clamp(-1e30, 1e30) as f32 } else { f as f32 };
        *force = found.force.iter().map(|f| f.map(round)).collect();
        if method_rounds && plan.method == Method::RtForces {
            force.x.iter_mut().for_each(|f| *f = f.next_up());
        }
        *forces_valid = true;
        Ok(report_totals(system, force, found, pairs.len() as u64, quantities, per_particle))
    }
}

/// Whether every particle is within `distance` of where it was.
fn moved_less(system: &System, old: &Vec3s, distance: f32) -> bool {
    let lengths = system.sim_box.lengths();
    system.particles.position.iter().zip(old.iter()).all(|(now, before)| {
        let moved: f32 = (0..3)
            .map(|a| {
                let d = (now[a] - before[a]).abs();
                if system.sim_box.is_periodic(a) { d.min(lengths[a] - d) } else { d }
            })
            .map(|d| d * d)
            .sum();
        moved.sqrt() < distance
    })
}

/// [`oracle::pairs`] with another predicate.
fn faulty_pairs(system: &System, fault: Option<Fault>) -> Vec<Pair> {
    let (sim_box, particles) = (&system.sim_box, &system.particles);
    let mut found = Vec::new();
    for i in 0..particles.len() {
        for j in i + 1..particles.len() {
            for image in sim_box.images() {
                let (xi, xj, shift) = (particles.position.get(i), particles.position.get(j), sim_box.shift(image));
                let range = system.radii.range(i, j);
                let within = if fault == Some(Fault::ShiftFirst) {
                    let dr: [f32; 3] = std::array::from_fn(|a| (xj[a] + shift[a]) - xi[a]);
                    predicate::is_neighbor(predicate::squared_length(dr), range)
                } else {
                    predicate::squared_length(predicate::displacement(xi, xj, shift)) <= range * range
                };
                if within {
                    found.push(Pair { i: i as u32, j: j as u32, image });
                }
            }
        }
    }
    found
}

fn report_totals(
    system: &System,
    force: &Vec3s,
    found: Reference,
    pairs: u64,
    quantities: Quantities,
    per_particle: &mut PerParticle,
) -> Totals {
    let mut totals = Totals::default();
    let particles = &system.particles;
    for (v, &kind) in particles.velocity.iter().zip(&particles.kind) {
        let mass = f64::from(system.interaction.types[kind as usize].mass);
        for (total, v) in totals.momentum.iter_mut().zip(v) {
            *total += mass * f64::from(v);
            totals.kinetic_energy += 0.5 * mass * f64::from(v) * f64::from(v);
        }
    }
    let norm = |f: [f32; 3]| f.iter().map(|&f| f64::from(f) * f64::from(f)).sum::<f64>().sqrt();
    totals.max_force = force.iter().map(norm).fold(0.0, f64::max);
    *per_particle = PerParticle { force: force.clone(), ..PerParticle::default() };
    if quantities.energy {
        totals.potential_energy = found.potential_energy;
        totals.virial = found.virial;
        totals.pairs = pairs;
        per_particle.energy = found.energy;
        per_particle.neighbors = found.neighbors;
    }
    totals
}

impl Engine for OracleEngine {
    fn device(&self) -> String {
        "oracle".into()
    }

    fn supports(&self, system: &System, plan: &Plan) -> Result<()> {
        let Plan { method, .. } = *plan;
        if system.radii.is_uniform() || method.supports_variable_radii() || self.has(Fault::SupportsAll) {
            return Ok(());
        }
        Err(Error::Unsupported { method, reason: "a point ray finds the larger of two radii only" })
    }

    fn load(&mut self, system: &System, plan: &Plan) -> Result<()> {
        self.supports(system, plan)?;
        self.loaded = Some(Loaded {
            system: system.clone(),
            plan: *plan,
            pairs: None,
            force: Vec3s::default(),
            forces_valid: false,
            per_particle: PerParticle::default(),
            policy: plan.maintenance.policy(),
            list_positions: None,
            list_built_last: false,
            report: Report::default(),
        });
        Ok(())
    }

    fn evaluate(&mut self, quantities: Quantities) -> Result<Totals> {
        self.compute(quantities, false)
    }

    fn advance(&mut self, dynamics: &Dynamics, from: u64, steps: u64, quantities: Quantities) -> Result<Totals> {
        let capped = dynamics.max_displacement > 0.0;
        if !self.loaded()?.forces_valid {
            self.compute(Quantities::FORCES, capped)?;
        }
        let mut totals = Totals::default();
        for step in from + 1..=from + steps {
            totals = self.step(dynamics, step, quantities, capped)?;
        }
        Ok(totals)
    }

    fn snapshot(&mut self, particles: &mut Particles) -> Result<()> {
        if let Some(loaded) = &self.loaded {
            particles.clone_from(&loaded.system.particles);
        }
        if self.has(Fault::MemoryOrder) {
            particles.position.axes_mut().into_iter().for_each(|axis| axis.reverse());
            particles.velocity.axes_mut().into_iter().for_each(|axis| axis.reverse());
        }
        Ok(())
    }

    fn per_particle(&mut self, out: &mut PerParticle) -> Result<()> {
        if let Some(loaded) = &self.loaded {
            out.clone_from(&loaded.per_particle);
        }
        Ok(())
    }

    fn neighbor_list(&mut self, request: ListRequest) -> Result<NeighborList> {
        let pairs = self.find_pairs()?;
        let flip: i8 = if self.has(Fault::WrongImageSign) { -1 } else { 1 };
        let Loaded { system, .. } = self.loaded()?;
        let n = system.particles.len();
        let mut rows: Vec<Vec<(u32, [i8; 3])>> = vec![Vec::new(); n];
        for &Pair { i, j, image } in &pairs {
            rows[i as usize].push((j, image.map(|s| flip * s)));
            if request.kind == ListKind::Full {
                rows[j as usize].push((i, image.map(|s| -flip * s)));
            }
        }
        rows.iter_mut().for_each(|row| row.sort_unstable());
        let mut list = NeighborList {
            kind: request.kind,
            offsets: vec![0],
            indices: Vec::new(),
            shifts: request.shifts.then(Vec::new),
            distances: request.distances.then(Vec::new),
        };
        for (i, row) in rows.into_iter().enumerate() {
            for (j, image) in row {
                list.indices.push(j);
                let at = |k: usize| system.particles.position.get(k);
                let shift = system.sim_box.shift(image.map(|s| flip * s));
                let dr = predicate::displacement(at(i), at(j as usize), shift);
                list.shifts.iter_mut().for_each(|shifts| shifts.push(image));
                list.distances.iter_mut().for_each(|all| all.push(predicate::squared_length(dr).sqrt()));
            }
            list.offsets.push(list.indices.len() as u64);
        }
        Ok(list)
    }

    fn report(&self) -> Report {
        self.loaded.as_ref().map(|loaded| loaded.report.clone()).unwrap_or_default()
    }

    fn record_history(&mut self, on: bool) {
        self.record_history = on;
    }

    fn attach_meter(&mut self, counter: Box<dyn EnergyCounter>) {
        if let Some(loaded) = &mut self.loaded {
            loaded.policy.attach(counter);
        }
    }
}
