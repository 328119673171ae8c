//! `auto`: the fastest method that supports a system, on the device at hand.
//!
//! A cost model ([`Cost`], with the constants of a [`Profile`]) makes the first choice from what a [`Survey`] of the system
//! shows. Where a run is long enough for it to pay, the candidates then take a few steps each on the device, from the
//! present state and without changing it, and the fastest goes on; when steps have become slower or quicker since, they
//! are tried again. What is computed is the same by all of them, to rounding.

mod calibrate;
mod choice;
mod cost;
mod profile;
mod survey;
mod trial;
mod tuner;
mod watch;

pub use calibrate::{Calibration, Sample, calibrate};
pub use choice::{Candidate, Choice, Switch};
pub use cost::Cost;
pub use profile::{DeviceProfile, Profile};
pub use survey::Survey;
pub(crate) use tuner::Tuner;
