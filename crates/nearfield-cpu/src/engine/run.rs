//! The loop of a run.

use super::{
    evaluate::{Loaded, NonFiniteWatch},
    integrate::{Integrator, Moving},
    results::Results,
    state::State,
    thermostat,
};
use crate::{
    kernel::{Sums, gather},
    parallel::Scattered,
    physics::OVERLAP_CAP,
};
use nearfield_core::{Dynamics, Ensemble, Error, Method, Quantities, Result, Totals, Vec3s};
use rayon::prelude::*;
use std::time::Instant;

/// Particles a task moves.
const CHUNK: usize = 4096;

impl Loaded {
    /// See [`nearfield_core::Engine::advance`].
    pub fn advance(&mut self, dynamics: &Dynamics, from: u64, steps: u64, quantities: Quantities) -> Result<Totals> {
        dynamics.validate()?;
        self.dt = dynamics.dt;
        self.physics.cap = if dynamics.max_displacement > 0.0 { OVERLAP_CAP } else { f32::INFINITY };
        if self.plan.method == Method::Cluster && !self.plan.deterministic && self.clusters.forget_if_ended() {
            (self.forces_valid, self.results) = (false, Results::default());
        }
        if !self.forces_valid || steps == 0 {
            let wanted = if steps == 0 { quantities } else { Quantities::FORCES };
            self.evaluate(wanted, from)?;
        }
        let integrator = Integrator::new(self.physics.sim_box, dynamics, &self.physics.interaction.types);
        let rescales = matches!(dynamics.ensemble, Ensemble::Rescale { .. });
        if self.plan.method == Method::RtPerse && !rescales && steps > 0 {
            self.advance_fused(&integrator, from, steps, quantities)?;
        } else if !rescales && steps > 0 && self.steps_by_clusters(&integrator) {
            self.advance_clusters(&integrator, from, steps, quantities)?;
        } else {
            for step in from + 1..=from + steps {
                if step == from + 1 || rescales {
                    self.start(&integrator, step)?;
                } else {
                    self.finish_and_start(&integrator, step)?;
                }
                let wanted = if step == from + steps { quantities } else { Quantities::FORCES };
                self.evaluate(wanted, step)?;
                if step == from + steps || rescales {
                    self.finish(&integrator);
                }
                if rescales {
                    thermostat::rescale(self, dynamics, step);
                }
            }
        }
        self.totals(quantities, from + steps)
    }

    /// ORCS-persé (paper A section 3.2.1): the pass that gathers a particle's force also moves it, into a second copy
    /// of the state. The arithmetic of a step is that of the separate passes, so trajectories are the same.
    fn advance_fused(&mut self, integrator: &Integrator, from: u64, steps: u64, quantities: Quantities) -> Result<()> {
        self.start(integrator, from + 1)?;
        let mut next = NextState::default();
        for step in from + 1..from + steps {
            self.forces_valid = false;
            self.prepare(step);
            let forces = NonFiniteWatch::default();
            let positions = NonFiniteWatch::default();
            next.prepare(&self.state);
            let start = Instant::now();
            {
                let (sink, state) = (next.sink(), &self.state);
                let move_particle = |i: u32, sums: &Sums| {
                    let (i, id) = (i as usize, state.id[i as usize]);
                    forces.see(sums.force, id);
                    let mut p = state.moving(i);
                    integrator.finish(&mut p, sums.force, state.kind(i));
                    integrator.start(&mut p, sums.force, state.kind(i), id, step + 1);
                    positions.see(p.position, id);
                    // SAFETY: a query finishes each particle once.
                    unsafe { sink.write(i, p) };
                };
                let structure = self.upkeep.index.structure();
                gather(&self.physics, structure, true, false, &move_particle);
            }
            self.account(start.elapsed().as_secs_f64());
            if let Some(particle) = forces.first() {
                // The force itself was not kept: evaluate again to say what is wrong with it.
                self.evaluate(quantities, step)?;
                return Err(self.diagnose(particle, step));
            }
            next.swap(&mut self.state);
            self.steps += 1;
            self.check_positions(&positions, step + 1)?;
        }
        self.evaluate(quantities, from + steps)?;
        self.finish(integrator);
        Ok(())
    }

    pub(super) fn start(&mut self, integrator: &Integrator, step: u64) -> Result<()> {
        self.move_all(integrator, step, false)
    }

    /// Ends the step before `step` and begins this one, in one pass.
    pub(super) fn finish_and_start(&mut self, integrator: &Integrator, step: u64) -> Result<()> {
        self.move_all(integrator, step, true)
    }

    /// Begins `step`, after the end of the one before where that is due.
    fn move_all(&mut self, integrator: &Integrator, step: u64, finish: bool) -> Result<()> {
        let start = Instant::now();
        let watch = NonFiniteWatch::default();
        let force = &self.results.force;
        if integrator.has_fast_path() {
            self.state.start_many(integrator, force, &watch, finish);
        } else {
            self.state.for_each_moving(|i, p, kind, id| {
                if finish {
                    integrator.finish(p, force.get(i), kind);
                }
                integrator.start(p, force.get(i), kind, id, step);
                watch.see(p.position, id);
            });
        }
        self.forces_valid = false;
        self.steps += 1;
        self.report.integrate_seconds += start.elapsed().as_secs_f64();
        self.check_positions(&watch, step)
    }

    pub(super) fn finish(&mut self, integrator: &Integrator) {
        let start = Instant::now();
        let force = &self.results.force;
        if integrator.has_fast_path() {
            self.state.finish_many(integrator, force);
        } else {
            self.state.for_each_moving(|i, p, kind, _| integrator.finish(p, force.get(i), kind));
        }
        self.report.integrate_seconds += start.elapsed().as_secs_f64();
    }

