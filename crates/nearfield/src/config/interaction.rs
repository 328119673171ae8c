//! `[interaction]`: forces, and the types of particles they act between.

use super::{Error, Result};
use nearfield_core::{
    Interaction, Mixing, ParticleType, Truncation,
    interaction::RADIUS_PER_SIGMA,
    potentials::{Gaussian, LennardJones, Morse, Potential, Table, Wca, Yukawa},
};
use serde::{Deserialize, Deserializer, Serialize, de};
use std::{
    collections::HashSet,
    fmt,
    path::{Path, PathBuf},
    sync::Arc,
};

/// Names of the potentials.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PotentialName {
    /// 12-6 Lennard-Jones.
    #[default]
    LennardJones,
    /// Weeks-Chandler-Andersen.
    Wca,
    /// Screened Coulomb.
    Yukawa,
    /// Morse.
    Morse,
    /// Gaussian repulsion.
    Gaussian,
    /// From a file.
    Table,
}

/// One `[[interaction.type]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TypeConfig {
    /// Matches a species of extended XYZ or a type id of LAMMPS data. Without a name, an entry is called by its
    /// number from 1, and a single such entry stands for whatever one species the input has.
    #[serde(deserialize_with = "name_or_number")]
    pub name: Option<String>,
    /// Energy scale, \[energy\].
    pub epsilon: f64,
    /// Length scale, \[length\].
    pub sigma: f64,
    /// Mass, \[mass\].
    pub mass: f64,
}

impl Default for TypeConfig {
    fn default() -> Self {
        Self { name: None, epsilon: 1.0, sigma: 1.0, mass: 1.0 }
    }
}

/// LAMMPS types are numbers: accept `name = 1` for `name = "1"`.
fn name_or_number<'de, D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Option<String>, D::Error> {
    struct Visitor;
    impl de::Visitor<'_> for Visitor {
        type Value = String;
        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a name or a number")
        }
        fn visit_str<E: de::Error>(self, name: &str) -> std::result::Result<String, E> {
            Ok(name.to_owned())
        }
        fn visit_i64<E: de::Error>(self, number: i64) -> std::result::Result<String, E> {
            Ok(number.to_string())
        }
    }
    deserializer.deserialize_any(Visitor).map(Some)
}

/// `[interaction]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct InteractionConfig {
    /// The potential.
    pub potential: PotentialName,
    /// Cutoff, \[length\]; ignored where particles have radii.
    pub cutoff: f64,
    /// What is done to the potential at the cutoff.
    pub truncation: Truncation,
    /// How unlike types mix.
    pub mixing: Mixing,
    /// Add the long-range part of a homogeneous Lennard-Jones fluid to energy and pressure.
    pub tail_correction: bool,
    /// Inverse screening length of Yukawa, \[1/length\].
    pub kappa: f64,
    /// Width parameter of Morse, \[1/length\].
    pub alpha: f64,
    /// File of columns r U F, relative to the configuration's folder.
    pub table: Option<PathBuf>,
    /// Sigma of a pair is its range over this, where particles have radii.
    pub radius_per_sigma: f64,
    /// `[[interaction.type]]`, at least one.
    #[serde(rename = "type")]
    pub types: Vec<TypeConfig>,
}

impl Default for InteractionConfig {
    fn default() -> Self {
        Self {
            potential: PotentialName::LennardJones,
            cutoff: 2.5,
            truncation: Truncation::Cut,
            mixing: Mixing::LorentzBerthelot,
            tail_correction: false,
            kappa: 1.0,
            alpha: 5.0,
            table: None,
            radius_per_sigma: f64::from(RADIUS_PER_SIGMA),
            types: vec![TypeConfig::default()],
        }
    }
}

