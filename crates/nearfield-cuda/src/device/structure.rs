//! Acceleration structures of OptiX in buffers that are kept and grown.

use super::{CudaDevice, optix::failed};
use crate::{
    Buffer, Gpu,
    gpu::{Aabb, AccelerationStructure, Bodies, Preference},
};
use nearfield_core::Result;
use nearfield_kernels::Float4;
use optix_driver::{
    Aabbs, AccelOptions, AnyHit, BuildInput, DeviceContext, DeviceSpan, Instance, Instances, SphereRadii, Spheres,
    TraversableHandle, Triangles,
};
use std::sync::Arc;

/// Structures are refitted between builds. Those over spheres have the options that their built-in program was made for.
pub(super) const OPTIONS: AccelOptions =
    AccelOptions { allow_update: true, allow_compaction: false, preference: optix_driver::Preference::FastTrace };

fn options(bodies: &Bodies, preference: Preference) -> AccelOptions {
    match (bodies, preference) {
        (Bodies::Boxes(_) | Bodies::Triangles(_), Preference::Builds) => {
            AccelOptions { preference: optix_driver::Preference::FastBuild, ..OPTIONS }
        }
        _ => OPTIONS,
    }
}

/// A structure over bodies or instances.
pub(super) struct OptixStructure {
    context: Arc<DeviceContext>,
    device: Arc<CudaDevice>,
    handle: u64,
    /// Of the last build, and so of refits.
    options: AccelOptions,
    output: Buffer<u8>,
    scratch: Buffer<u8>,
    /// Records of the instances, where it is over instances, on the host and on the device.
    instances: Vec<Instance>,
    records: Buffer<u8>,
}

impl OptixStructure {
    pub fn new(context: &Arc<DeviceContext>, device: &Arc<CudaDevice>) -> Self {
        let gpu: Arc<dyn Gpu> = device.clone();
        Self {
            context: context.clone(),
            device: device.clone(),
            handle: 0,
            options: OPTIONS,
            output: Buffer::new(&gpu, "an acceleration structure"),
            scratch: Buffer::new(&gpu, "scratch of an acceleration structure"),
            instances: Vec::new(),
            records: Buffer::new(&gpu, "instances of an acceleration structure"),
        }
    }

    /// # Safety
    /// What `input` points to is valid until the work is done.
    unsafe fn build_input(&mut self, input: BuildInput) -> Result<()> {
        let stream = self.device.bind()?;
        let building = |error| failed("building an acceleration structure", error);
        let sizes = self.context.accel_sizes(self.options, &[input]).map_err(building)?;
        self.output.resize(sizes.output)?;
        self.scratch.resize(sizes.temp.max(sizes.temp_update))?;
        let (scratch, output) = (span(&self.scratch), span(&self.output));
        // SAFETY: the buffers are as large as was asked for, aligned to 256 bytes and kept while the handle is; the
        // caller vouches for the input; the stream is the device's and captures nothing.
        let handle = unsafe { self.context.accel_build(stream.cast(), self.options, &[input], scratch, output, None) };
        self.handle = handle.map_err(building)?.0;
        Ok(())
    }

    /// # Safety
    /// As [`OptixStructure::build_input`]; the last build had an input of this kind and size.
    unsafe fn update_input(&mut self, input: BuildInput) -> Result<()> {
        let stream = self.device.bind()?;
        let (scratch, output) = (span(&self.scratch), span(&self.output));
        // SAFETY: as in `build_input`, which made room for updates too.
        let handle = unsafe { self.context.accel_update(stream.cast(), self.options, &[input], scratch, output) };
        self.handle = handle.map_err(|error| failed("refitting an acceleration structure", error))?.0;
        Ok(())
    }
}

impl AccelerationStructure for OptixStructure {
    unsafe fn build(&mut self, bodies: Bodies, n: u32, preference: Preference) -> Result<()> {
        self.options = options(&bodies, preference);
        // SAFETY: the caller vouches for the bodies.
        unsafe { self.build_input(input(bodies, n)) }
    }

    unsafe fn refit(&mut self, bodies: Bodies, n: u32) -> Result<()> {
        // SAFETY: the caller vouches for the bodies, their kind and number.
        unsafe { self.update_input(input(bodies, n)) }
    }

    fn build_instances(&mut self, of: &dyn AccelerationStructure, translations: &[[f32; 3]]) -> Result<()> {
        let of = TraversableHandle(of.handle());
        let instances: Vec<_> =
            (0..).zip(translations).map(|(id, &shift)| Instance::translated(of, id, shift)).collect();
        let unchanged = instances == self.instances && self.handle != 0;
        if !unchanged {
            self.records.upload(Instance::bytes(&instances))?;
            self.instances = instances;
        }
        let count = self.instances.len() as u32;
        let input = BuildInput::Instances(Instances { buffer: self.records.ptr().address(), count });
        // SAFETY: the records are this structure's own; their number is that of the last build where they are the same.
        unsafe { if unchanged { self.update_input(input) } else { self.build_input(input) } }
    }

    fn handle(&self) -> u64 {
        self.handle
    }

    fn bytes(&self) -> u64 {
        self.output.bytes() + self.scratch.bytes() + self.records.bytes()
    }
}

impl Drop for OptixStructure {
    fn drop(&mut self) {
        // As for the context, whose last owner this may be.
        let _ = self.device.bind();
    }
}

/// The driver's description of bodies. Programs of built-in ones must run once for each: they count what they see.
fn input(bodies: Bodies, n: u32) -> BuildInput {
    let any_hit = AnyHit::OncePerPrimitive;
    match bodies {
        Bodies::Boxes(boxes) => BuildInput::Aabbs(Aabbs {
            buffer: boxes.address(),
            count: n,
            stride: size_of::<Aabb>() as u32,
            any_hit: AnyHit::Never,
        }),
        Bodies::Spheres { center, radius } => BuildInput::Spheres(Spheres {
            centers: center.address(),
            count: n,
            stride: size_of::<Float4>() as u32,
            radii: SphereRadii::Single { buffer: radius.address() },
            any_hit,
        }),
        Bodies::Triangles(triangles) => BuildInput::Triangles(Triangles {
            vertices: triangles.address(),
            num_vertices: 3 * n,
            vertex_stride: size_of::<[f32; 3]>() as u32,
            indices: None,
            any_hit,
        }),
    }
}

fn span(buffer: &Buffer<u8>) -> DeviceSpan {
    DeviceSpan { address: buffer.ptr().address(), bytes: buffer.len() }
}
