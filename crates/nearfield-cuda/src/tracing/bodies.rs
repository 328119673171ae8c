//! Bodies around particles and ghosts, in the buffers that structures are built from.

use super::{Probe, Scene};
use crate::{
    Buffer, Gpu,
    gpu::{self, Aabb, Triangle, launch},
};
use nearfield_core::Result;
use nearfield_kernels::{
    Float4, Kernel, Layout, Ptr, kernels,
    layouts::{BodiesArgs, BoxesArgs},
};
use std::sync::Arc;

/// Bodies of one kind.
pub(super) enum Bodies {
    /// One each.
    Boxes(Buffer<Aabb>),
    /// One each.
    Spheres { center: Buffer<Float4>, radius: Buffer<f32>, uploaded: f32 },
    /// [`kernels::TRIANGLES_PER_PARTICLE`] each.
    Squares(Buffer<Triangle>),
}

impl Bodies {
    pub fn new(gpu: &Arc<dyn Gpu>, probe: Probe) -> Self {
        match probe {
            Probe::Point => Self::Boxes(Buffer::new(gpu, "boxes around particles")),
            Probe::Axes => Self::Spheres {
                center: Buffer::new(gpu, "centres of spheres around particles"),
                radius: Buffer::new(gpu, "the radius of spheres around particles"),
                uploaded: f32::NAN,
            },
            Probe::Edges => Self::Squares(Buffer::new(gpu, "triangles around particles")),
        }
    }

    /// Fits them to the particles and ghosts of `arguments`, and gives them and their number.
    pub fn fit(&mut self, scene: &Scene, probe: Probe, arguments: &BoxesArgs) -> Result<(gpu::Bodies, u32)> {
        let n = arguments.n as usize + arguments.n_ghosts as usize;
        let (arguments, mut body) = (
            *arguments,
            BodiesArgs { geometry: probe.geometry(scene.reach(), scene.sim_box), ..BodiesArgs::default() },
        );
        match self {
            Self::Boxes(boxes) => {
                resize(boxes, n, &arguments)?;
                let arguments = BoxesArgs { boxes: Ptr::new(boxes.ptr().address()), ..arguments };
                // SAFETY: there is a box for each particle and ghost, and a position for each particle.
                unsafe { launch(&**scene.gpu, kernels::FIT_BOXES, n as u64, &arguments)? };
                Ok((gpu::Bodies::Boxes(boxes.ptr()), n as u32))
            }
            Self::Spheres { center, radius, uploaded } => {
                resize(center, n, &arguments)?;
                if *uploaded != body.geometry.body {
                    *uploaded = body.geometry.body;
                    radius.upload(&[*uploaded])?;
                }
                body.centers = center.ptr();
                fit(scene, kernels::FIT_SPHERES, n, BodiesArgs { boxes: arguments, ..body })?;
                Ok((gpu::Bodies::Spheres { center: center.ptr(), radius: radius.ptr() }, n as u32))
            }
            Self::Squares(triangles) => {
                let count = n * kernels::TRIANGLES_PER_PARTICLE as usize;
                resize(triangles, count, &arguments)?;
                body.vertices = Ptr::new(triangles.ptr().address());
                fit(scene, kernels::FIT_SQUARES, n, BodiesArgs { boxes: arguments, ..body })?;
                Ok((gpu::Bodies::Triangles(triangles.ptr()), count as u32))
            }
        }
    }

    pub fn bytes(&self) -> u64 {
        match self {
            Self::Boxes(boxes) => boxes.bytes(),
            Self::Spheres { center, radius, .. } => center.bytes() + radius.bytes(),
            Self::Squares(triangles) => triangles.bytes(),
        }
    }
}

/// The number of ghosts changes from build to build.
fn resize<T: Layout>(buffer: &mut Buffer<T>, n: usize, arguments: &BoxesArgs) -> Result<()> {
    if arguments.ghost.address() == 0 { buffer.resize(n) } else { buffer.resize_with_room(n) }
}

fn fit(scene: &Scene, kernel: Kernel<BodiesArgs>, n: usize, arguments: BodiesArgs) -> Result<()> {
    // SAFETY: there are bodies for each particle and ghost, and a position for each particle.
    unsafe { launch(&**scene.gpu, kernel, n as u64, &arguments) }
}
