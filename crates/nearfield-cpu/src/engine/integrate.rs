//! Velocity Verlet and its thermostats, one particle at a time.
//!
//! A step is `start` (half kick, drift, boundaries), new forces, `finish` (half kick). Langevin dynamics are the
//! BAOAB splitting: the drift is two half drifts with the Ornstein-Uhlenbeck step between (Leimkuhler and Matthews,
//! Appl. Math. Res. Express 2013, doi:10.1093/amrx/abs010). Noise is a function of (seed, step, id) alone.

use nearfield_core::{
    Boundary, Dynamics, Ensemble, ParticleType, SimBox,
    philox::{Stream, normals},
};
use std::ops::Range;

/// Particles that are looked at together for whether any has left the box or is too fast.
const SETTLED: usize = 64;

/// What changes of a particle in a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    pub position: [f32; 3],
    pub velocity: [f32; 3],
    pub image: [i32; 3],
}

/// The integrator of one run.
#[derive(Clone, Debug)]
pub(super) struct Integrator {
    sim_box: SimBox,
    dt: f32,
    /// Half a time step over the mass, by type.
    half_kick: Vec<f32>,
    /// Largest speed, from the displacement limit; infinite without.
    speed_limit: f32,
    langevin: Option<Langevin>,
}

#[derive(Clone, Debug)]
struct Langevin {
    seed: u64,
    /// exp(-friction dt)
    damping: f32,
    /// Standard deviation of the noise, by type.
    noise: Vec<f32>,
}

impl Integrator {
    pub fn new(sim_box: SimBox, dynamics: &Dynamics, types: &[ParticleType]) -> Self {
        let dt = dynamics.dt;
        let langevin = match dynamics.ensemble {
            Ensemble::Langevin { temperature, friction } => {
                let damping = (-friction * f64::from(dt)).exp();
                let noise =
                    |t: &ParticleType| ((1.0 - damping * damping) * temperature / f64::from(t.mass)).sqrt() as f32;
                Some(Langevin {
                    seed: dynamics.seed,
                    damping: damping as f32,
                    noise: types.iter().map(noise).collect(),
                })
            }
            Ensemble::Nve | Ensemble::Rescale { .. } => None,
        };
        Self {
            sim_box,
            dt,
            half_kick: types.iter().map(|t| 0.5 * dt / t.mass).collect(),
            speed_limit: if dynamics.max_displacement > 0.0 { dynamics.max_displacement / dt } else { f32::INFINITY },
            langevin,
        }
    }

    /// Whether [`Integrator::start_many`] and [`Integrator::kick_many`] do what [`Integrator::start`] and
    /// [`Integrator::finish`] do, bit for bit.
    pub fn has_fast_path(&self) -> bool {
        self.langevin.is_none()
    }

    /// First half kick and drift of neighbouring particles. Without types (`kind`) there is only one. Calls `settle`
    /// for groups of particles of which some may have left the box or are not finite.
    #[inline(always)]
    pub fn start_many(
        &self,
        position: [&mut [f32]; 3],
        velocity: [&mut [f32]; 3],
        force: [&[f32]; 3],
        kind: &[u32],
        mut settle: impl FnMut(Range<usize>, [&mut [f32]; 3], [&mut [f32]; 3]),
    ) {
        let ([x, y, z], [vx, vy, vz]) = (position, velocity);
        self.kick_many([&mut *vx, &mut *vy, &mut *vz], force, kind);
        let (lo, hi) = (self.sim_box.lo(), self.sim_box.hi());
        let mut at = 0;
        while at < x.len() {
            let group = at..(at + SETTLED).min(x.len());
            let mut outside = false;
            for (axis, (x, v)) in [(&mut *x, &*vx), (&mut *y, &*vy), (&mut *z, &*vz)].into_iter().enumerate() {
                let (lo, hi) = (lo[axis], hi[axis]);
                let mut inside = true;
                for (x, v) in x[group.clone()].iter_mut().zip(&v[group.clone()]) {
                    *x += self.dt * *v;
                    inside &= (*x >= lo) & (*x < hi);
                }
                outside |= !inside;
            }
            if outside {
                settle(group.clone(), [&mut *x, &mut *y, &mut *z], [&mut *vx, &mut *vy, &mut *vz]);
            }
            at = group.end;
        }
    }

