//! Steps by `cluster`: particles are moved in their blocks, right after the pairs.

use super::{
    clusters::Listing,
    evaluate::{Loaded, NonFiniteWatch},
    integrate::{Integrator, Moving},
    state::State,
};
use crate::{
    cluster::{BLOCK, Mover, has_vector_law},
    parallel::Scattered,
};
use nearfield_core::{Method, Quantities, Result};
use std::{ops::Range, time::Instant};

impl Loaded {
    /// Whether steps may be taken by [`Loaded::advance_clusters`].
    pub fn steps_by_clusters(&self, integrator: &Integrator) -> bool {
        self.plan.method == Method::Cluster
            && !self.plan.deterministic
            && self.clusters.listing == Listing::Possible
            && has_vector_law(&self.physics)
            && integrator.has_fast_path()
    }

    /// Steps in which one pass over the particles, after the pairs, adds their forces up, ends a step and begins the
    /// next. The arithmetic of a step is that of separate passes.
    pub fn advance_clusters(
        &mut self,
        integrator: &Integrator,
        from: u64,
        steps: u64,
        quantities: Quantities,
    ) -> Result<()> {
        self.start(integrator, from + 1)?;
        for step in from + 1..from + steps {
            self.prepare(step);
            if self.clusters.listing == Listing::Possible && !self.sparse.found {
                self.move_by_clusters(integrator, step)?;
            } else {
                self.query(Quantities::FORCES, step)?;
                self.finish_and_start(integrator, step + 1)?;
            }
        }
        let evaluated = self.evaluate(quantities, from + steps);
        self.clusters.clusters.fetch_positions(&mut self.state.position);
        evaluated?;
        self.finish(integrator);
        Ok(())
    }

    fn move_by_clusters(&mut self, integrator: &Integrator, step: u64) -> Result<()> {
        self.results.prepare(self.state.len(), false);
        let (forces, positions) = (NonFiniteWatch::default(), NonFiniteWatch::default());
        let start = Instant::now();
        let State { velocity, image, kind, id, .. } = &mut self.state;
        let mover = Verlet {
            integrator,
            step,
            velocity: velocity.axes_mut().map(|axis| Scattered::new(axis)),
            force: self.results.force.axes_mut().map(|axis| Scattered::new(axis)),
            keeps_force: self.clusters.clusters.wants_forces(),
            image: Scattered::new(image),
            kind,
            id,
            forces: &forces,
            positions: &positions,
        };
        self.clusters.clusters.advance(&self.physics, &mover);
        self.steps += 1;
        self.account(start.elapsed().as_secs_f64());
        let (force, position) = (forces.first(), positions.first());
        if force.is_some() || position.is_some() {
            self.clusters.clusters.fetch_positions(&mut self.state.position);
        }
        match force {
            Some(particle) => Err(self.diagnose(particle, step)),
            None => self.check_positions(&positions, step + 1),
        }
    }
}

/// The second half kick of a step, then the first half kick and the drift of the next.
struct Verlet<'a> {
    integrator: &'a Integrator,
    /// The one that ends.
    step: u64,
    velocity: [Scattered<'a, f32>; 3],
    force: [Scattered<'a, f32>; 3],
    /// Whether forces are to be kept: where the next list may be pruned they tell how particles will move.
    keeps_force: bool,
    image: Scattered<'a, [i32; 3]>,
    kind: &'a [u32],
    id: &'a [u32],
    forces: &'a NonFiniteWatch,
    positions: &'a NonFiniteWatch,
}

/// Values of eight particles along each axis.
type Eight = [[f32; BLOCK]; 3];

impl Mover for Verlet<'_> {
    #[inline(always)]
    fn advance(&self, particles: Range<usize>, force: &Eight, position: &mut Eight) {
        if particles.len() < BLOCK {
            return self.advance_some(particles, force, position);
        }
        let at = particles.start;
        let ([vx, vy, vz], [fx, fy, fz]) = (&self.velocity, &self.force);
        // SAFETY: no two blocks have a particle in common, and each is moved once.
        let (vx, vy, vz) = unsafe { (vx.chunk(at), vy.chunk(at), vz.chunk(at)) };
        if self.keeps_force {
            // SAFETY: as above.
            unsafe { (*fx.chunk(at), *fy.chunk(at), *fz.chunk(at)) = (force[0], force[1], force[2]) };
        }
        let (mut next, mut velocity) = (*position, [*vx, *vy, *vz]);
        if self.step(&particles, &mut next, &mut velocity, force) {
            *position = next;
            [*vx, *vy, *vz] = velocity;
        } else {
            self.advance_each(particles, force, position);
        }
    }
}

