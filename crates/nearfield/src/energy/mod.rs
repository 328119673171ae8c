//! Electrical energy, where the machine has a meter that may be read.

mod nvml;
mod rapl;

pub(crate) use nvml::driver_version;

use nvml::Nvml;
use rapl::Rapl;

/// Adds up the energy that a device uses, other programs included.
#[derive(Debug)]
pub struct EnergyMeter(Meter);

#[derive(Debug)]
enum Meter {
    Rapl(Rapl),
    Nvml(Nvml),
}

impl EnergyMeter {
    /// The meter of the processors: Linux's powercap counters (Intel and AMD RAPL) of all packages, memory and the rest
    /// of the machine not included.
    ///
    /// # Errors
    /// Why there is none.
    pub fn cpu() -> Result<Self, String> {
        let none = || "no RAPL counter of a processor package that may be read (/sys/class/powercap)".to_owned();
        Rapl::find().map(|meter| Self(Meter::Rapl(meter))).ok_or_else(none)
    }

    /// The meter of a GPU, named by its UUID: NVML's counter of the whole board.
    ///
    /// # Errors
    /// Why there is none.
    pub fn gpu(uuid: &str) -> Result<Self, String> {
        Nvml::find(uuid).map(|meter| Self(Meter::Nvml(meter))).map_err(|error| format!("NVML: {error}"))
    }

    /// What is read.
    pub fn name(&self) -> &'static str {
        match self.0 {
            Meter::Rapl(_) => "RAPL, processor packages",
            Meter::Nvml(_) => "NVML, GPU board",
        }
    }

    /// Energy since the meter was found, \[J\]. To be asked now and then: counters start again after some minutes of
    /// full load.
    pub fn joules(&mut self) -> f64 {
        match &mut self.0 {
            Meter::Rapl(meter) => meter.joules(),
            Meter::Nvml(meter) => meter.joules(),
        }
    }
}
