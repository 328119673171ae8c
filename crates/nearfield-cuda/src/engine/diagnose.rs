//! Which particle is to blame when a run has failed.

use super::{loaded::Loaded, totals::Failure};
use nearfield_core::{Error, Particles, PerParticle, Result};

impl Loaded {
    /// Why the force on a particle is not finite.
    pub fn diagnose_force(&self, failure: Failure) -> Result<Error> {
        let Failure { step, particle } = failure;
        let particle = particle as usize;
        // Later on two particles meet only where a run has blown up.
        if step == 0 && self.physics.interaction.potential.diverges_at_zero() {
            let mut particles = Particles::default();
            self.state.copy_to(&mut particles)?;
            let place = particles.position.get(particle);
            let twin = (0..particles.len()).find(|&i| i != particle && particles.position.get(i) == place);
            if let Some(twin) = twin {
                return Ok(Error::Coincident(particle.min(twin), particle.max(twin)));
            }
        }
        let mut results = PerParticle::default();
        self.results.copy_to(&self.state.id, &mut results)?;
        let value = results.force.get(particle).into_iter().find(|f| !f.is_finite()).unwrap_or(f32::NAN);
        Ok(Error::NonFinite { step, what: "force", particle, value: f64::from(value) })
    }

    /// The first particle, in input order, whose `what` is not finite.
    pub fn first_not_finite(&self, what: &str) -> Result<usize> {
        if what == "energy" {
            let mut results = PerParticle::default();
            self.results.copy_to(&self.state.id, &mut results)?;
            return Ok(results.energy.iter().position(|energy| !energy.is_finite()).unwrap_or(0));
        }
        let mut particles = Particles::default();
        self.state.copy_to(&mut particles)?;
        Ok(particles.velocity.iter().position(|v| v.iter().any(|v| !v.is_finite())).unwrap_or(0))
    }
}
