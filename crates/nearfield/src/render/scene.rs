//! Everything that is in a picture, in its place and colour.

use super::{
    ColorBy, Focus, Options,
    camera::Camera,
    color::{self, light},
    light::Lights,
    lines::{self, Line},
    shapes::{Shape, Shapes},
    spheres::Spheres,
};
use glam::Vec3;
use nearfield_core::{Radii, System, Vec3s};
use nearfield_cpu::Ray;

/// Colours of the particle in focus and its rays, of its neighbours, of a neighbour that is near through a periodic
/// face only, where it really is, and of all others.
pub(super) const FOCUS: color::Rgb = [0xe0, 0x5a, 0x10];
pub(super) const NEIGHBOR: color::Rgb = [0x2f, 0x8f, 0xd0];
pub(super) const NEIGHBOR_HOME: color::Rgb = [0xa9, 0xd2, 0xee];
pub(super) const OTHER: color::Rgb = [0xd2, 0xd2, 0xd2];
/// Edges of the box.
const BOX: color::Rgb = [0x80, 0x88, 0x90];
/// Radii beside that of the particle in focus: smaller ones leave it in sight.
const NEIGHBOR_SIZE: f32 = 0.5;
const OTHER_SIZE: f32 = 0.35;
/// Size of particles inside their shapes, which would hide much else at full size.
const INNER_SIZE: f32 = 0.5;
/// Thickness of the box's edges, of rays and of lines to neighbours, and width of the frames of panes, in pixels of a
/// picture 1000 high.
const BOX_WIDTH: f32 = 1.6;
const RAY_WIDTH: f32 = 4.5;
const BOND_WIDTH: f32 = 2.5;
const FRAME_WIDTH: f32 = 2.6;

/// What is in a picture.
pub(super) struct Scene {
    spheres: Spheres,
    shapes: Option<Shapes>,
    lines: Vec<Line>,
    lights: Lights,
}

/// What a scene is made with, the same for all frames.
pub(super) struct Fixed<'a> {
    pub options: &'a Options,
    pub camera: &'a Camera,
    /// Radius of particles, \[length\].
    pub radius: f32,
    /// The range of numbers that colours span.
    pub range: [f64; 2],
}

/// Spheres and shapes before they are indexed.
#[derive(Default)]
struct Parts {
    center: Vec3s,
    radius: Vec<f32>,
    color: Vec<Vec3>,
    shape_center: Vec3s,
    shape_cutoff: Vec<f32>,
    shape_color: Vec<Vec3>,
    rays: Vec<[Vec3; 2]>,
    bonds: Vec<[Vec3; 2]>,
}

impl Scene {
    /// The scene of a system, of which `values` are the numbers that it is coloured by.
    pub fn new(system: &System, values: Option<&[f64]>, focus: Option<&Focus>, fixed: &Fixed) -> Self {
        let Fixed { options, camera, .. } = fixed;
        let parts = match focus {
            Some(focus) => focused(system, focus, fixed),
            None => whole(system, values, fixed),
        };
        let width = |pixels: f32| pixels * camera.pixel * options.view.size[1] as f32 / 1000.0;
        let line = |color, thickness| move |ends| Line { ends, radius: 0.5 * width(thickness), color: light(color) };
        let mut lines: Vec<Line> = parts.rays.into_iter().map(line(FOCUS, RAY_WIDTH)).collect();
        lines.extend(parts.bonds.into_iter().map(line(NEIGHBOR, BOND_WIDTH)));
        if options.draw_box && lines::is_real(&system.sim_box) {
            let edges = lines::edges(system.sim_box.lo().into(), system.sim_box.hi().into());
            lines.extend(edges.into_iter().map(line(BOX, BOX_WIDTH)));
        }
        let cutoffs = Radii::PerParticle(parts.shape_cutoff);
        let shapes = (!parts.shape_center.is_empty())
            .then(|| Shapes::new(options.shape, &parts.shape_center, &cutoffs, parts.shape_color, width(FRAME_WIDTH)));
        Self {
            spheres: Spheres::new(&parts.center, Radii::PerParticle(parts.radius), parts.color),
            shapes,
            lines,
            lights: Lights::new(camera, options.samples as usize),
        }
    }

    /// The light that comes along a ray, and the part of the background that is seen.
    pub fn sample(&self, ray: &Ray, sample: usize) -> (Vec3, f32) {
        let line = lines::nearest(&self.lines, ray);
        let reach = line.map_or(f32::INFINITY, |(distance, _)| distance);
        let sphere = self.spheres.nearest(ray, reach);
        let reach = sphere.map_or(reach, |hit| hit.distance);
        let (mut seen, mut behind) = (Vec3::ZERO, 1.0);
        if let Some(shapes) = &self.shapes {
            for pane in shapes.panes(ray, reach).as_slice() {
                seen += behind * pane.opacity * self.lights.pane(pane.color, pane.normal);
                behind *= 1.0 - pane.opacity;
            }
        }
        match (sphere, line) {
            (Some(hit), _) => (seen + behind * self.lights.opaque(&self.spheres, &hit, ray, sample), 0.0),
            (None, Some((_, line))) => (seen + behind * line.color, 0.0),
            (None, None) => (seen, behind),
        }
    }
}

