//! Forces and energies of the last evaluation, in memory order.

use crate::{Buffer, Gpu, gpu::launch};
use nearfield_core::{PerParticle, Result};
use nearfield_kernels::{
    Float4, Ptr, kernels,
    layouts::{self, FinishExactArgs, Law},
};
use std::sync::Arc;

/// Per-particle results; all but forces only when energies were asked for.
pub(crate) struct Results {
    pub force: Buffer<Float4>,
    energy: Buffer<f64>,
    virial: Buffer<f64>,
    neighbors: Buffer<u32>,
    /// Order-independent sums of scattering methods, `[3 or 5][n]`.
    exact: Buffer<i64>,
}

impl Results {
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self {
            force: Buffer::new(gpu, "forces"),
            energy: Buffer::new(gpu, "energies"),
            virial: Buffer::new(gpu, "virials"),
            neighbors: Buffer::new(gpu, "neighbour counts"),
            exact: Buffer::new(gpu, "order-independent sums"),
        }
    }

    /// Makes room for `n` particles.
    pub fn prepare(&mut self, n: usize, energy: bool) -> Result<()> {
        self.force.resize(n)?;
        let with_energies = if energy { n } else { 0 };
        self.energy.resize(with_energies)?;
        self.virial.resize(with_energies)?;
        self.neighbors.resize(with_energies)
    }

    /// Zeroes everything that scattering adds to; sums that do not depend on order go to arrays of their own.
    pub fn zero(&mut self, exact: bool) -> Result<()> {
        let sums = if self.energy.is_empty() { 3 } else { 5 };
        self.exact.resize(if exact { sums * self.force.len() } else { 0 })?;
        self.exact.zero()?;
        self.force.zero()?;
        self.energy.zero()?;
        self.virial.zero()?;
        self.neighbors.zero()
    }

    /// Turns order-independent sums of scattering methods into numbers.
    pub fn finish_exact(&mut self, gpu: &dyn Gpu, law: &Law) -> Result<()> {
        let n = self.force.len();
        let arguments = FinishExactArgs {
            results: self.layout(),
            force_quanta: law.force_quanta,
            energy_quanta: law.energy_quanta,
            n: n as u32,
            energy: u32::from(!self.energy.is_empty()),
            capped: u32::from(law.cap.is_finite()),
            unused: 0,
        };
        // SAFETY: `exact` holds as many sums of n particles as `zero` made room for.
        unsafe { launch(gpu, kernels::FINISH_EXACT, n as u64, &arguments) }
    }

    /// Addresses for kernels.
    pub fn layout(&self) -> layouts::Results {
        layouts::Results {
            force: self.force.ptr(),
            energy: self.energy.ptr(),
            virial: self.virial.ptr(),
            neighbors: self.neighbors.ptr(),
            exact: self.exact.ptr(),
        }
    }

    /// Addresses for totals without energies: those of an earlier evaluation do not count.
    pub fn forces_only(&self) -> layouts::Results {
        layouts::Results { energy: Ptr::NULL, virial: Ptr::NULL, neighbors: Ptr::NULL, ..self.layout() }
    }

    /// Copies forces, energies and neighbour counts to the host in input order.
    pub fn copy_to(&self, id: &Buffer<u32>, out: &mut PerParticle) -> Result<()> {
        let force = self.force.download()?;
        let (energy, neighbors) = (self.energy.download()?, self.neighbors.download()?);
        out.force.resize(force.len());
        out.energy.resize(energy.len(), 0.0);
        out.neighbors.resize(neighbors.len(), 0);
        for (i, &id) in id.download()?.iter().enumerate().take(force.len()) {
            let id = id as usize;
            out.force.set(id, [force[i].x, force[i].y, force[i].z]);
            if !energy.is_empty() {
                out.energy[id] = energy[i];
                out.neighbors[id] = neighbors[i];
            }
        }
        Ok(())
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.force.bytes() + self.energy.bytes() + self.virial.bytes() + self.neighbors.bytes() + self.exact.bytes()
    }
}
