//! Kernels and programs that differ in how they compute forces.

use crate::layouts::{Integrator, Law};

/// One of `P` for each way to compute forces.
#[derive(Clone, Copy, Debug)]
pub struct ByForce<P> {
    /// Any interaction, in f32.
    pub fast: P,
    /// With energies.
    pub energy: P,
    /// Any interaction, in sums that do not depend on order.
    pub exact: P,
    /// With energies.
    pub exact_energy: P,
    /// Forces of plain Lennard-Jones with one cutoff.
    pub uniform_lj: P,
    /// Forces of plain Lennard-Jones with per-particle radii.
    pub scaled_lj: P,
}

impl<P: Copy> ByForce<P> {
    /// The fastest that computes a law with or without order-independent sums and energies.
    pub fn choose(&self, law: &Law, exact: bool, energy: bool) -> P {
        match (exact, energy) {
            (true, true) => self.exact_energy,
            (true, false) => self.exact,
            (false, true) => self.energy,
            (false, false) if !law.is_plain_lennard_jones() => self.fast,
            (false, false) if law.variable == 0 => self.uniform_lj,
            (false, false) => self.scaled_lj,
        }
    }
}

/// One of `P` for each way to move particles.
#[derive(Clone, Copy, Debug)]
pub struct ByMotion<P> {
    /// Newton's equations alone: without the code for random numbers, fewer registers do.
    pub newton: P,
    /// Any.
    pub any: P,
}

impl<P: Copy> ByMotion<P> {
    /// The fastest for an integrator.
    pub fn choose(&self, integrator: &Integrator) -> P {
        if integrator.langevin == 0 { self.newton } else { self.any }
    }
}

impl Law {
    /// Whether forces are those of one type of Lennard-Jones; an energy shift does not change them.
    pub fn is_plain_lennard_jones(&self) -> bool {
        self.potential == 0 && self.truncation != 2 && self.n_types == 1
    }
}
