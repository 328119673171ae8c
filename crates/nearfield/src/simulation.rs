//! A simulation in a program: a system on an engine, moved step by step, watched by observers.

use crate::{
    Device, Error, Result, Thermo,
    auto::{Choice, Tuner},
    energy::{EnergyMeter, attach_meter},
    engine,
    observe::{Observer, Sample},
    run::Checkpoint,
};
use nearfield_core::{
    Dynamics, Engine, Method, PerParticle, Plan, Quantities, Radii, Report, System, Totals, interaction::TailCorrection,
};
use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

/// Settings of a [`Simulation`] that have defaults.
#[derive(Clone, Debug)]
pub struct SimulationBuilder {
    system: System,
    dynamics: Dynamics,
    method: Option<Method>,
    plan: Plan,
    device: Device,
    tail_correction: bool,
    record_history: bool,
}

impl SimulationBuilder {
    /// The equations of motion; NVE with a time step of 0.005 by default.
    pub fn dynamics(mut self, dynamics: Dynamics) -> Self {
        self.dynamics = dynamics;
        self
    }

    /// The method; by default the fastest one: predicted at first, then measured where a run is long enough.
    pub fn method(mut self, method: Method) -> Self {
        self.method = Some(method);
        self
    }

    /// Everything about how to compute but the method.
    pub fn plan(mut self, plan: Plan) -> Self {
        self.plan = plan;
        self
    }

    /// The device; by default the fastest one.
    pub fn device(mut self, device: Device) -> Self {
        self.device = device;
        self
    }

    /// Adds the long-range part of a homogeneous Lennard-Jones fluid to energy and pressure where it is defined
    /// ([`System::tail_correction`]).
    pub fn tail_correction(mut self, on: bool) -> Self {
        self.tail_correction = on;
        self
    }

    /// Keeps the structure and query time of each evaluation in [`Report::history`].
    pub fn record_history(mut self, on: bool) -> Self {
        self.record_history = on;
        self
    }

    /// Validates the system and loads it.
    ///
    /// # Errors
    /// An invalid or empty system, an unavailable device, a method that does not support the system.
    pub fn build(mut self) -> Result<Simulation> {
        self.system.validate()?;
        self.system.wrap();
        if self.system.particles.is_empty() {
            return Err(nearfield_core::Error::Empty.into());
        }
        self.dynamics.validate()?;
        let mut engine = engine(self.device)?;
        let (tuner, choice) = match self.method {
            Some(method) => (None, Choice::of_user(method)),
            None => {
                let (tuner, choice) = Tuner::new(&mut *engine, &self.system, &self.plan)?;
                (Some(tuner), choice)
            }
        };
        let plan = Plan { method: choice.method, ..self.plan };
        engine.record_history(self.record_history);
        engine.load(&self.system, &plan)?;
        attach_meter(&mut *engine, &plan, self.device)?;
        let tail =
            if self.tail_correction { self.system.tail_correction().unwrap_or_default() } else { Default::default() };
        Ok(Simulation {
            engine,
            system: self.system,
            dynamics: self.dynamics,
            device: self.device,
            plan,
            choice,
            tuner,
            tail,
            step: 0,
            in_step: true,
            thermo: None,
            earlier: Report::default(),
        })
    }
}

/// A running simulation.
///
/// ```
/// use nearfield::{Boundary, Dynamics, Interaction, Radii, Simulation, System, generate};
/// let spec = generate::Generate { n: 500, density: Some(0.8442), temperature: 1.44, ..Default::default() };
/// let start = spec.build([Boundary::Periodic; 3], 1.0)?;
/// let system = System {
///     sim_box: start.sim_box,
///     particles: start.particles,
///     radii: Radii::Uniform(2.5),
///     interaction: Interaction::lennard_jones(),
/// };
/// let mut simulation = Simulation::builder(system).dynamics(Dynamics::nve(0.004)).build()?;
/// let before = simulation.thermo()?.total_energy;
/// let after = simulation.advance(100)?.total_energy;
/// assert!((after - before).abs() < 0.01 * before.abs());
/// # Ok::<(), nearfield::Error>(())
/// ```
pub struct Simulation {
    engine: Box<dyn Engine>,
    /// The particles are up to date only while `in_step`.
    system: System,
    in_step: bool,
    dynamics: Dynamics,
    device: Device,
    plan: Plan,
    choice: Choice,
    /// Where the choice of the method is ours.
    tuner: Option<Tuner>,
    tail: TailCorrection,
    step: u64,
    thermo: Option<Thermo>,
    /// What was done before the engine was last loaded.
    earlier: Report,
}

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Steps done.
    pub step: u64,
    /// The step at which the run ends.
    pub last_step: u64,
    /// The newest thermodynamic state.
    pub thermo: Option<Thermo>,
}

