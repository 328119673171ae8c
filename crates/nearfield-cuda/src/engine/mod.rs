//! The engine: a system on the device, its structure, and the loop of a step.

mod diagnose;
mod evaluate;
mod integrate;
mod list;
mod loaded;
pub(crate) mod motion;
mod order;
pub(crate) mod physics;
mod query;
mod results;
mod run;
pub(crate) mod state;
mod structure;
pub(crate) mod survey;
mod timeline;
mod totals;

use crate::{Buffer, CudaDevice, DeviceList, Gpu, Unavailable, Variant};
use loaded::Loaded;
use nearfield_core::{
    Dynamics, Engine, Error, ListRequest, NeighborList, Particles, PerParticle, Plan, Quantities, Radii, Report,
    Result, System, Totals, engine::MemoryOrder, maintenance::EnergyCounter,
};
use std::sync::Arc;

/// The engine that runs on a GPU.
pub struct CudaEngine {
    gpu: Arc<dyn Gpu>,
    loaded: Option<Box<Loaded>>,
    record_history: bool,
}

impl CudaEngine {
    /// On the GPU of this number.
    ///
    /// # Errors
    /// [`Unavailable`], which says what was looked for.
    pub fn new(ordinal: usize) -> std::result::Result<Self, Unavailable> {
        Ok(Self::on(Arc::new(CudaDevice::new(ordinal)?)))
    }

    /// On a device, or a stand-in for one.
    pub fn on(gpu: Arc<dyn Gpu>) -> Self {
        Self { gpu, loaded: None, record_history: false }
    }

    /// Neighbours of all particles at the present positions, by input index, left on the device. Images are kept where
    /// `request` asks for shifts or distances; rows are not sorted.
    ///
    /// # Errors
    /// As [`Engine::neighbor_list`].
    pub fn list_on_device(&mut self, request: ListRequest) -> Result<&DeviceList> {
        self.loaded()?.list_on_device(request)
    }

    /// Number of neighbours of each particle at the present positions, by input index, left on the device.
    ///
    /// # Errors
    /// As [`Engine::neighbor_list`].
    pub fn count_on_device(&mut self) -> Result<&Buffer<u32>> {
        self.loaded()?.count_on_device()
    }

    /// For each of other points, the particles within `radii` of it where they are now: a full list with a row per query, as
    /// the facade's `NeighborSearch::query` gives it. The radii of the particles mean nothing here.
    ///
    /// # Errors
    /// [`Error::NotLoaded`]; a coordinate that is not finite or outside walls, a radius that is not positive or beyond half
    /// a periodic length (named by the query's index); [`Error::OutOfMemory`], [`Error::Device`].
    pub fn query(
        &mut self,
        points: impl IntoIterator<Item = [f32; 3]>,
        radii: Radii,
        request: ListRequest,
    ) -> Result<NeighborList> {
        let loaded = self.loaded()?;
        let queries = loaded.queries(points, radii)?;
        loaded.list_queries(&queries, request)
    }

    /// The same, left on the device; images are kept where `request` asks for shifts or distances; rows are not sorted.
    ///
    /// # Errors
    /// As [`CudaEngine::query`].
    pub fn query_on_device(
        &mut self,
        points: impl IntoIterator<Item = [f32; 3]>,
        radii: Radii,
        request: ListRequest,
    ) -> Result<&DeviceList> {
        let loaded = self.loaded()?;
        let queries = loaded.queries(points, radii)?;
        loaded.list_queries_on_device(&queries, request.shifts || request.distances)
    }

    /// Number of particles within `radii` of each of other points, left on the device.
    ///
    /// # Errors
    /// As [`CudaEngine::query`].
    pub fn query_count_on_device(
        &mut self,
        points: impl IntoIterator<Item = [f32; 3]>,
        radii: Radii,
    ) -> Result<&Buffer<u32>> {
        let loaded = self.loaded()?;
        let queries = loaded.queries(points, radii)?;
        loaded.count_queries_on_device(&queries)
    }

