//! What can be typed after `nearfield render`.

use super::boundaries;
use clap::{Args, ValueEnum};
use nearfield::{
    Boundary,
    render::{Background, ColorBy, ColorMap, Projection, Shape},
};
use std::{path::PathBuf, str::FromStr};

pub const HELP: &str = "\
Examples:
  nearfield render examples/melt.toml -o start.png
  nearfield render melt.data -o melt.png --color energy --size 1920x1080
  nearfield render points.xyz -o neighbours.png --focus 17 --cutoff 2.5
  nearfield render points.xyz -o squares.png --as squares --focus 17 --cutoff 2.5
  nearfield render out/melt/trajectory.xyz -o last.png --frame last --color speed --background transparent
  nearfield render out/melt/trajectory.xyz -o film/frame.png --frames 0:100:2 --color speed
  ffmpeg -framerate 25 -i film/frame_%04d.png -pix_fmt yuv420p film.mp4

Particles are shaded spheres that touch their usual nearest neighbour. With --focus N the camera looks at particle N \
(counted from 0): it is orange, its neighbours are blue, through periodic faces too (there where they are within \
range, and paler where they are in the box), all others are grey, and those that would hide it are left out.

With --as the picture shows what the ray-tracing methods work with, for the cutoff C: spheres of radius C*sqrt(2/3) \
(rt-spheres), squares of width C (rt-squares), boxes of half width C (rt-boxes); with --focus those of the neighbours, \
and the rays of the particle that find them. Drawing takes the CPU only.";

#[derive(Args)]
pub struct RenderArguments {
    /// Particles: .xyz, .extxyz, .data, .lmp, .gro, - for extended XYZ on standard input, or a configuration file
    /// (.toml) for its start.
    pub input: PathBuf,
    /// Picture to write: .png. With --frames, frame.png stands for frame_0001.png and so on.
    #[arg(short, long, value_name = "PICTURE.png")]
    pub output: PathBuf,

    /// What is drawn for a particle.
    #[arg(long = "as", visible_alias = "show", value_enum, default_value = "points", help_heading = "What")]
    pub shape: ShapeName,
    /// Show this particle, its rays and its neighbours.
    #[arg(long, value_name = "N", help_heading = "What")]
    pub focus: Option<usize>,
    /// Search radius of --as, --focus and --color neighbors, and cutoff of --color energy; where the input has radii,
    /// those are taken.
    #[arg(long, value_name = "C", allow_negative_numbers = true, help_heading = "What")]
    pub cutoff: Option<f64>,
    /// Frame of a trajectory, counted from 0, or last.
    #[arg(long, value_name = "N", default_value = "0", conflicts_with = "frames", help_heading = "What")]
    pub frame: FrameName,
    /// A picture for each frame of a trajectory: all, or FIRST:LAST or FIRST:LAST:STEP, counted from 0. Camera, sizes
    /// and the range of colours are those of the first.
    #[arg(long, value_name = "FRAMES", num_args = 0..=1, default_missing_value = "::", help_heading = "What")]
    pub frames: Option<FrameRange>,
    /// Boundaries by axis: p periodic, w wall, o open; without them the input's own.
    #[arg(long, value_parser = boundaries, help_heading = "What")]
    pub boundary: Option<[Boundary; 3]>,
    /// Configuration file, for its [interaction] (--color energy).
    #[arg(long, value_name = "CONFIG.toml", help_heading = "What")]
    pub config: Option<PathBuf>,

    /// What particles are coloured by.
    #[arg(long, value_enum, default_value = "type", help_heading = "Look")]
    pub color: ColorName,
    /// Colours of numbers; equal steps look equal, to the colour-blind too.
    #[arg(long, value_enum, default_value = "viridis", help_heading = "Look")]
    pub colormap: MapName,
    /// Numbers of the first and the last colour; without it all but 0.5 % of the particles at either end.
    #[arg(long, value_name = "LO,HI", value_parser = pair::<f64>, allow_hyphen_values = true, help_heading = "Look")]
    pub color_range: Option<[f64; 2]>,
    /// Title of the colour bar, as in "speed [nm/ps]".
    #[arg(long, value_name = "TEXT", help_heading = "Look")]
    pub label: Option<String>,
    /// Radius of the particles drawn.
    #[arg(long, value_name = "R", allow_negative_numbers = true, help_heading = "Look")]
    pub radius: Option<f32>,
    /// white, black, transparent or a colour such as #f0f4f8.
    #[arg(long, default_value = "white", help_heading = "Look")]
    pub background: Background,
    /// Leave out the edges of the box.
    #[arg(long, help_heading = "Look")]
    pub no_box: bool,
    /// Leave out the colour bar, or the names of types.
    #[arg(long, help_heading = "Look")]
    pub no_legend: bool,