/// Wall time between reports of progress.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);

impl Simulation {
    /// A simulation of `system` with every setting at its default.
    pub fn builder(system: System) -> SimulationBuilder {
        SimulationBuilder {
            system,
            dynamics: Dynamics::nve(0.005),
            method: None,
            plan: Plan::new(Method::Cell),
            device: Device::Auto,
            tail_correction: false,
            record_history: false,
        }
    }

    /// The thermodynamic state at the present step.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn thermo(&mut self) -> Result<Thermo> {
        match self.thermo {
            Some(thermo) if thermo.step == self.step => Ok(thermo),
            _ => self.advance_tuned(0),
        }
    }

    /// Moves by `steps` steps.
    ///
    /// # Errors
    /// Coincident particles, or a run that has blown up; the state is then not to be used.
    pub fn advance(&mut self, steps: u64) -> Result<Thermo> {
        self.tune(steps)?;
        self.advance_tuned(steps)
    }

    fn advance_tuned(&mut self, steps: u64) -> Result<Thermo> {
        let totals = self.move_by(steps, Quantities::ALL)?;
        let thermo = self.thermo_of(&totals);
        self.thermo = Some(thermo);
        Ok(thermo)
    }

    fn move_by(&mut self, steps: u64, quantities: Quantities) -> Result<Totals> {
        let start = Instant::now();
        let totals = self.engine.advance(&self.dynamics, self.step, steps, quantities)?;
        if let Some(tuner) = &mut self.tuner {
            tuner.record(steps, start.elapsed().as_secs_f64());
        }
        self.step += steps;
        self.in_step &= steps == 0;
        Ok(totals)
    }

    /// Tries other methods when that may pay in the steps to come.
    fn tune(&mut self, remaining: u64) -> Result<()> {
        let steps = (self.step, remaining);
        if remaining == 0 || !self.tuner.as_ref().is_some_and(|tuner| tuner.is_due(&self.choice, steps)) {
            return Ok(());
        }
        self.system()?;
        let (order, report) = (self.engine.memory_order()?, self.report());
        let tuner = self.tuner.as_mut().expect("there is one");
        let method = self.choice.method;
        if tuner.tune(&mut *self.engine, &self.system, &self.dynamics, &self.plan, steps, &mut self.choice) {
            self.earlier = report;
            self.plan.method = self.choice.method;
            self.load()?;
            if self.choice.method == method {
                self.engine.set_memory_order(&order)?;
            }
        }
        Ok(())
    }

    /// Puts the present state on the engine.
    fn load(&mut self) -> Result<()> {
        self.engine.load(&self.system, &self.plan)?;
        attach_meter(&mut *self.engine, &self.plan, self.device)
    }

    fn thermo_of(&self, totals: &Totals) -> Thermo {
        // The shortest decimal of the f32 is what the user wrote: 0.005, not 0.004999999888.
        let dt: f64 = self.dynamics.dt.to_string().parse().unwrap_or(f64::from(self.dynamics.dt));
        let time = self.step as f64 * dt;
        Thermo::new(totals, self.system.particles.len(), self.system.sim_box.volume(), self.tail, self.step, time)
    }

    /// Runs to `last_step`, calling each observer at the steps it asks for (the present one included only at step 0)
    /// and `progress` about ten times a second, until that breaks off.
    ///
    /// # Errors
    /// As [`Simulation::advance`], those of observers, and [`Error::Interrupted`] when `progress` broke off.
    pub fn run(
        &mut self,
        last_step: u64,
        observers: &mut [Box<dyn Observer>],
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<()> {
        if self.step == 0 {
            self.thermo()?;
            self.observe(observers)?;
        }
        let mut chunk = 1;
        while self.step < last_step {
            self.tune(last_step - self.step)?;
            let next_event = observers.iter().filter_map(|o| next_multiple(self.step, o.every())).min();
            let event = next_event.unwrap_or(last_step).min(last_step);
            let steps = chunk.min(event - self.step);
            let start = Instant::now();
            if self.step + steps == event {
                self.advance_tuned(steps)?;
                self.observe(observers)?;
            } else {
                self.move_by(steps, Quantities::FORCES)?;
            }
            // As many steps as fit the interval, changing by a factor of two at most.
            let fit = steps as f64 * PROGRESS_INTERVAL.as_secs_f64() / start.elapsed().as_secs_f64().max(1e-9);
            chunk = (fit as u64).clamp(chunk / 2, chunk * 2).max(1);
            if progress(Progress { step: self.step, last_step, thermo: self.thermo }).is_break() {
                return Err(Error::Interrupted { step: self.step });
            }
        }
        Ok(())
    }

    fn observe(&mut self, observers: &mut [Box<dyn Observer>]) -> Result<()> {
        let thermo = self.thermo()?;
        for observer in observers {
            let every = observer.every();
            if every > 0 && self.step.is_multiple_of(every) {
                observer.observe(&mut Sample { simulation: self, thermo })?;
            }
        }
        Ok(())
    }

    /// The system at the present step.
    ///
    /// # Errors
    /// When the device fails.
    pub fn system(&mut self) -> Result<&System> {
        if !self.in_step {
            self.engine.snapshot(&mut self.system.particles)?;
            self.in_step = true;
        }
        Ok(&self.system)
    }

    /// Forces, energies and neighbour counts at the present step.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn per_particle(&mut self) -> Result<PerParticle> {
        self.thermo()?;
        let mut out = PerParticle::default();
        self.engine.per_particle(&mut out)?;
        Ok(out)
    }

    /// Number of particles.
    pub fn n_particles(&self) -> usize {
        self.system.particles.len()
    }

    /// Ranges.
    pub fn radii(&self) -> &Radii {
        &self.system.radii
    }

    /// Steps done.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// How it computes.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Why it computes so.
    pub fn choice(&self) -> &Choice {
        &self.choice
    }

    /// Name of the device.
    pub fn device(&self) -> String {
        self.engine.device()
    }

    /// Reads the electrical energy of the device from now on.
    ///
    /// # Errors
    /// Why it has no meter that may be read.
    pub(crate) fn energy_meter(&self) -> Result<EnergyMeter, String> {
        EnergyMeter::of(self.device)
    }

    /// What was done so far.
    pub fn report(&self) -> Report {
        self.earlier.clone().followed_by(self.engine.report())
    }

    /// The state to continue from, bit for bit.
    ///
    /// # Errors
    /// When the device fails.
    pub fn checkpoint(&mut self) -> Result<Checkpoint> {
        let (method, step, order) = (self.plan.method, self.step, self.engine.memory_order()?);
        Ok(Checkpoint::new(self.system()?, method, step, order))
    }

    /// Continues from a checkpoint of the same number of particles instead of the present state.
    ///
    /// # Errors
    /// When the checkpoint's system is not valid or the engine cannot be loaded.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        checkpoint.apply(&mut self.system)?;
        self.earlier = self.report();
        self.load()?;
        self.engine.set_memory_order(&checkpoint.order)?;
        self.step = checkpoint.step;
        self.in_step = true;
        self.thermo = None;
        Ok(())
    }
}

/// The first multiple of `every` after `step`; `None` when `every` is 0.
pub(crate) fn next_multiple(step: u64, every: u64) -> Option<u64> {
    (every > 0).then(|| (step / every + 1) * every)
}
