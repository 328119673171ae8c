//! The acceleration structure over all particles, with what it takes to see periodic images.

use super::{Probe, Scene, Updated, bodies::Bodies, ghosts::Ghosts, view};
use crate::{
    Gpu,
    gpu::{self, AccelerationStructure, Preference, RayTracing},
};
use nearfield_core::{Error, Images, Result, maintenance::Action};
use nearfield_kernels::{
    Ptr,
    layouts::{BoxesArgs, Rays},
};
use std::{f64::consts::PI, sync::Arc};

/// Bodies around particles, built or refitted.
pub struct Bvh {
    probe: Probe,
    images: Images,
    bodies: Bodies,
    structure: Box<dyn AccelerationStructure>,
    /// Translated copies of the structure, under [`Images::Instances`].
    instances: Option<Box<dyn AccelerationStructure>>,
    /// Under [`Images::Ghosts`].
    ghosts: Option<Ghosts>,
    /// Number of particles at the last build; none before the first.
    n: Option<u32>,
}

impl Bvh {
    /// Over nothing, asked by `probe`, seeing periodic images by `images`.
    ///
    /// # Errors
    /// [`Error::Device`] where there is no ray tracing.
    pub fn new(gpu: &Arc<dyn Gpu>, probe: Probe, images: Images) -> Result<Self> {
        let tracing = tracing(gpu)?;
        Ok(Self {
            probe,
            images,
            bodies: Bodies::new(gpu, probe),
            structure: tracing.structure()?,
            instances: (images == Images::Instances).then(|| tracing.structure()).transpose()?,
            ghosts: (images == Images::Ghosts).then(|| Ghosts::new(gpu)),
            n: None,
        })
    }

    /// Builds or refits. A refit that would miss pairs, because ghosts were outrun, is a build.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::Device`].
    pub fn update(&mut self, action: Action, scene: &Scene) -> Result<Updated> {
        if action == Action::Refit && self.n == Some(scene.particles.n) && self.refit(scene)? {
            return Ok(Updated { built: false, forced: false });
        }
        self.build(scene)?;
        Ok(Updated { built: true, forced: action == Action::Refit })
    }

    fn build(&mut self, scene: &Scene) -> Result<()> {
        self.n = Some(scene.particles.n);
        if scene.particles.n == 0 {
            return Ok(());
        }
        if let Some(ghosts) = &mut self.ghosts {
            ghosts.create(scene, &arguments(scene))?;
        }
        let (bodies, n) = self.fit(scene)?;
        // SAFETY: there are as many bodies as were fitted.
        unsafe { self.structure.build(bodies, n, preference(scene))? };
        self.place_instances(scene)
    }

    /// Whether the old structure could follow the particles.
    fn refit(&mut self, scene: &Scene) -> Result<bool> {
        if scene.particles.n == 0 {
            return Ok(true);
        }
        let (bodies, n) = self.fit(scene)?;
        if let Some(ghosts) = &self.ghosts
            && !ghosts.suffice()?
        {
            return Ok(false);
        }
        // SAFETY: there are as many bodies as were fitted, for the particles and ghosts of the last build.
        unsafe { self.structure.refit(bodies, n)? };
        self.place_instances(scene)?;
        Ok(true)
    }

    /// Fits bodies to the present positions and gives them and their number.
    fn fit(&mut self, scene: &Scene) -> Result<(gpu::Bodies, u32)> {
        let mut arguments = arguments(scene);
        if let Some(ghosts) = &mut self.ghosts {
            ghosts.watch()?;
            arguments = ghosts.arguments(&arguments);
        }
        self.bodies.fit(scene, self.probe, &arguments)
    }

    fn place_instances(&mut self, scene: &Scene) -> Result<()> {
        let Some(instances) = &mut self.instances else { return Ok(()) };
        let translations: Vec<_> = scene.sim_box.images().into_iter().map(|image| scene.sim_box.shift(image)).collect();
        instances.build_instances(&*self.structure, &translations)
    }

    /// How it is asked.
    pub(super) fn probe(&self) -> Probe {
        self.probe
    }

    /// What rays of all particles need to know.
    pub(super) fn rays(&self, scene: &Scene) -> Rays {
        let (near_lo, near_hi) = view::near_faces(scene);
        let (image, n_images) = view::codes(scene.sim_box);
        Rays {
            law: scene.law,
            space: scene.space,
            particles: scene.particles,
            geometry: self.probe.geometry(scene.reach(), scene.sim_box),
            handle: self.instances.as_ref().unwrap_or(&self.structure).handle(),
            ghost: self.ghosts.as_ref().map_or(Ptr::NULL, Ghosts::list),
            view: view::number(self.images),
            n_images,
            image,
            near_lo,
            near_hi,
            skin: scene.skin,
            first: 0,
        }
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.bodies.bytes()
            + self.structure.bytes()
            + self.instances.as_ref().map_or(0, |instances| instances.bytes())
            + self.ghosts.as_ref().map_or(0, Ghosts::bytes)
    }
}

pub(super) fn tracing(gpu: &Arc<dyn Gpu>) -> Result<&dyn RayTracing> {
    gpu.ray_tracing().map_err(Error::Device)
}

/// Neighbours above which tracing takes longer than building and refitting. Building fast instead of well halves the time
/// of a build and takes a fifth off a refit, and makes rays 0 to 8 % slower (an H200, 10⁶ particles).
const MANY_NEIGHBORS: f64 = 20.0;

/// By the neighbours that particles would have if they were spread evenly.
fn preference(scene: &Scene) -> Preference {
    let ball = 4.0 / 3.0 * PI * f64::from(scene.reach()).powi(3);
    let neighbors = f64::from(scene.particles.n) * ball / scene.sim_box.volume();
    if scene.law.variable == 0 && neighbors < MANY_NEIGHBORS { Preference::Builds } else { Preference::Traces }
}

/// Of the kernels that fit bodies, without ghosts.
fn arguments(scene: &Scene) -> BoxesArgs {
    BoxesArgs {
        space: scene.space,
        position: scene.particles.position,
        n: scene.particles.n,
        cutoff: if scene.law.variable == 0 { scene.law.cutoff } else { 0.0 },
        skin: scene.skin,
        slack: view::rounding(scene),
        ..BoxesArgs::default()
    }
}
