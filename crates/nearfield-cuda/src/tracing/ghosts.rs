//! Mirror particles (tutorial C): particles whose box pokes over a periodic face appear once more on the other side.
//!
//! The set is frozen between builds, so it is drawn with a margin for motion, and a refit is refused once a particle
//! needs an image that it lacks. A particle within the margin of a face may also be wrapped to the other side, where it
//! needs the opposite images: those stand by from the start.

use super::Scene;
use crate::{Buffer, Gpu, gpu::launch};
use nearfield_core::Result;
use nearfield_kernels::{
    Ptr, kernels,
    layouts::{BoxesArgs, Ghost},
};
use std::sync::Arc;

/// How far particles may move before ghosts run out, in mean radii. Wider margins mean fewer builds and more boxes.
const MARGIN: f32 = 0.2;

/// The mirror particles of the last build.
pub(super) struct Ghosts {
    gpu: Arc<dyn Gpu>,
    list: Buffer<Ghost>,
    faces: Buffer<u8>,
    counter: Buffer<u32>,
}

impl Ghosts {
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self {
            gpu: gpu.clone(),
            list: Buffer::new(gpu, "ghosts"),
            faces: Buffer::new(gpu, "faces near particles"),
            counter: Buffer::new(gpu, "the number of ghosts"),
        }
    }

    /// Draws the set for the present positions; waits for the device to know its size.
    pub fn create(&mut self, scene: &Scene, boxes: &BoxesArgs) -> Result<()> {
        let n = u64::from(scene.particles.n);
        self.faces.resize(n as usize)?;
        self.counter.resize(1)?;
        self.counter.zero()?;
        let arguments = BoxesArgs { margin: MARGIN * scene.mean, ..self.arguments(boxes) };
        // SAFETY: positions and faces have n elements.
        unsafe { launch(&*self.gpu, kernels::COUNT_GHOSTS, n, &arguments)? };
        let count = self.counter.download()?[0];
        self.list.resize_with_room(count as usize)?;
        self.counter.zero()?;
        // SAFETY: the list has room for as many ghosts as were counted.
        unsafe { launch(&*self.gpu, kernels::MAKE_GHOSTS, n, &BoxesArgs { ghost: self.list.ptr(), ..arguments }) }
    }

    /// With the ghosts in use.
    pub fn arguments(&self, boxes: &BoxesArgs) -> BoxesArgs {
        BoxesArgs {
            ghost: self.list.ptr(),
            n_ghosts: self.list.len() as u32,
            faces: self.faces.ptr(),
            counter: self.counter.ptr(),
            ..*boxes
        }
    }

    /// Makes ready for boxes to be fitted.
    pub fn watch(&mut self) -> Result<()> {
        self.counter.zero()
    }

    /// Whether no particle has been found to need a ghost that it lacks; waits for the device.
    pub fn suffice(&self) -> Result<bool> {
        Ok(self.counter.download()?[0] == 0)
    }

    pub fn list(&self) -> Ptr<Ghost> {
        self.list.ptr()
    }

    pub fn bytes(&self) -> u64 {
        self.list.bytes() + self.faces.bytes() + self.counter.bytes()
    }
}
