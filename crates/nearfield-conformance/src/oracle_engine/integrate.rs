//! One step of velocity Verlet with its thermostats, as plainly as they can be written.

use super::{Fault, OracleEngine};
use nearfield_core::{
    Boundary, Dynamics, Ensemble, Error, Quantities, Result, System, Totals,
    philox::{Stream, normals},
};

impl OracleEngine {
    /// The step that ends at `step`.
    pub(super) fn step(
        &mut self,
        dynamics: &Dynamics,
        step: u64,
        quantities: Quantities,
        capped: bool,
    ) -> Result<Totals> {
        let dt = dynamics.dt;
        let fault = self.fault;
        let loaded = self.loaded()?;
        let n = loaded.system.particles.len();
        let mass = |system: &System, i: usize| match fault {
            Some(Fault::IgnoresMass) => 1.0,
            _ => system.interaction.types[system.particles.kind[i] as usize].mass,
        };
        let first_kick = if fault == Some(Fault::FirstOrder) { dt } else { 0.5 * dt };
        for i in 0..n {
            let system = &mut loaded.system;
            let (m, f) = (mass(system, i), loaded.force.get(i));
            let mut v = system.particles.velocity.get(i);
            for (v, f) in v.iter_mut().zip(f) {
                *v += first_kick * f / m;
            }
            system.particles.velocity.set(i, limited(v, dynamics));
            if let Ensemble::Langevin { temperature, friction } = dynamics.ensemble {
                drift(system, i, 0.5 * dt, fault);
                let damping = (-friction * f64::from(dt)).exp();
                let strength = if fault == Some(Fault::NoiseTooStrong) { 1.1 } else { 1.0 };
                let noise = strength * ((1.0 - damping * damping) * temperature / f64::from(m)).sqrt();
                let random = normals(dynamics.seed, Stream::Langevin, step, i as u32);
                let mut v = system.particles.velocity.get(i);
                for (v, random) in v.iter_mut().zip(random) {
                    *v = (damping * f64::from(*v) + noise * random) as f32;
                }
                system.particles.velocity.set(i, limited(v, dynamics));
                drift(system, i, 0.5 * dt, fault);
            } else {
                drift(system, i, dt, fault);
            }
        }
        loaded.pairs = None;
        check_finite(&loaded.system, step)?;
        let mut totals = self.compute(quantities, capped)?;
        let loaded = self.loaded()?;
        for i in 0..n {
            let (m, f) = (mass(&loaded.system, i), loaded.force.get(i));
            let mut v = loaded.system.particles.velocity.get(i);
            for (v, f) in v.iter_mut().zip(f) {
                *v += (dt - first_kick) * f / m;
            }
            loaded.system.particles.velocity.set(i, v);
        }
        if let Ensemble::Rescale { temperature, relaxation } = dynamics.ensemble {
            rescale(&mut loaded.system, temperature, f64::from(dt) / relaxation, dynamics.seed, step);
        }
        let (kinetic_energy, momentum) = motion(&loaded.system);
        (totals.kinetic_energy, totals.momentum) = (kinetic_energy, momentum);
        Ok(totals)
    }
}

fn check_finite(system: &System, step: u64) -> Result<()> {
    for (particle, x) in system.particles.position.iter().enumerate() {
        if let Some(&value) = x.iter().find(|x| !x.is_finite()) {
            return Err(Error::NonFinite { step, what: "position", particle, value: value.into() });
        }
    }
    Ok(())
}

fn limited(v: [f32; 3], dynamics: &Dynamics) -> [f32; 3] {
    let speed = v.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>().sqrt();
    let limit = f64::from(dynamics.max_displacement / dynamics.dt);
    if limit > 0.0 && speed > limit { v.map(|v| (f64::from(v) * limit / speed) as f32) } else { v }
}

fn drift(system: &mut System, i: usize, dt: f32, fault: Option<Fault>) {
    let (mut x, mut v) = (system.particles.position.get(i), system.particles.velocity.get(i));
    for (x, v) in x.iter_mut().zip(v) {
        *x += dt * v;
    }
    let (mut x, crossings) = system.sim_box.wrap(x);
    for axis in 0..3 {
        system.particles.image[i][axis] += crossings[axis];
        if system.sim_box.boundary()[axis] == Boundary::Wall && fault != Some(Fault::LeakyWalls) {
            let (lo, hi) = (system.sim_box.lo()[axis], system.sim_box.hi()[axis]);
            while x[axis].is_finite() && !(lo..=hi).contains(&x[axis]) {
                x[axis] = if x[axis] < lo { lo + (lo - x[axis]) } else { hi - (x[axis] - hi) };
                v[axis] = -v[axis];
            }
        }
    }
    system.particles.position.set(i, x);
    system.particles.velocity.set(i, v);
}

fn motion(system: &System) -> (f64, [f64; 3]) {
    let (mut energy, mut momentum) = (0.0, [0.0; 3]);
    for (v, &kind) in system.particles.velocity.iter().zip(&system.particles.kind) {
        let mass = f64::from(system.interaction.types[kind as usize].mass);
        for (total, v) in momentum.iter_mut().zip(v) {
            *total += mass * f64::from(v);
            energy += 0.5 * mass * f64::from(v).powi(2);
        }
    }
    (energy, momentum)
}

/// Bussi, Donadio and Parrinello (2007), eq. (A7), with 3N - 3 degrees of freedom. The sum of squares is drawn number
/// by number.
fn rescale(system: &mut System, temperature: f64, time: f64, seed: u64, step: u64) {
    let (kinetic, _) = motion(system);
    let degrees = (3 * system.particles.len()).saturating_sub(3).max(1);
    let random: Vec<f64> =
        (0..degrees.div_ceil(4) as u32).flat_map(|k| normals(seed, Stream::Rescale, step, k)).take(degrees).collect();
    let (c, target) = ((-time).exp(), 0.5 * degrees as f64 * temperature);
    let share = (1.0 - c) * target / (degrees as f64 * kinetic);
    let squares: f64 = random.iter().map(|r| r * r).sum();
    let factor = (c + share * squares + 2.0 * random[0] * (c * share).sqrt()).sqrt() as f32;
    for axis in system.particles.velocity.axes_mut() {
        axis.iter_mut().for_each(|v| *v *= factor);
    }
}