    /// Second half kick of a step, then first half kick and drift of the next, of neighbouring particles along one
    /// axis, by their [`Integrator::half_kicks`]. Marks in `leaves` who is not finite or not in the box, or so fast that
    /// the limit may concern it.
    #[inline(always)]
    pub fn step_many<const N: usize>(
        &self,
        axis: usize,
        x: &mut [f32; N],
        v: &mut [f32; N],
        force: &[f32; N],
        half_kick: &[f32; N],
        leaves: &mut [u32; N],
    ) {
        let (lo, hi) = (self.sim_box.lo()[axis], self.sim_box.hi()[axis]);
        let slow = self.slow();
        for k in 0..N {
            v[k] += half_kick[k] * force[k];
            leaves[k] |= u32::from(v[k].abs() > slow);
            v[k] += half_kick[k] * force[k];
            leaves[k] |= u32::from(v[k].abs() > slow);
            x[k] += self.dt * v[k];
            leaves[k] |= u32::from(!((x[k] >= lo) & (x[k] < hi)));
        }
    }

    /// Half a time step over the masses of particles, by their types; without any there is only one.
    #[inline(always)]
    pub fn half_kicks<const N: usize>(&self, kind: &[u32]) -> [f32; N] {
        let mut half_kick = [self.half_kick[0]; N];
        if !kind.is_empty() {
            for (half_kick, &kind) in half_kick.iter_mut().zip(kind) {
                *half_kick = self.half_kick[kind as usize];
            }
        }
        half_kick
    }

    /// Half kick of neighbouring particles.
    #[inline(always)]
    pub fn kick_many(&self, mut velocity: [&mut [f32]; 3], force: [&[f32]; 3], kind: &[u32]) {
        for (velocity, force) in velocity.iter_mut().zip(force) {
            if kind.is_empty() {
                let half_kick = self.half_kick[0];
                for (v, f) in velocity.iter_mut().zip(force) {
                    *v += half_kick * f;
                }
            } else {
                for ((v, f), &kind) in velocity.iter_mut().zip(force).zip(kind) {
                    *v += self.half_kick[kind as usize] * f;
                }
            }
        }
        if self.speed_limit < f32::INFINITY {
            self.limit_many(velocity);
        }
    }

    /// Of each component of a velocity: below it, rounding included, a particle is slower than the limit.
    #[inline(always)]
    fn slow(&self) -> f32 {
        0.577 * self.speed_limit
    }

    /// Shortens the velocities of those that the limit concerns.
    fn limit_many(&self, [vx, vy, vz]: [&mut [f32]; 3]) {
        let slow = self.slow();
        let is_fast = |v: &[f32]| v.iter().fold(false, |fast, v| fast | (v.abs() > slow));
        let groups = vx.chunks_mut(SETTLED).zip(vy.chunks_mut(SETTLED)).zip(vz.chunks_mut(SETTLED));
        for ((x, y), z) in groups.filter(|((x, y), z)| is_fast(x) | is_fast(y) | is_fast(z)) {
            for ((x, y), z) in x.iter_mut().zip(y).zip(z) {
                if x.abs().max(y.abs()).max(z.abs()) > slow {
                    let mut p = Moving { position: [0.0; 3], velocity: [*x, *y, *z], image: [0; 3] };
                    self.limit(&mut p);
                    [*x, *y, *z] = p.velocity;
                }
            }
        }
    }