    pub(super) fn check_positions(&self, watch: &NonFiniteWatch, step: u64) -> Result<()> {
        let Some(particle) = watch.first() else { return Ok(()) };
        let i = self.state.id.iter().position(|&id| id == particle).expect("ids are a permutation");
        let value = self.state.position.get(i).into_iter().find(|x| !x.is_finite()).unwrap_or(f32::NAN);
        Err(Error::NonFinite { step, what: "coordinate", particle: particle as usize, value: f64::from(value) })
    }
}

impl State {
    #[inline(always)]
    fn moving(&self, i: usize) -> Moving {
        Moving { position: self.position.get(i), velocity: self.velocity.get(i), image: self.image[i] }
    }

    /// First half kick and drift of all particles, after the second half kick of the step before where that is due,
    /// where the integrator has a fast path.
    fn start_many(&mut self, integrator: &Integrator, force: &Vec3s, watch: &NonFiniteWatch, finish: bool) {
        let Self { position, velocity, image, kind, id, .. } = self;
        let [x, y, z] = position.axes_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        let [vx, vy, vz] = velocity.axes_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        let chunks = x.zip(y).zip(z).zip(vx.zip(vy).zip(vz)).zip(image.par_chunks_mut(CHUNK)).enumerate();
        chunks.for_each(|(c, ((((x, y), z), ((vx, vy), vz)), image))| {
            let range = c * CHUNK..c * CHUNK + x.len();
            let force = force.axes().map(|axis| &axis[range.clone()]);
            let kind = kind.get(range.clone()).unwrap_or(&[]);
            let settle = |group: std::ops::Range<usize>, x: [&mut [f32]; 3], v: [&mut [f32]; 3]| {
                for k in group {
                    let mut p = Moving {
                        position: [x[0][k], x[1][k], x[2][k]],
                        velocity: [v[0][k], v[1][k], v[2][k]],
                        image: image[k],
                    };
                    integrator.settle(&mut p);
                    watch.see(p.position, id[range.start + k]);
                    for axis in 0..3 {
                        (x[axis][k], v[axis][k]) = (p.position[axis], p.velocity[axis]);
                    }
                    image[k] = p.image;
                }
            };
            if finish {
                integrator.kick_many([&mut *vx, &mut *vy, &mut *vz], force, kind);
            }
            integrator.start_many([x, y, z], [vx, vy, vz], force, kind, settle);
        });
    }

    /// Second half kick of all particles, where the integrator has a fast path.
    fn finish_many(&mut self, integrator: &Integrator, force: &Vec3s) {
        let kind = &self.kind;
        let [vx, vy, vz] = self.velocity.axes_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        vx.zip(vy).zip(vz).enumerate().for_each(|(c, ((vx, vy), vz))| {
            let range = c * CHUNK..c * CHUNK + vx.len();
            let force = force.axes().map(|axis| &axis[range.clone()]);
            integrator.kick_many([vx, vy, vz], force, kind.get(range).unwrap_or(&[]));
        });
    }

    /// Changes every particle, in parallel: `change(index, particle, type, id)`.
    pub(super) fn for_each_moving(&mut self, change: impl Fn(usize, &mut Moving, u32, u32) + Sync) {
        let Self { position, velocity, image, kind, id, .. } = self;
        let (kind, id) = (&kind[..], &id[..]);
        let [x, y, z] = position.axes_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        let [vx, vy, vz] = velocity.axes_mut().map(|axis| axis.par_chunks_mut(CHUNK));
        let chunks = x.zip(y).zip(z).zip(vx.zip(vy).zip(vz)).zip(image.par_chunks_mut(CHUNK)).enumerate();
        chunks.for_each(|(c, ((((x, y), z), ((vx, vy), vz)), image))| {
            for k in 0..x.len() {
                let i = c * CHUNK + k;
                let mut p = Moving { position: [x[k], y[k], z[k]], velocity: [vx[k], vy[k], vz[k]], image: image[k] };
                change(i, &mut p, kind.get(i).copied().unwrap_or(0), id[i]);
                [x[k], y[k], z[k]] = p.position;
                [vx[k], vy[k], vz[k]] = p.velocity;
                image[k] = p.image;
            }
        });
    }
}

/// The second copy of what moves.
#[derive(Default)]
struct NextState {
    position: Vec3s,
    velocity: Vec3s,
    image: Vec<[i32; 3]>,
}

impl NextState {
    fn prepare(&mut self, state: &State) {
        self.position.resize(state.len());
        self.velocity.resize(state.len());
        self.image.resize(state.len(), [0; 3]);
    }

    fn sink(&mut self) -> NextSink<'_> {
        NextSink {
            position: self.position.axes_mut().map(|axis| Scattered::new(axis)),
            velocity: self.velocity.axes_mut().map(|axis| Scattered::new(axis)),
            image: Scattered::new(&mut self.image),
        }
    }

    fn swap(&mut self, state: &mut State) {
        std::mem::swap(&mut self.position, &mut state.position);
        std::mem::swap(&mut self.velocity, &mut state.velocity);
        std::mem::swap(&mut self.image, &mut state.image);
    }
}

struct NextSink<'a> {
    position: [Scattered<'a, f32>; 3],
    velocity: [Scattered<'a, f32>; 3],
    image: Scattered<'a, [i32; 3]>,
}

impl NextSink<'_> {
    /// # Safety
    /// No two calls with the same `i` while this value lives.
    #[inline(always)]
    unsafe fn write(&self, i: usize, p: Moving) {
        // SAFETY: the caller never passes an index twice.
        unsafe {
            for axis in 0..3 {
                self.position[axis].write(i, p.position[axis]);
                self.velocity[axis].write(i, p.velocity[axis]);
            }
            self.image.write(i, p.image);
        }
    }
}
