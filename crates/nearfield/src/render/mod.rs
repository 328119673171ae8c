//! Pictures of configurations: shaded particles, the shapes that ray-tracing methods put around them, one particle and
//! its neighbours. Rays are traced through the CPU's own tree, so no GPU is needed.
//!
//! ```
//! use nearfield::{Boundary, Interaction, Radii, System, generate::Generate, render};
//! let start = Generate { n: 256, density: Some(0.8), ..Generate::default() }.build([Boundary::Periodic; 3], 1.0)?;
//! let system = System {
//!     sim_box: start.sim_box,
//!     particles: start.particles,
//!     radii: Radii::Uniform(2.5),
//!     interaction: Interaction::lennard_jones(),
//! };
//! let view = render::View { size: [160, 120], ..render::View::default() };
//! let renderer = render::Renderer::new(&system, render::Options { view, ..render::Options::default() })?;
//! let image = renderer.draw(&system, &|| {})?;
//! assert_eq!(image.size(), [160, 120]);
//! # Ok::<(), nearfield::Error>(())
//! ```

mod camera;
mod color;
mod error;
mod focus;
mod image;
mod legend;
mod light;
mod lines;
mod options;
mod renderer;
mod scene;
mod shapes;
mod size;
mod spheres;
mod text;
mod values;

pub use camera::{Projection, View};
pub use color::{Background, ColorBy, ColorMap, Rgb};
pub use error::{Error, Result};
pub use focus::Focus;
pub use image::{Image, check_png};
pub use options::Options;
pub use renderer::Renderer;
pub use shapes::Shape;