impl Verlet<'_> {
    /// Whether all of a block stay in the box as they move; otherwise, what they come to means nothing.
    #[inline(always)]
    fn step(&self, particles: &Range<usize>, position: &mut Eight, velocity: &mut Eight, force: &Eight) -> bool {
        let half_kick = self.integrator.half_kicks(self.kind.get(particles.clone()).unwrap_or(&[]));
        let mut leaves = [0; BLOCK];
        for (axis, force) in force.iter().enumerate() {
            self.integrator.step_many(axis, &mut position[axis], &mut velocity[axis], force, &half_kick, &mut leaves);
        }
        leaves == [0; BLOCK]
    }

    /// The particles of a block that is not full.
    #[cold]
    fn advance_some(&self, particles: Range<usize>, force: &Eight, position: &mut Eight) {
        // SAFETY: as in `advance`.
        let (v, f) = unsafe { (axes(&self.velocity, &particles), axes(&self.force, &particles)) };
        let (n, mut next, mut velocity) = (particles.len(), *position, [[0.0; BLOCK]; 3]);
        for axis in 0..3 {
            f[axis].copy_from_slice(&force[axis][..n]);
            // Padding does not leave the box where the first particle does not.
            next[axis][n..].fill(position[axis][0]);
            velocity[axis][..n].copy_from_slice(v[axis]);
        }
        if self.step(&particles, &mut next, &mut velocity, force) {
            for axis in 0..3 {
                position[axis][..n].copy_from_slice(&next[axis][..n]);
                v[axis].copy_from_slice(&velocity[axis][..n]);
            }
        } else {
            self.advance_each(particles, force, position);
        }
    }

    /// The particles of a block of which some leave the box or are not finite.
    #[cold]
    fn advance_each(&self, particles: Range<usize>, force: &Eight, position: &mut Eight) {
        for (lane, i) in particles.enumerate() {
            // SAFETY: as in `advance`.
            let velocity = self.velocity.each_ref().map(|axis| unsafe { axis.range(i..i + 1)[0] });
            // SAFETY: as in `advance`.
            let image = unsafe { &mut self.image.range(i..i + 1)[0] };
            let mut p = Moving { position: position.map(|axis| axis[lane]), velocity, image: *image };
            let (force, id) = (force.map(|axis| axis[lane]), self.id[i]);
            let kind = self.kind.get(i).copied().unwrap_or(0);
            self.forces.see(force, id);
            for (to, force) in self.force.iter().zip(force) {
                // SAFETY: as in `advance`.
                unsafe { to.write(i, force) };
            }
            self.integrator.finish(&mut p, force, kind);
            self.integrator.start(&mut p, force, kind, id, self.step + 1);
            self.positions.see(p.position, id);
            *image = p.image;
            for (axis, (x, v)) in p.position.into_iter().zip(p.velocity).enumerate() {
                position[axis][lane] = x;
                // SAFETY: as in `advance`.
                unsafe { self.velocity[axis].write(i, v) };
            }
        }
    }
}

/// A range of each array.
///
/// # Safety
/// As for [`Scattered::range`].
#[inline(always)]
#[expect(clippy::mut_from_ref, reason = "as for Scattered::range")]
unsafe fn axes<'a>(of: &'a [Scattered<'_, f32>; 3], range: &Range<usize>) -> [&'a mut [f32]; 3] {
    // SAFETY: the caller's promise.
    unsafe { [of[0].range(range.clone()), of[1].range(range.clone()), of[2].range(range.clone())] }
}
