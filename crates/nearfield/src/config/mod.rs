//! The configuration file: TOML in, checked types out.
//!
//! [`Config`] has one struct a section, each in its own file with its defaults, checks and conversion to the types
//! of `nearfield_core`. `schema` says once what every key means and accepts: unknown keys are found by it, errors and
//! the comments of [`Config::to_toml`] are worded by it.

mod device;
mod document;
mod dynamics;
mod error;
mod interaction;
mod memory;
mod method;
mod output;
mod print;
mod schema;
mod system;
mod text;

pub use device::Device;
pub use dynamics::{DynamicsConfig, EnsembleName};
pub use error::{Error, Origin, Result};
pub use interaction::{InteractionConfig, PotentialName, TypeConfig};
pub use memory::Bytes;
pub use method::{Choice, MethodConfig};
pub use output::OutputConfig;
pub use system::{BoundaryConfig, Source, SystemConfig};

use crate::generate;
use document::Document;
use nearfield_core::{Dynamics, Interaction, Method, Particles, Plan, Radii, SimBox};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// A whole configuration, every value checked.
///
/// ```
/// use nearfield::config::Config;
/// let config = Config::parse("[dynamics]\ndt = 0.002", &["dynamics.steps=50".into()], "")?;
/// assert_eq!((config.dynamics.dt, config.dynamics.steps), (0.002, 50));
///
/// let error = Config::parse("[interaction]\ncutof = 3.0", &[], "").unwrap_err();
/// assert_eq!(error.to_string(), r#"line 2: unknown key "cutof" in [interaction]; did you mean "cutoff"?"#);
/// # Ok::<(), nearfield::config::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Config {
    /// What is simulated.
    pub system: SystemConfig,
    /// What happens at the faces of the box.
    pub boundary: BoundaryConfig,
    /// Forces.
    pub interaction: InteractionConfig,
    /// How it is computed.
    pub method: MethodConfig,
    /// How particles move.
    pub dynamics: DynamicsConfig,
    /// What is written.
    pub output: OutputConfig,
    /// Folder that relative input paths start from; not part of the file.
    #[serde(skip)]
    pub folder: PathBuf,
}

impl Config {
    /// Reads a file and applies `overrides`, each `KEY=VALUE` with a dotted key.
    ///
    /// # Errors
    /// [`Error::Read`], and as [`Config::parse`].
    pub fn load(path: &Path, overrides: &[String]) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|source| Error::Read { path: path.into(), source })?;
        Self::parse(&text, overrides, path.parent().unwrap_or(Path::new("")))
    }

    /// Parses a document and applies `overrides`, each `KEY=VALUE`: the key dotted (`interaction.type.0.epsilon` for
    /// the first type), the value TOML or a bare word. Relative input paths start from `folder`.
    ///
    /// # Errors
    /// The first thing wrong, with its line or option: syntax, unknown keys, wrong types, values out of range.
    pub fn parse(text: &str, overrides: &[String], folder: impl Into<PathBuf>) -> Result<Self> {
        let mut document = Document::parse(text)?;
        for option in overrides {
            document.set(option)?;
        }
        let mut config: Self = document.read()?;
        config.folder = folder.into();
        config.validate().map_err(|error| error.located(|key| document.origin(key)))?;
        Ok(config)
    }

    /// Checks the range of every value and what excludes each other. [`Config::parse`] has done so.
    ///
    /// # Errors
    /// [`Error::InvalidValue`], [`Error::TwoSources`], [`Error::Generate`].
    pub fn validate(&self) -> Result<()> {
        self.system.validate()?;
        self.interaction.validate()?;
        self.method.validate()?;
        self.dynamics.validate()?;
        self.output.validate()
    }

    /// Where the particles come from.
    ///
    /// # Errors
    /// [`Error::NoSource`] when nothing is given.
    pub fn source(&self) -> Result<Source<'_>> {
        self.system.source()
    }

    /// The interaction; reads the table file where there is one.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::TableRow`], [`Error::Table`].
    pub fn interaction(&self) -> Result<Interaction> {
        self.interaction.build(&self.folder)
    }

    /// The equations of motion.
    pub fn dynamics(&self) -> Dynamics {
        self.dynamics.build()
    }

    /// The plan for `method`, which [`MethodConfig::name`] names or leaves to the caller.
    pub fn plan(&self, method: Method) -> Plan {
        self.method.plan(method)
    }

    /// Generates `[system.generate]`: particles of the first type, with the radii asked for or else the cutoff.
    ///
    /// # Errors
    /// [`Error::NoSource`] when there is no `[system.generate]`; [`Error::Generate`].
    pub fn generate(&self) -> Result<(SimBox, Particles, Radii)> {
        let spec = self.system.generate.as_ref().ok_or(Error::NoSource)?;
        let generate::Generated { sim_box, particles, radii } =
            spec.build(self.boundary.axes(), self.interaction.types[0].mass)?;
        Ok((sim_box, particles, radii.unwrap_or(Radii::Uniform(self.interaction.cutoff as f32))))
    }
}
