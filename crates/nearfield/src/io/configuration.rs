//! What a file gives, before it becomes a `System`.

use super::{Problem, error::Parsed};
use nearfield_core::{System, Vec3s};
use std::collections::HashMap;

/// Particles as a file lists them. Arrays are `[N]`, in the order of the file, lengths in the units of the file.
///
/// ```
/// use nearfield::io::Configuration;
/// let molecule: Configuration = Configuration::at([[0.0, 0.0, 0.0], [0.0, 0.0, 1.1]]);
/// assert_eq!(molecule.len(), 2);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Configuration {
    /// Positions, \[length\], as in the file: not wrapped into the box.
    pub position: Vec3s,
    /// Velocities, \[length/time\].
    pub velocity: Option<Vec3s>,
    /// Forces, \[energy/length\].
    pub force: Option<Vec3s>,
    /// Species of each particle.
    pub species: Species,
    /// Mass of each *species*, `[species.names.len()]`, \[mass\].
    pub mass: Option<Vec<f32>>,
    /// Search radius of each particle, \[length\].
    pub radius: Option<Vec<f32>>,
    /// Periodic image of each particle: the unwrapped position is `position + image * box length`.
    pub image: Option<Vec<[i32; 3]>>,
    /// Id of each particle.
    pub id: Option<Vec<u64>>,
    /// The box.
    pub bounds: Option<Bounds>,
    /// Time step number.
    pub step: Option<u64>,
    /// Time, \[time\].
    pub time: Option<f64>,
    /// The title or comment.
    pub comment: Option<String>,
}

/// Names of the species and the species of each particle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Species {
    /// Each name once. LAMMPS types are named by their label, or else by their number: "1", "2", ...
    pub names: Vec<String>,
    /// Index into `names` of each particle, `[N]`.
    pub of: Vec<u32>,
}

/// The bounds of an orthorhombic box, \[length\]; always finite and of positive length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower corner.
    pub lo: [f32; 3],
    /// Upper corner.
    pub hi: [f32; 3],
    /// Which axes are periodic, where the format tells.
    pub periodic: Option<[bool; 3]>,
}

impl Configuration {
    /// Particles of one species, named `X`.
    pub fn at(positions: impl IntoIterator<Item = [f32; 3]>) -> Self {
        let position: Vec3s = positions.into_iter().collect();
        let species = Species { names: vec!["X".into()], of: vec![0; position.len()] };
        Self { position, species, ..Self::default() }
    }

    /// Number of particles, N.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Why this cannot be written, if so: arrays of different lengths, or a species without a usable name.
    pub(super) fn flaw(&self) -> Option<String> {
        let n = self.len();
        let lengths = [
            ("velocities", self.velocity.as_ref().map(Vec3s::len)),
            ("forces", self.force.as_ref().map(Vec3s::len)),
            ("species", Some(self.species.of.len())),
            ("radii", self.radius.as_ref().map(Vec::len)),
            ("images", self.image.as_ref().map(Vec::len)),
            ("ids", self.id.as_ref().map(Vec::len)),
        ];
        for (what, length) in lengths {
            if let Some(found) = length.filter(|&found| found != n) {
                return Some(format!("{what} has {found} entries, but there are {n} particles"));
            }
        }
        let n_species = self.species.names.len();
        if let Some(found) = self.mass.as_ref().map(Vec::len).filter(|&found| found != n_species) {
            return Some(format!("masses has {found} entries, but there are {n_species} species"));
        }
        if let Some(particle) = self.species.of.iter().position(|&kind| kind as usize >= n_species) {
            return Some(format!("the species of particle {particle} has no name"));
        }
        let unusable = |name: &&String| name.is_empty() || name.contains(|c: char| c.is_whitespace() || c == '#');
        self.species.names.iter().find(unusable).map(|name| {
            format!("species name `{name}` is empty or contains white space or `#`, which the format cannot hold")
        })
    }
}

impl From<&System> for Configuration {
    /// Everything a file can say about the system; ids, step and time are left to the caller.
    fn from(system: &System) -> Self {
        let sim_box = &system.sim_box;
        let periodic = Some(std::array::from_fn(|axis| sim_box.is_periodic(axis)));
        let types = &system.interaction.types;
        Self {
            position: system.particles.position.clone(),
            velocity: Some(system.particles.velocity.clone()),
            species: Species {
                names: types.iter().map(|t| t.name.clone()).collect(),
                of: system.particles.kind.clone(),
            },
            mass: Some(types.iter().map(|t| t.mass).collect()),
            radius: match &system.radii {
                nearfield_core::Radii::Uniform(_) => None,
                nearfield_core::Radii::PerParticle(radii) => Some(radii.clone()),
            },
            image: Some(system.particles.image.clone()),
            bounds: Some(Bounds { lo: sim_box.lo(), hi: sim_box.hi(), periodic }),
            ..Self::default()
        }
    }
}

impl Bounds {
    /// Bounds rounded to single precision.
    pub(super) fn new(lo: [f64; 3], hi: [f64; 3], periodic: Option<[bool; 3]>) -> Parsed<Self> {
        let bounds = Self { lo: lo.map(|v| v as f32), hi: hi.map(|v| v as f32), periodic };
        for axis in 0..3 {
            let length = bounds.hi[axis] - bounds.lo[axis];
            if !(bounds.lo[axis].is_finite() && length.is_finite() && length > 0.0) {
                let name = ["x", "y", "z"][axis];
                return Err(Problem::InvalidBox { axis: name, lo: lo[axis], hi: hi[axis] });
            }
        }
        Ok(bounds)
    }
}

/// Collects the species of particles that come one by one, by name.
#[derive(Default)]
pub(super) struct SpeciesCollector {
    species: Species,
    index: HashMap<String, u32>,
}

impl SpeciesCollector {
    /// Adds a particle; names are numbered in order of their first appearance.
    pub(super) fn push(&mut self, name: &str) -> u32 {
        let names = &mut self.species.names;
        let same_as_before = self.species.of.last().filter(|&&kind| names[kind as usize] == name);
        let kind = match same_as_before {
            Some(&kind) => kind,
            None => *self.index.entry(name.to_owned()).or_insert_with(|| {
                names.push(name.to_owned());
                names.len() as u32 - 1
            }),
        };
        self.species.of.push(kind);
        kind
    }

    pub(super) fn finish(self) -> Species {
        self.species
    }
}