    /// What `cluster` has chosen for the loaded system, once forces have been computed by it.
    pub fn cluster_variant(&self) -> Option<Variant> {
        self.loaded.as_ref()?.structure.cluster_variant()
    }

    /// Waits for the device.
    ///
    /// # Errors
    /// [`Error::Device`], of any work enqueued before.
    pub fn synchronize(&self) -> Result<()> {
        self.gpu.synchronize()
    }

    fn loaded(&mut self) -> Result<&mut Loaded> {
        self.loaded.as_deref_mut().ok_or(Error::NotLoaded)
    }
}

impl Engine for CudaEngine {
    fn device(&self) -> String {
        self.gpu.name()
    }

    fn supports(&self, system: &System, plan: &Plan) -> Result<()> {
        if !system.radii.is_uniform() && !plan.method.supports_variable_radii() {
            return Err(Error::Unsupported {
                method: plan.method,
                reason: "it needs one radius for all particles; use cell, rt-list or rt-forces",
            });
        }
        if plan.method.uses_bvh() && self.gpu.ray_tracing().is_err() {
            return Err(Error::Unsupported {
                method: plan.method,
                reason: "the driver offers no OptiX (see `nearfield devices`); use cell",
            });
        }
        Ok(())
    }

    fn load(&mut self, system: &System, plan: &Plan) -> Result<()> {
        self.supports(system, plan)?;
        // The old system goes first: both might not fit.
        self.loaded = None;
        let mut loaded = Loaded::new(&self.gpu, system, plan)?;
        loaded.record_history = self.record_history;
        self.loaded = Some(Box::new(loaded));
        Ok(())
    }

    fn evaluate(&mut self, quantities: Quantities) -> Result<Totals> {
        let loaded = self.loaded()?;
        loaded.forces_valid = false;
        loaded.evaluate(quantities, 0)?;
        loaded.forces_valid = true;
        loaded.totals(quantities, 0)
    }

    fn advance(&mut self, dynamics: &Dynamics, from: u64, steps: u64, quantities: Quantities) -> Result<Totals> {
        self.loaded()?.advance(dynamics, from, steps, quantities)
    }

    fn memory_order(&self) -> Result<MemoryOrder> {
        let Some(loaded) = &self.loaded else { return Ok(MemoryOrder::default()) };
        Ok(MemoryOrder { ids: loaded.state.id.download()?, sorted_at: loaded.sorted_at, ..MemoryOrder::default() })
    }

    fn set_memory_order(&mut self, order: &MemoryOrder) -> Result<()> {
        match self.loaded.as_deref_mut() {
            Some(loaded) if !order.ids.is_empty() => loaded.arrange(order),
            _ => Ok(()),
        }
    }

    fn snapshot(&mut self, particles: &mut Particles) -> Result<()> {
        self.loaded.as_ref().map_or(Ok(()), |loaded| loaded.state.copy_to(particles))
    }

    fn per_particle(&mut self, out: &mut PerParticle) -> Result<()> {
        self.loaded.as_ref().map_or(Ok(()), |loaded| loaded.results.copy_to(&loaded.state.id, out))
    }

    fn neighbor_list(&mut self, request: ListRequest) -> Result<NeighborList> {
        self.loaded()?.neighbor_list(request)
    }

    fn report(&self) -> Report {
        self.loaded.as_ref().map(|loaded| loaded.report()).unwrap_or_default()
    }

    fn record_history(&mut self, on: bool) {
        self.record_history = on;
        if let Some(loaded) = &mut self.loaded {
            loaded.record_history = on;
        }
    }

    fn attach_meter(&mut self, counter: Box<dyn EnergyCounter>) {
        if let Some(loaded) = &mut self.loaded {
            loaded.policy.attach(counter);
        }
    }
}