/// All particles alike, each with its shape.
fn whole(system: &System, values: Option<&[f64]>, fixed: &Fixed) -> Parts {
    let Fixed { options, radius, range: [lo, hi], .. } = fixed;
    let n = system.particles.len();
    let color: Vec<Vec3> = match values {
        Some(values) => values.iter().map(|v| light(options.color_map.at((v - lo) / (hi - lo)))).collect(),
        None => system.particles.kind.iter().map(|&kind| light(color::of_type(kind))).collect(),
    };
    let position = system.particles.position.clone();
    if options.shape == Shape::Point {
        return Parts { center: position, radius: vec![*radius; n], color, ..Parts::default() };
    }
    Parts {
        center: position.clone(),
        radius: vec![INNER_SIZE * radius; n],
        shape_center: position,
        shape_cutoff: (0..n).map(|i| system.radii.get(i)).collect(),
        shape_color: color.clone(),
        color,
        ..Parts::default()
    }
}

/// The particle in focus, its rays or range, and its neighbours with their shapes. Others are pale, and left out where
/// they would hide these.
fn focused(system: &System, focus: &Focus, fixed: &Fixed) -> Parts {
    let Fixed { options, camera, radius, .. } = fixed;
    let center = focus.position(system);
    let cutoff = system.radii.get(focus.particle);
    let mut parts = Parts::default();
    let mut sphere = |at: Vec3, radius: f32, color: color::Rgb| {
        parts.center.push(at.into());
        parts.radius.push(radius);
        parts.color.push(light(color));
    };
    sphere(center, *radius, FOCUS);
    for place in focus.places(system) {
        sphere(place, NEIGHBOR_SIZE * radius, NEIGHBOR);
    }
    for (i, at) in system.particles.position.iter().enumerate() {
        let at = Vec3::from(at);
        let neighbor = focus.neighbors.binary_search_by_key(&(i as u32), |&(j, _)| j).map(|at| focus.neighbors[at].1);
        let in_front = camera.nearness(at) > camera.nearness(center) - 0.5 * radius;
        match neighbor {
            Ok([0, 0, 0]) => {}
            Ok(_) if i != focus.particle => sphere(at, OTHER_SIZE * radius, NEIGHBOR_HOME),
            Err(_) if i != focus.particle && !in_front => sphere(at, OTHER_SIZE * radius, OTHER),
            _ => {}
        }
    }
    let mut shape = |at: Vec3, cutoff: f32, color: color::Rgb| {
        parts.shape_center.push(at.into());
        parts.shape_cutoff.push(cutoff);
        parts.shape_color.push(light(color));
    };
    if options.shape == Shape::Point {
        shape(center, cutoff, FOCUS);
        parts.bonds = focus.places(system).map(|place| [center, place]).collect();
    } else {
        for (place, &(j, _)) in focus.places(system).zip(&focus.neighbors) {
            shape(place, system.radii.get(j as usize), NEIGHBOR);
        }
    }
    parts.rays = options.shape.rays(center, cutoff);
    parts
}

/// What must be in the picture: the neighbourhood of the focus, or the box and all particles.
pub(super) fn extent(system: &System, options: &Options, radius: f32) -> Vec<Vec3> {
    let (lo, hi) = match options.focus {
        Some(focus) => {
            let center = Vec3::from(system.particles.position.get(focus));
            let cutoff = system.radii.get(focus);
            // Neighbours' shapes reach farther than the neighbours.
            let margin = Vec3::splat(match options.shape {
                Shape::Point => 1.05 * cutoff,
                shape => 0.8 * (cutoff + shape.half_width(cutoff)),
            });
            (center - margin, center + margin)
        }
        None => {
            let shape =
                if options.shape == Shape::Point { 0.0 } else { options.shape.half_width(system.radii.largest()) };
            let margin = Vec3::splat(radius.max(shape));
            let positions = || system.particles.position.iter().map(Vec3::from);
            let lo = positions().reduce(Vec3::min).unwrap_or(Vec3::ZERO) - margin;
            let hi = positions().reduce(Vec3::max).unwrap_or(Vec3::ZERO) + margin;
            if lines::is_real(&system.sim_box) {
                (lo.min(system.sim_box.lo().into()), hi.max(system.sim_box.hi().into()))
            } else {
                (lo, hi)
            }
        }
    };
    lines::edges(lo, hi).into_iter().flatten().collect()
}

/// Whether colours stand for numbers: beside a focus they say what particles are to it.
pub(super) fn is_colored_by_number(options: &Options) -> bool {
    options.focus.is_none() && options.color_by != ColorBy::Type
}
