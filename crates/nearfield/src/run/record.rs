//! run.json: what ran, how, and how it went.

use crate::{Result, Simulation, Thermo, auto::Choice, config::Config, energy::EnergyMeter, io::atomic_write};
use nearfield_core::{Plan, Report};
use serde::Serialize;
use std::{env, path::Path, time::Instant};

/// How a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// Under way, or killed.
    Running,
    /// Done.
    Finished,
    /// Stopped by the user; a checkpoint was written.
    Interrupted,
    /// Stopped by an error.
    Failed,
}

/// Versions of what ran.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Versions {
    /// Nearfield.
    pub nearfield: &'static str,
    /// Operating system and processor architecture.
    pub system: String,
}

/// The content of run.json.
#[derive(Debug, Serialize)]
pub struct Record {
    /// What ran.
    pub versions: Versions,
    /// How it went.
    pub status: Status,
    /// What stopped a failed run.
    pub error: Option<String>,
    /// The device.
    pub device: String,
    /// The method and why it was chosen.
    pub method: Choice,
    /// All settings of the computation.
    pub plan: Plan,
    /// Number of particles.
    pub n_particles: usize,
    /// Steps done.
    pub steps: u64,
    /// The step this run started from, when it was resumed.
    pub resumed_from: Option<u64>,
    /// Wall time since the (resumed) start, \[s\].
    pub wall_seconds: f64,
    /// Steps of this start over its wall time, outputs included.
    pub steps_per_second: f64,
    /// Particles times steps over wall time.
    pub particle_steps_per_second: f64,
    /// Energy the device used since the (resumed) start, \[J\], other programs included; absent where there is no meter
    /// that may be read.
    pub energy_joules: Option<f64>,
    /// What the energy was read from, or why there is none.
    pub energy_meter: String,
    /// The last thermodynamic state.
    pub thermo: Option<Thermo>,
    /// Mean number of steps that a stored neighbour list served; absent without lists. Its skin is in the report.
    pub steps_per_list: Option<f64>,
    /// Rebuilds, refits, lists and the times they took.
    pub report: Report,
    /// The full configuration.
    pub config: Config,
    #[serde(skip)]
    start: Instant,
    #[serde(skip)]
    meter: Option<EnergyMeter>,
    /// What was done before the resumed start.
    #[serde(skip)]
    earlier: Report,
}

impl Record {
    pub(super) fn new(config: &Config, simulation: &Simulation) -> Self {
        let (energy_meter, meter) = match simulation.energy_meter() {
            Ok(meter) => (meter.name().to_owned(), Some(meter)),
            Err(reason) => (format!("none: {reason}"), None),
        };
        Self {
            versions: Versions {
                nearfield: env!("CARGO_PKG_VERSION"),
                system: format!("{} {}", env::consts::OS, env::consts::ARCH),
            },
            status: Status::Running,
            error: None,
            device: simulation.device(),
            method: simulation.choice().clone(),
            plan: *simulation.plan(),
            n_particles: simulation.n_particles(),
            steps: 0,
            resumed_from: None,
            wall_seconds: 0.0,
            steps_per_second: 0.0,
            particle_steps_per_second: 0.0,
            energy_joules: None,
            energy_meter,
            thermo: None,
            steps_per_list: None,
            report: Report::default(),
            config: config.clone(),
            start: Instant::now(),
            meter,
            earlier: Report::default(),
        }
    }

    pub(super) fn resumed(self, step: u64, earlier: Report) -> Self {
        Self { resumed_from: Some(step), earlier, ..self }
    }

    /// The report with what was done before a resumed start.
    pub(super) fn report_with(&self, report: Report) -> Report {
        self.earlier.clone().followed_by(report)
    }

    pub(super) fn thermo(&mut self, thermo: Thermo) {
        self.thermo = Some(thermo);
    }

    pub(super) fn update(&mut self, simulation: &Simulation, status: Status) {
        self.status = status;
        self.method = simulation.choice().clone();
        self.plan = *simulation.plan();
        self.steps = simulation.step();
        self.read_meter();
        self.wall_seconds = self.start.elapsed().as_secs_f64();
        let steps = (self.steps - self.resumed_from.unwrap_or(0)) as f64;
        self.steps_per_second = steps / self.wall_seconds;
        self.particle_steps_per_second = self.steps_per_second * self.n_particles as f64;
        self.report = self.report_with(simulation.report());
        self.steps_per_list = self.report.steps_per_list();
    }

    /// Keeps the meter going: its counters start again now and then.
    pub(super) fn read_meter(&mut self) {
        self.energy_joules = self.meter.as_mut().map(EnergyMeter::joules);
    }

    pub(super) fn write(&self, path: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(self).expect("the record can be encoded");
        Ok(atomic_write(path, |out| writeln!(out, "{text}"))?)
    }
}
