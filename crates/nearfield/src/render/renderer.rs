//! From a system to a picture.

use super::{
    Background, ColorBy, Error, Focus, Image, Options,
    camera::Camera,
    color::{self, encoded, light},
    focus,
    legend::{self, Legend},
    scene::{self, Fixed, Scene},
    size, values,
};
use crate::Result;
use glam::Vec3;
use nearfield_core::System;
use rayon::prelude::*;

/// Smallest radius of a drawn particle, \[pixels\].
const LEAST_PIXELS: f32 = 0.7;
/// Steps of a two-dimensional sequence that fills a square evenly: M. Roberts,
/// <https://extremelearning.com.au/unreasonable-effectiveness-of-quasirandom-sequences/>.
const SPREAD: [f32; 2] = [0.754_877_7, 0.569_840_3];

/// Draws the frames of a trajectory with the same camera, sizes and colours.
pub struct Renderer {
    options: Options,
    camera: Camera,
    radius: f32,
    range: [f64; 2],
    legend: Legend,
}

impl Renderer {
    /// Places the camera and chooses sizes and colours by a system, where the options leave them open.
    ///
    /// # Errors
    /// [`Error`]: an option that cannot be meant, no particles; or why energies or neighbours could not be computed.
    pub fn new(system: &System, options: Options) -> Result<Self> {
        options.validate()?;
        let n = system.particles.len();
        if n == 0 {
            return Err(Error::Empty.into());
        }
        if let Some(particle) = options.focus {
            focus::check(particle, n)?;
        }
        let mut range = options.color_range.unwrap_or([0.0, 1.0]);
        let colored = scene::is_colored_by_number(&options);
        if colored && options.color_range.is_none() {
            let values = values::of(system, options.color_by)?;
            range = values::range(&values.unwrap_or_default(), options.color_by);
        }
        let names = &system.interaction.types;
        let legend = if !options.draw_legend || options.focus.is_some() {
            Legend::None
        } else if colored {
            let title = options.label.clone().unwrap_or_else(|| values::title(options.color_by, &system.radii));
            Legend::Bar { title, map: options.color_map, range, counts: options.color_by == ColorBy::Neighbors }
        } else if names.len() > 1 {
            Legend::Names(names.iter().zip(0..).map(|(kind, k)| (kind.name.clone(), color::of_type(k))).collect())
        } else {
            Legend::None
        };
        let [width, height] = options.view.size;
        // In a picture narrower than its legend, the legend covers the scene.
        let room = (width as f32 - legend.width(height)).max(0.5 * width as f32);
        let typical = options.radius.or_else(|| size::typical_radius(&system.particles.position));
        let extent = scene::extent(system, &options, typical.unwrap_or(0.5));
        let camera = Camera::new(&options.view, room, &extent);
        let least = LEAST_PIXELS * camera.pixel;
        let radius = options.radius.unwrap_or_else(|| typical.unwrap_or(0.5).max(least));
        Ok(Self { options, camera, radius, range, legend })
    }

    /// Rows of pixels of a picture.
    pub fn n_rows(&self) -> u32 {
        self.options.view.size[1]
    }

    /// Draws a system; `row_done` is called after each row of pixels, from any thread. The same input gives the same
    /// picture to the bit.
    ///
    /// # Errors
    /// [`Error::Focus`] where the particle in focus is gone; why energies or neighbours could not be computed.
    pub fn draw(&self, system: &System, row_done: &(dyn Fn() + Sync)) -> Result<Image> {
        let options = &self.options;
        let focus = options.focus.map(|particle| Focus::find(system, particle)).transpose()?;
        let values = match scene::is_colored_by_number(options) {
            true => values::of(system, options.color_by)?,
            false => None,
        };
        let fixed = Fixed { options, camera: &self.camera, radius: self.radius, range: self.range };
        let scene = Scene::new(system, values.as_deref(), focus.as_ref(), &fixed);
        let [width, height] = options.view.size;
        let mut image = Image { width, height, pixels: vec![[0; 4]; width as usize * height as usize] };
        image.pixels.par_chunks_mut(width as usize).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = self.pixel(&scene, x as f32, y as f32);
            }
            row_done();
        });
        let behind = match options.background {
            Background::Color(color) => color,
            Background::Transparent => [255; 3],
        };
        self.legend.draw(&mut image, legend::ink(behind));
        Ok(image)
    }

    /// The mean over samples that are spread evenly over a pixel.
    fn pixel(&self, scene: &Scene, x: f32, y: f32) -> [u8; 4] {
        let n = self.options.samples;
        let (mut seen, mut behind) = (Vec3::ZERO, 0.0);
        for sample in 0..n {
            let [dx, dy] = SPREAD.map(|step| (0.5 + step * sample as f32).fract());
            let (light, rest) = scene.sample(&self.camera.ray(x + dx, y + dy), sample as usize);
            // Too bright a highlight would not blend with what is beside it in the pixel.
            seen += light.min(Vec3::ONE);
            behind += rest;
        }
        let (seen, behind) = (seen / n as f32, behind / n as f32);
        match self.options.background {
            Background::Color(color) => {
                let [red, green, blue] = encoded(seen + behind * light(color));
                [red, green, blue, u8::MAX]
            }
            Background::Transparent => {
                let opacity = 1.0 - behind;
                let [red, green, blue] = encoded(if opacity > 0.0 { seen / opacity } else { Vec3::ZERO });
                [red, green, blue, (255.0 * opacity).round() as u8]
            }
        }
    }
}
