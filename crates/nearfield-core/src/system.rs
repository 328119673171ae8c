//! What is simulated: box, particles, ranges and interaction.

use crate::{Error, Interaction, Particles, Radii, Result, SimBox};

/// A complete physical system.
#[derive(Clone, Debug)]
pub struct System {
    /// The box and its boundaries.
    pub sim_box: SimBox,
    /// The particles.
    pub particles: Particles,
    /// Interaction ranges.
    pub radii: Radii,
    /// Potential, truncation, types.
    pub interaction: Interaction,
}

impl System {
    /// Wraps positions into the box on periodic axes, counting image crossings.
    pub fn wrap(&mut self) {
        for i in 0..self.particles.len() {
            let (wrapped, crossings) = self.sim_box.wrap(self.particles.position.get(i));
            self.particles.position.set(i, wrapped);
            for (image, crossed) in self.particles.image[i].iter_mut().zip(crossings) {
                *image += crossed;
            }
        }
    }

    /// Checks everything an engine relies on. Call it once, where input enters.
    ///
    /// # Errors
    /// The first problem found, naming the particle: lengths, finiteness, positions within walls, ranges, types,
    /// interaction parameters.
    pub fn validate(&self) -> Result<()> {
        let particles = &self.particles;
        Particles::validate_positions(&particles.position, &self.sim_box)?;
        let expected = particles.len();
        let lengths = [
            ("velocities", particles.velocity.len()),
            ("types", particles.kind.len()),
            ("images", particles.image.len()),
        ];
        for (what, found) in lengths {
            if found != expected {
                return Err(Error::LengthMismatch { what, found, expected });
            }
        }
        for particle in 0..expected {
            self.validate_particle(particle)?;
        }
        self.radii.validate(expected, &self.sim_box)?;
        self.interaction.validate()
    }

    fn validate_particle(&self, particle: usize) -> Result<()> {
        let velocity = self.particles.velocity.get(particle);
        if let Some(axis) = velocity.iter().position(|v| !v.is_finite()) {
            return Err(Error::NonFiniteVelocity { particle, axis, value: velocity[axis] });
        }
        let kind = self.particles.kind[particle];
        let n_types = self.interaction.types.len();
        if kind as usize >= n_types {
            return Err(Error::UnknownType { particle, kind, n_types });
        }
        Ok(())
    }
}
