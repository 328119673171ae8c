//! Electrical energy, where the machine has a meter that may be read.

mod nvml;
mod rapl;

pub(crate) use nvml::driver_version;

use crate::{Device, Error, Result, device};
use nearfield_core::{Engine, Maintenance, Plan, maintenance::EnergyCounter};
use nvml::Nvml;
use rapl::Rapl;
use std::time::Instant;

/// Adds up the energy that a device uses, other programs included.
#[derive(Debug)]
pub struct EnergyMeter {
    meter: Meter,
    since: Instant,
}

#[derive(Debug)]
enum Meter {
    Rapl(Rapl),
    Nvml(Box<Nvml>),
}

impl EnergyMeter {
    fn new(meter: Meter) -> Self {
        Self { meter, since: Instant::now() }
    }

    /// The meter of a device.
    ///
    /// # Errors
    /// Why there is none.
    pub fn of(device: Device) -> Result<Self, String> {
        match device::identity(device) {
            (_, Some(uuid)) => Self::gpu(&uuid),
            (_, None) => Self::cpu(),
        }
    }

    /// The meter of the processors: Linux's powercap counters (Intel and AMD RAPL) of all packages, memory and the rest
    /// of the machine not included.
    ///
    /// # Errors
    /// Why there is none.
    fn cpu() -> Result<Self, String> {
        let none = || "no RAPL counter of a processor package that may be read (/sys/class/powercap)".to_owned();
        Rapl::find().map(|meter| Self::new(Meter::Rapl(meter))).ok_or_else(none)
    }

    /// The meter of a GPU, named by its UUID: NVML's counter of the whole board.
    ///
    /// # Errors
    /// Why there is none.
    fn gpu(uuid: &str) -> Result<Self, String> {
        Nvml::find(uuid).map(|meter| Self::new(Meter::Nvml(Box::new(meter)))).map_err(|error| format!("NVML: {error}"))
    }

    /// What is read.
    pub fn name(&self) -> &'static str {
        match self.meter {
            Meter::Rapl(_) => "RAPL, processor packages",
            Meter::Nvml(_) => "NVML, GPU board",
        }
    }

    /// Energy since the meter was found, \[J\]. To be asked now and then: counters start again after some minutes of
    /// full load.
    pub fn joules(&mut self) -> f64 {
        match &mut self.meter {
            Meter::Rapl(meter) => meter.joules(),
            Meter::Nvml(meter) => meter.joules(),
        }
    }
}

impl EnergyCounter for EnergyMeter {
    fn read(&mut self) -> (f64, f64) {
        (self.joules(), self.since.elapsed().as_secs_f64())
    }
}

/// Gives the engine's rebuild policy a meter where it looks at energy, right after the system was loaded.
///
/// # Errors
/// [`Error::NoMeter`].
pub(crate) fn attach_meter(engine: &mut dyn Engine, plan: &Plan, device: Device) -> Result<()> {
    if plan.maintenance == Maintenance::GradientJoules && plan.method.uses_bvh() {
        let none = |reason| Error::NoMeter { device: engine.device(), reason };
        let meter = EnergyMeter::of(device).map_err(none)?;
        engine.attach_meter(Box::new(meter));
    }
    Ok(())
}