    /// First half kick and drift of `step`.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "one axis of several vectors")]
    pub fn start(&self, p: &mut Moving, force: [f32; 3], kind: u32, id: u32, step: u64) {
        self.kick(p, force, kind);
        self.limit(p);
        match &self.langevin {
            None => self.drift(p, self.dt),
            Some(langevin) => {
                self.drift(p, 0.5 * self.dt);
                let noise = normals(langevin.seed, Stream::Langevin, step, id);
                for axis in 0..3 {
                    p.velocity[axis] =
                        langevin.damping * p.velocity[axis] + langevin.noise[kind as usize] * noise[axis] as f32;
                }
                self.limit(p);
                self.drift(p, 0.5 * self.dt);
            }
        }
    }

    /// Second half kick.
    #[inline(always)]
    pub fn finish(&self, p: &mut Moving, force: [f32; 3], kind: u32) {
        self.kick(p, force, kind);
        // Here too, so that observers see a velocity that the particle will move by.
        self.limit(p);
    }

    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "one axis of several vectors")]
    fn kick(&self, p: &mut Moving, force: [f32; 3], kind: u32) {
        let half_kick = self.half_kick[kind as usize];
        for axis in 0..3 {
            p.velocity[axis] += half_kick * force[axis];
        }
    }

    /// Shortens a velocity that would carry the particle beyond the displacement limit.
    #[inline(always)]
    fn limit(&self, p: &mut Moving) {
        if self.speed_limit == f32::INFINITY {
            return;
        }
        // In f64: capped forces of 1e30 square beyond f32.
        let speed = p.velocity.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>().sqrt();
        if speed > f64::from(self.speed_limit) {
            let scale = f64::from(self.speed_limit) / speed;
            p.velocity = p.velocity.map(|v| (f64::from(v) * scale) as f32);
        }
    }

    #[inline(always)]
    fn drift(&self, p: &mut Moving, dt: f32) {
        for axis in 0..3 {
            p.position[axis] += dt * p.velocity[axis];
        }
        let (lo, hi) = (self.sim_box.lo(), self.sim_box.hi());
        let inside = (0..3).all(|axis| p.position[axis] >= lo[axis] && p.position[axis] < hi[axis]);
        if !inside {
            self.apply_boundaries(p);
        }
    }

    /// Wraps on periodic axes and reflects at walls, where the particle has left the box.
    #[cold]
    pub fn settle(&self, p: &mut Moving) {
        let (lo, hi) = (self.sim_box.lo(), self.sim_box.hi());
        if !(0..3).all(|axis| p.position[axis] >= lo[axis] && p.position[axis] < hi[axis]) {
            self.apply_boundaries(p);
        }
    }

    #[cold]
    #[expect(clippy::needless_range_loop, reason = "one axis of several vectors")]
    fn apply_boundaries(&self, p: &mut Moving) {
        let (wrapped, crossings) = self.sim_box.wrap(p.position);
        p.position = wrapped;
        for axis in 0..3 {
            p.image[axis] = p.image[axis].wrapping_add(crossings[axis]);
            if self.sim_box.boundary()[axis] == Boundary::Wall {
                self.reflect(p, axis);
            }
        }
    }

    fn reflect(&self, p: &mut Moving, axis: usize) {
        let (lo, hi) = (self.sim_box.lo()[axis], self.sim_box.hi()[axis]);
        let x = p.position[axis];
        if (lo..=hi).contains(&x) || !x.is_finite() {
            return;
        }
        // A fast particle may bounce several times: unfold by the period of two lengths.
        let (length, from_lo) = (f64::from(hi) - f64::from(lo), f64::from(x) - f64::from(lo));
        let phase = from_lo.rem_euclid(2.0 * length);
        let reflected = if phase > length { 2.0 * length - phase } else { phase };
        p.position[axis] = ((f64::from(lo) + reflected) as f32).clamp(lo, hi);
        // An odd number of bounces turns the velocity.
        if (from_lo / length).floor().rem_euclid(2.0) == 1.0 {
            p.velocity[axis] = -p.velocity[axis];
        }
    }
}