impl InteractionConfig {
    pub(super) fn validate(&self) -> Result<()> {
        // In f32, where parameters live: a tiny positive f64 may be zero there.
        let positive = |value: f64| (value as f32).is_finite() && value as f32 > 0.0;
        let check = |ok: bool, key: String, value: f64, reason: &str| {
            if ok { Ok(()) } else { Err(Error::invalid(format!("interaction.{key}"), value, reason)) }
        };
        let parameters = [
            ("cutoff", self.cutoff),
            ("kappa", self.kappa),
            ("alpha", self.alpha),
            ("radius_per_sigma", self.radius_per_sigma),
        ];
        for (key, value) in parameters {
            check(positive(value), key.into(), value, "must be positive and finite")?;
        }
        if self.potential == PotentialName::Table && self.table.is_none() {
            return Err(Error::NoTable);
        }
        if self.types.is_empty() {
            return Err(Error::invalid("interaction.type", "[]", "at least one type is needed"));
        }
        let mut names = HashSet::new();
        for (i, kind) in self.types.iter().enumerate() {
            let epsilon = kind.epsilon;
            let ok = (epsilon as f32).is_finite() && epsilon >= 0.0;
            check(ok, format!("type.{i}.epsilon"), epsilon, "must be finite and not negative")?;
            check(positive(kind.sigma), format!("type.{i}.sigma"), kind.sigma, "must be positive and finite")?;
            check(positive(kind.mass), format!("type.{i}.mass"), kind.mass, "must be positive and finite")?;
            if !names.insert(self.type_name(i)) {
                return Err(Error::DuplicateType(self.type_name(i)));
            }
        }
        Ok(())
    }

    /// Name of type `i`, its number from 1 where it has none.
    fn type_name(&self, i: usize) -> String {
        self.types[i].name.clone().unwrap_or_else(|| (i + 1).to_string())
    }

    /// Index into the types of each of the different `species` of an input: names of extended XYZ, type ids of
    /// LAMMPS data. A single type without a name stands for any one species.
    ///
    /// # Errors
    /// [`Error::UnknownSpecies`].
    pub fn match_species<S: AsRef<str>>(&self, species: &[S]) -> Result<Vec<u32>> {
        if let ([TypeConfig { name: None, .. }], [_]) = (self.types.as_slice(), species) {
            return Ok(vec![0]);
        }
        let names: Vec<String> = (0..self.types.len()).map(|i| self.type_name(i)).collect();
        let index = |species: &str| {
            names.iter().position(|name| name == species).map(|i| i as u32).ok_or_else(|| Error::UnknownSpecies {
                species: species.to_owned(),
                known: names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", "),
            })
        };
        species.iter().map(|species| index(species.as_ref())).collect()
    }

    pub(super) fn build(&self, folder: &Path) -> Result<Interaction> {
        let potential = match self.potential {
            PotentialName::LennardJones => Potential::LennardJones(LennardJones),
            PotentialName::Wca => Potential::Wca(Wca),
            PotentialName::Yukawa => Potential::Yukawa(Yukawa { kappa: self.kappa as f32 }),
            PotentialName::Morse => Potential::Morse(Morse { alpha: self.alpha as f32 }),
            PotentialName::Gaussian => Potential::Gaussian(Gaussian),
            PotentialName::Table => {
                let path = self.table.as_ref().ok_or(Error::NoTable)?;
                Potential::Table(Arc::new(read_table(&folder.join(path))?))
            }
        };
        let types = self.types.iter().enumerate().map(|(i, kind)| ParticleType {
            name: self.type_name(i),
            epsilon: kind.epsilon as f32,
            sigma: kind.sigma as f32,
            mass: kind.mass as f32,
        });
        Ok(Interaction {
            potential,
            truncation: self.truncation,
            mixing: self.mixing,
            types: types.collect(),
            radius_per_sigma: self.radius_per_sigma as f32,
        })
    }
}

/// Columns r U F separated by blanks; `#` begins a comment.
fn read_table(path: &Path) -> Result<Table> {
    let text = std::fs::read_to_string(path).map_err(|source| Error::Read { path: path.into(), source })?;
    let mut rows = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        let row: Option<Vec<f64>> = line.split_whitespace().map(|value| value.parse().ok()).collect();
        match row.as_deref() {
            Some([]) => {}
            Some(&[r, u, f]) => rows.push([r, u, f]),
            _ => return Err(Error::TableRow { path: path.into(), line: number + 1 }),
        }
    }
    Table::new(&rows).map_err(|source| Error::Table { path: path.into(), source })
}
