//! Acceleration structures and what rays find in them.

use crate::{
    emulator::{Shared, State},
    launch::{Scene, Segment, Visit},
    memory::Heap,
    primitives::{Primitives, Shapes},
};
use nearfield_core::{Error, Result};
use nearfield_cuda::gpu::{AccelerationStructure, Bodies, Preference};
use nearfield_kernels::{Primitive, Ptr};
use std::{collections::HashMap, ffi::CStr, slice, sync::Arc};

/// Bytes that a structure takes for a primitive or an instance; hierarchies of GPUs take about as much.
const BYTES_EACH: u64 = 64;

/// All structures of a device that have been built, by handle.
#[derive(Default)]
pub struct Structures {
    built: HashMap<u64, Structure>,
    /// Builds so far.
    builds: u64,
}

enum Structure {
    Bodies {
        primitives: Primitives,
        /// Counts the refits.
        version: u64,
    },
    Instances {
        of: u64,
        /// Of the instanced structure at the build.
        version: u64,
        translations: Vec<[f32; 3]>,
    },
}

impl Structures {
    /// Handles are never used twice, so that one kept over a rebuild is found.
    fn insert(&mut self, structure: Structure) -> u64 {
        self.builds += 1;
        let handle = self.builds << 8;
        self.built.insert(handle, structure);
        handle
    }
}

/// The structures as a program sees them that is for primitives of one kind.
pub struct Seen<'a> {
    pub structures: &'a Structures,
    pub by: Primitive,
}

impl Scene for Seen<'_> {
    fn traverse(&self, handle: u64, ray: &Segment, visit: Visit) -> std::result::Result<(), &'static CStr> {
        // SAFETY: the programs behind `visit` are called by the launch that traverses.
        let found = |primitive, instance, distance| unsafe { visit(primitive, instance, distance) };
        let built = &self.structures.built;
        let meet = |primitives: &Primitives, ray: &Segment, instance: u32| {
            if !primitives.are(self.by) {
                return Err(c"the program is for primitives of another kind than the structure holds");
            }
            primitives.meet(ray, |primitive, distance| found(primitive, instance, distance));
            Ok(())
        };
        match built.get(&handle).ok_or(c"no acceleration structure has the handle it traces against")? {
            Structure::Bodies { primitives, .. } => meet(primitives, ray, 0),
            Structure::Instances { of, version, translations } => {
                let Some(Structure::Bodies { primitives, version: present }) = built.get(of) else {
                    return Err(c"the structure behind its instances was rebuilt or dropped since they were built");
                };
                if version != present {
                    return Err(c"the structure behind its instances was refitted since they were built");
                }
                for (instance, translation) in (0..).zip(translations) {
                    let origin = [0, 1, 2].map(|axis| ray.origin[axis] - translation[axis]);
                    meet(primitives, &Segment { origin, ..*ray }, instance)?;
                }
                Ok(())
            }
        }
    }
}

/// A structure, built or not.
pub struct Acceleration {
    shared: Arc<Shared>,
    handle: u64,
    bytes: u64,
}

impl Acceleration {
    /// An empty one.
    pub fn new(shared: Arc<Shared>) -> Self {
        Self { shared, handle: 0, bytes: 0 }
    }

    /// Drops what is there and makes room for `n` primitives or instances.
    fn clear(&mut self, state: &mut State, n: usize) -> Result<()> {
        state.structures.built.remove(&self.handle);
        state.heap.unreserve(self.bytes);
        (self.handle, self.bytes) = (0, 0);
        let bytes = BYTES_EACH * n as u64;
        state.heap.reserve("acceleration structure", bytes)?;
        self.bytes = bytes;
        Ok(())
    }
}

impl AccelerationStructure for Acceleration {
    unsafe fn build(&mut self, bodies: Bodies, n: u32, _: Preference) -> Result<()> {
        let shared = self.shared.clone();
        let mut state = shared.lock();
        self.clear(&mut state, n as usize)?;
        let primitives = Primitives::new(shapes(&state.heap, "build", bodies, n)?);
        self.handle = state.structures.insert(Structure::Bodies { primitives, version: 0 });
        Ok(())
    }

    unsafe fn refit(&mut self, bodies: Bodies, n: u32) -> Result<()> {
        let mut guard = self.shared.lock();
        let state = &mut *guard;
        let shapes = shapes(&state.heap, "refit", bodies, n)?;
        match state.structures.built.get_mut(&self.handle) {
            Some(Structure::Bodies { primitives, version }) => {
                let built = primitives.shapes();
                if (built.len(), built.name()) != (shapes.len(), shapes.name()) {
                    let (kind, before) = (shapes.name(), format!("{} {}", built.len(), built.name()));
                    return Err(Error::Device(format!("refit of {n} {kind} to a structure of {before}")));
                }
                primitives.refit(shapes);
                *version += 1;
                Ok(())
            }
            Some(Structure::Instances { .. }) => Err(Error::Device("refit of a structure of instances".into())),
            None => Err(Error::Device("refit of a structure that was not built".into())),
        }
    }

    fn build_instances(&mut self, of: &dyn AccelerationStructure, translations: &[[f32; 3]]) -> Result<()> {
        let of = of.handle();
        let shared = self.shared.clone();
        let mut state = shared.lock();
        let Some(&Structure::Bodies { version, .. }) = state.structures.built.get(&of) else {
            return Err(Error::Device("instances of a structure that was not built over primitives".into()));
        };
        self.clear(&mut state, translations.len())?;
        let instances = Structure::Instances { of, version, translations: translations.to_vec() };
        self.handle = state.structures.insert(instances);
        Ok(())
    }

    fn handle(&self) -> u64 {
        self.handle
    }

    fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl Drop for Acceleration {
    fn drop(&mut self) {
        let mut state = self.shared.lock();
        state.structures.built.remove(&self.handle);
        state.heap.unreserve(self.bytes);
    }
}

/// The primitives in device memory.
fn shapes(heap: &Heap, action: &str, bodies: Bodies, n: u32) -> Result<Shapes> {
    Ok(match bodies {
        Bodies::Boxes(boxes) => Shapes::Boxes(read(heap, action, boxes, n, 8)?.to_vec()),
        Bodies::Spheres { center, radius } => Shapes::Spheres {
            centers: read(heap, action, center, n, 16)?.iter().map(|c| [c.x, c.y, c.z]).collect(),
            radius: read(heap, action, radius, 1, 4)?[0],
        },
        Bodies::Triangles(triangles) => Shapes::Triangles(read(heap, action, triangles, n, 4)?.to_vec()),
    })
}

/// An array in device memory.
fn read<'a, T>(heap: &'a Heap, action: &str, array: Ptr<T>, n: u32, alignment: u64) -> Result<&'a [T]> {
    if n == 0 {
        return Ok(&[]);
    }
    if !array.address().is_multiple_of(alignment) {
        return Err(Error::Device(format!("{action}: bodies at {array:?} are not aligned to {alignment} bytes")));
    }
    let start = heap.range(action, array.address(), n as usize * size_of::<T>())?;
    // SAFETY: the range is within a buffer, aligned, holds plain numbers and is not written while the state is locked.
    Ok(unsafe { slice::from_raw_parts(start.cast().as_ptr(), n as usize) })
}