    /// Pixels.
    #[arg(long, value_name = "WxH", default_value = "1600x1200", value_parser = size, help_heading = "Camera")]
    pub size: [u32; 2],
    /// Where the camera stands: its angle about the z axis from +x, and above the xy plane, in degrees.
    #[arg(
        long, value_name = "AZIMUTH,ELEVATION", default_value = "-60,20", value_parser = pair::<f32>,
        allow_hyphen_values = true, help_heading = "Camera"
    )]
    pub orbit: [f32; 2],
    /// Magnification: at 1 everything fits, or with --focus the neighbourhood.
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true, help_heading = "Camera")]
    pub zoom: f32,
    /// How depth is drawn.
    #[arg(long, value_enum, default_value = "perspective", help_heading = "Camera")]
    pub projection: ProjectionName,
    /// Rays a pixel: more are smoother and slower.
    #[arg(long, default_value_t = 16, help_heading = "Camera")]
    pub samples: u32,
}

/// Names of [`Shape`].
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ShapeName {
    /// The particle alone.
    #[value(alias = "particles")]
    Points,
    /// Also the sphere that axis rays meet.
    Spheres,
    /// Also the two squares that edge rays meet.
    Squares,
    /// Also the box that points lie in.
    Boxes,
}

impl From<ShapeName> for Shape {
    fn from(name: ShapeName) -> Self {
        match name {
            ShapeName::Points => Self::Point,
            ShapeName::Spheres => Self::Sphere,
            ShapeName::Squares => Self::Squares,
            ShapeName::Boxes => Self::Box,
        }
    }
}

/// Names of [`ColorBy`].
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ColorName {
    /// Type, or species.
    Type,
    /// Length of the velocity.
    Speed,
    /// Half of the potential energy of the particle's pairs.
    Energy,
    /// Number of neighbours within the cutoff.
    Neighbors,
}

impl From<ColorName> for ColorBy {
    fn from(name: ColorName) -> Self {
        match name {
            ColorName::Type => Self::Type,
            ColorName::Speed => Self::Speed,
            ColorName::Energy => Self::Energy,
            ColorName::Neighbors => Self::Neighbors,
        }
    }
}

/// Names of [`ColorMap`].
#[derive(Clone, Copy, ValueEnum)]
pub enum MapName {
    Viridis,
    Cividis,
    Magma,
    Plasma,
    Inferno,
}

impl From<MapName> for ColorMap {
    fn from(name: MapName) -> Self {
        match name {
            MapName::Viridis => Self::Viridis,
            MapName::Cividis => Self::Cividis,
            MapName::Magma => Self::Magma,
            MapName::Plasma => Self::Plasma,
            MapName::Inferno => Self::Inferno,
        }
    }
}

/// Names of [`Projection`].
#[derive(Clone, Copy, ValueEnum)]
pub enum ProjectionName {
    /// What is farther is smaller.
    Perspective,
    /// Parallel lines stay parallel.
    Orthographic,
}

impl From<ProjectionName> for Projection {
    fn from(name: ProjectionName) -> Self {
        match name {
            ProjectionName::Perspective => Self::Perspective,
            ProjectionName::Orthographic => Self::Orthographic,
        }
    }
}

/// A frame of a trajectory.
#[derive(Clone, Copy)]
pub struct FrameName(pub nearfield::io::Frame);

impl FromStr for FrameName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        use nearfield::io::Frame;
        let index = |_| "write the number of a frame, counted from 0, or last".to_string();
        if text == "last" { Ok(Self(Frame::Last)) } else { text.parse().map(|n| Self(Frame::Index(n))).map_err(index) }
    }
}

/// Frames of a trajectory: `first`, `first + step`, and so on up to `last`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    pub first: usize,
    pub last: usize,
    pub step: usize,
}

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || "write all, FIRST:LAST or FIRST:LAST:STEP, as in 0:100:10".to_string();
        let text = if text == "all" { "::" } else { text };
        let mut parts = text.split(':').map(str::trim);
        let mut number = |default: usize| match parts.next() {
            None | Some("") => Ok(default),
            Some(part) => part.parse().map_err(|_| wrong()),
        };
        let range = Self { first: number(0)?, last: number(usize::MAX)?, step: number(1)? };
        let right = text.contains(':') && parts.next().is_none() && range.first <= range.last && range.step > 0;
        if right { Ok(range) } else { Err(wrong()) }
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || "write width and height in pixels, as in 1920x1080".to_string();
    let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse().map_err(|_| wrong());
    Ok([number(width)?, number(height)?])
}

fn pair<T: FromStr>(text: &str) -> Result<[T; 2], String> {
    let wrong = || "two numbers are needed, as in -60,20".to_string();
    let (first, second) = text.split_once(',').ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse().map_err(|_| wrong());
    Ok([number(first)?, number(second)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_of_frames_may_leave_out_any_part() {
        let range = |first, last, step| Ok(FrameRange { first, last, step });
        assert_eq!("all".parse(), range(0, usize::MAX, 1));
        assert_eq!("::".parse(), range(0, usize::MAX, 1));
        assert_eq!("3:".parse(), range(3, usize::MAX, 1));
        assert_eq!(":9:2".parse(), range(0, 9, 2));
        for wrong in ["", "3", "9:3", "1:2:0", "1:2:3:4", "a:b", "-1:2"] {
            assert!(wrong.parse::<FrameRange>().is_err(), "{wrong}");
        }
    }
}
