//! Acceleration structures and what rays find in them.

use crate::{
    emulator::{Shared, State},
    launch::Scene,
    memory::Heap,
    tree::{Point, Tree, Visit},
};
use nearfield_core::{Error, Result};
use nearfield_cuda::gpu::{Aabb, AccelerationStructure};
use nearfield_kernels::Ptr;
use std::{collections::HashMap, ffi::CStr, slice, sync::Arc};

/// Bytes that a structure takes for a box or an instance; hierarchies of GPUs take about as much.
const BYTES_EACH: u64 = 64;

/// All structures of a device that have been built, by handle.
#[derive(Default)]
pub struct Structures {
    built: HashMap<u64, Structure>,
    /// Builds so far.
    builds: u64,
}

enum Structure {
    Boxes {
        tree: Tree,
        /// Counts the refits.
        version: u64,
    },
    Instances {
        of: u64,
        /// Of the instanced structure at the build.
        version: u64,
        translations: Vec<Point>,
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

impl Scene for Structures {
    fn traverse(&self, handle: u64, point: Point, visit: Visit) -> std::result::Result<(), &'static CStr> {
        // SAFETY: the programs behind `visit` are called by the launch that traverses.
        let found = |primitive, instance| unsafe { visit(primitive, instance) };
        match self.built.get(&handle).ok_or(c"no acceleration structure has the handle it traces against")? {
            Structure::Boxes { tree, .. } => tree.boxes_around(point, |primitive| found(primitive, 0)),
            Structure::Instances { of, version, translations } => {
                let Some(Structure::Boxes { tree, version: present }) = self.built.get(of) else {
                    return Err(c"the structure behind its instances was rebuilt or dropped since they were built");
                };
                if version != present {
                    return Err(c"the structure behind its instances was refitted since they were built");
                }
                for (instance, translation) in (0..).zip(translations) {
                    let local = [0, 1, 2].map(|axis| point[axis] - translation[axis]);
                    tree.boxes_around(local, |primitive| found(primitive, instance));
                }
            }
        }
        Ok(())
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

    /// Drops what is there and makes room for `n` boxes or instances.
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
    unsafe fn build_boxes(&mut self, boxes: Ptr<Aabb>, n: u32) -> Result<()> {
        let shared = self.shared.clone();
        let mut state = shared.lock();
        self.clear(&mut state, n as usize)?;
        let tree = Tree::new(read(&state.heap, "build", boxes, n)?);
        self.handle = state.structures.insert(Structure::Boxes { tree, version: 0 });
        Ok(())
    }

    unsafe fn refit_boxes(&mut self, boxes: Ptr<Aabb>, n: u32) -> Result<()> {
        let mut guard = self.shared.lock();
        let state = &mut *guard;
        let boxes = read(&state.heap, "refit", boxes, n)?;
        match state.structures.built.get_mut(&self.handle) {
            Some(Structure::Boxes { tree, version }) if tree.len() == boxes.len() => {
                tree.refit(boxes);
                *version += 1;
                Ok(())
            }
            Some(Structure::Boxes { tree, .. }) => {
                Err(Error::Device(format!("refit of {} boxes to a structure of {}", n, tree.len())))
            }
            Some(Structure::Instances { .. }) => {
                Err(Error::Device("refit of boxes to a structure of instances".into()))
            }
            None => Err(Error::Device("refit of a structure that was not built".into())),
        }
    }

    fn build_instances(&mut self, of: &dyn AccelerationStructure, translations: &[[f32; 3]]) -> Result<()> {
        let of = of.handle();
        let shared = self.shared.clone();
        let mut state = shared.lock();
        let Some(&Structure::Boxes { version, .. }) = state.structures.built.get(&of) else {
            return Err(Error::Device("instances of a structure that was not built over boxes".into()));
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

/// The boxes in device memory.
fn read<'a>(heap: &'a Heap, action: &str, boxes: Ptr<Aabb>, n: u32) -> Result<&'a [Aabb]> {
    if n == 0 {
        return Ok(&[]);
    }
    if !boxes.address().is_multiple_of(8) {
        return Err(Error::Device(format!("{action}: boxes at {boxes:?} are not aligned to 8 bytes")));
    }
    let start = heap.range(action, boxes.address(), n as usize * size_of::<Aabb>())?;
    // SAFETY: the range is within a buffer, aligned, and not written while the state is locked.
    Ok(unsafe { slice::from_raw_parts(start.cast().as_ptr(), n as usize) })
}
