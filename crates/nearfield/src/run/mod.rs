//! A run of a configuration file: what `nearfield run` does, for programs.
//!
//! The output directory holds `thermo.csv`, the trajectory, `run.json` (what ran and how it went) and
//! `checkpoint.nearfield`. A directory of an earlier run is renamed, never overwritten.

mod checkpoint;
mod directory;
mod record;

pub use checkpoint::Checkpoint;
pub use record::{Record, Status, Versions};

use crate::{
    Error, Progress, Result, Simulation,
    config::{Choice, Config},
    observe::{MeanSquaredDisplacement, Observer, RadialDistribution, ThermoTable, TrajectoryWriter},
    setup,
    simulation::next_multiple,
};
use nearfield_core::{Method, Plan};
use std::{
    ops::ControlFlow,
    path::{Path, PathBuf},
};

/// File name of the record.
pub const RECORD: &str = "run.json";
/// File name of the checkpoint.
pub const CHECKPOINT: &str = "checkpoint.nearfield";

/// A configuration made ready to run.
pub struct Run {
    config: Config,
    simulation: Simulation,
    observers: Vec<Box<dyn Observer>>,
    record: Record,
    /// Step of the checkpoint on disk.
    saved: Option<u64>,
    /// Where an earlier run's output went.
    moved: Option<PathBuf>,
}

impl Run {
    /// Sets the system up and prepares the output directory. Nothing is written before everything is checked.
    ///
    /// # Errors
    /// Anything wrong with the request.
    pub fn new(config: Config) -> Result<Self> {
        let method = match config.method.name {
            Choice::Auto => None,
            Choice::Of(method) => Some(method),
        };
        let mut simulation = simulation(&config, method)?;
        // Forces that cannot be are found before the directory is touched.
        simulation.thermo()?;
        let moved = directory::prepare(&config.output.directory, &files(&config))?;
        let record = Record::new(&config, &simulation);
        Ok(Self { observers: observers(&config), config, simulation, record, saved: None, moved })
    }

    /// Continues the run whose checkpoint lies in the output directory. Only the number of steps, the outputs, the
    /// device and the memory budget may differ from the run before; the method stays that of the checkpoint.
    ///
    /// # Errors
    /// [`Error::Resume`], and as [`Run::new`].
    pub fn resume(config: Config) -> Result<Self> {
        let path = config.output.directory.join(CHECKPOINT);
        let checkpoint = Checkpoint::read(&path)?;
        let refused = |reason: String| Error::Resume { path: path.clone(), reason };
        checkpoint.check(&config).map_err(refused)?;
        let mut simulation = simulation(&config, Some(checkpoint.method))?;
        simulation.restore(&checkpoint).map_err(|error| refused(error.to_string()))?;
        let mut observers = observers(&config);
        for observer in &mut observers {
            if let Some(saved) = checkpoint.observers.get(observer.name()) {
                observer.restore(saved)?;
            }
        }
        directory::sweep(&config.output.directory, &files(&config));
        let record = Record::new(&config, &simulation).resumed(checkpoint.step, checkpoint.report.clone());
        Ok(Self { config, simulation, observers, record, saved: Some(checkpoint.step), moved: None })
    }

    /// The simulation.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// Where the output of an earlier run was moved to, if there was one.
    pub fn moved(&self) -> Option<&PathBuf> {
        self.moved.as_ref()
    }

    /// Runs to the last step and gives the record, which is also in `run.json`.
    ///
    /// # Errors
    /// [`Error::Interrupted`] when `progress` breaks off, after writing a checkpoint; [`Error::Failed`] with the step
    /// of the last good checkpoint otherwise.
    pub fn execute(mut self, progress: &mut dyn FnMut(Progress) -> ControlFlow<()>) -> Result<Record> {
        self.write_record(Status::Running)?;
        let outcome = self.run_segments(progress);
        match outcome {
            Ok(()) => {
                self.write_record(Status::Finished)?;
                Ok(self.record)
            }
            Err(Error::Interrupted { step }) => {
                self.save()?;
                self.write_record(Status::Interrupted)?;
                Err(Error::Interrupted { step })
            }
            Err(source) => {
                self.record.error = Some(source.to_string());
                self.write_record(Status::Failed)?;
                Err(Error::Failed { source: Box::new(source), checkpoint: self.saved })
            }
        }
    }

    fn run_segments(&mut self, progress: &mut dyn FnMut(Progress) -> ControlFlow<()>) -> Result<()> {
        let last = self.config.dynamics.steps;
        let every = self.config.output.checkpoint_every;
        loop {
            let end = next_multiple(self.simulation.step(), every).unwrap_or(last).min(last);
            let meter = &mut self.record;
            self.simulation.run(end, &mut self.observers, &mut |p| {
                meter.read_meter();
                progress(Progress { last_step: last, ..p })
            })?;
            self.save()?;
            if end == last {
                return Ok(());
            }
            self.write_record(Status::Running)?;
        }
    }

    fn save(&mut self) -> Result<()> {
        self.record.thermo(self.simulation.thermo()?);
        let mut checkpoint = self.simulation.checkpoint()?;
        checkpoint.config = self.config.to_toml()?;
        checkpoint.report = self.record.report_with(self.simulation.report());
        for observer in &mut self.observers {
            checkpoint.observers.insert(observer.name().into(), observer.save()?);
        }
        checkpoint.write(&self.config.output.directory.join(CHECKPOINT))?;
        self.saved = Some(checkpoint.step);
        Ok(())
    }

    fn write_record(&mut self, status: Status) -> Result<()> {
        self.record.update(&self.simulation, status);
        self.record.write(&self.config.output.directory.join(RECORD))
    }
}

fn simulation(config: &Config, method: Option<Method>) -> Result<Simulation> {
    let plan: Plan = config.plan(method.unwrap_or(Method::Cell));
    let builder = Simulation::builder(setup::system(config)?)
        .dynamics(config.dynamics())
        .plan(plan)
        .device(config.method.device)
        .tail_correction(config.interaction.tail_correction);
    match method {
        Some(method) => builder.method(method).build(),
        None => builder.build(),
    }
}

/// Names of the files a run may write.
fn files(config: &Config) -> [&Path; 6] {
    let [thermo, rdf, msd, record, checkpoint] =
        ["thermo.csv", "rdf.csv", "msd.csv", RECORD, CHECKPOINT].map(Path::new);
    [thermo, &config.output.trajectory, rdf, msd, record, checkpoint]
}

fn observers(config: &Config) -> Vec<Box<dyn Observer>> {
    let output = &config.output;
    let path = |name: &str| output.directory.join(name);
    let trajectory = output.directory.join(&output.trajectory);
    vec![
        Box::new(ThermoTable::new(&path("thermo.csv"), output.thermo_every)),
        Box::new(TrajectoryWriter::new(&trajectory, output.trajectory_every, output.velocities)),
        Box::new(RadialDistribution::new(&path("rdf.csv"), output.rdf_every, output.rdf_bins)),
        Box::new(MeanSquaredDisplacement::new(&path("msd.csv"), output.msd_every)),
    ]
}
