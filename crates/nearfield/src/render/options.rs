//! What can be chosen about a picture.

use super::{Background, ColorBy, ColorMap, Error, Result, Shape, View};

/// Pixels a side: more would not fit the memory of many machines.
const MAX_SIDE: u32 = 16384;
/// Samples a pixel that still make a difference.
const MAX_SAMPLES: u32 = 1024;

/// How to draw. The default is particles coloured by type, in perspective, on white.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Camera and size of the picture.
    pub view: View,
    /// What is drawn around particles.
    pub shape: Shape,
    /// Radius of particles, \[length\]; without it, half of the usual distance to the nearest other.
    pub radius: Option<f32>,
    /// What particles are coloured by; with a focus, they are coloured by what they are to it.
    pub color_by: ColorBy,
    /// Colours of numbers.
    pub color_map: ColorMap,
    /// The numbers of the first and the last colour; without it, from the particles, but for 0.5 % on each side.
    pub color_range: Option<[f64; 2]>,
    /// A particle to be shown with its neighbours, by its index from 0.
    pub focus: Option<usize>,
    /// What is behind.
    pub background: Background,
    /// Whether the edges of the box are drawn, where it bounds the particles on some axis.
    pub draw_box: bool,
    /// Whether there is a legend: a bar for numbers, names where there are several types.
    pub draw_legend: bool,
    /// Title of the bar; what follows ` [` goes to a second line.
    pub label: Option<String>,
    /// Rays a pixel, each with one towards the lamp and one towards the sky.
    pub samples: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            view: View::default(),
            shape: Shape::Point,
            radius: None,
            color_by: ColorBy::Type,
            color_map: ColorMap::Viridis,
            color_range: None,
            focus: None,
            background: Background::default(),
            draw_box: true,
            draw_legend: true,
            label: None,
            samples: 16,
        }
    }
}

impl Options {
    /// Checks what does not depend on the particles.
    ///
    /// # Errors
    /// [`Error::Invalid`].
    pub fn validate(&self) -> Result<()> {
        let check = |right: bool, option: &'static str, value: String, reason: &'static str| {
            if right { Ok(()) } else { Err(Error::Invalid { option, value, reason }) }
        };
        let View { azimuth, elevation, zoom, size: [width, height], .. } = self.view;
        let positive = |value: f32| value.is_finite() && value > 0.0;
        let side = |pixels: u32| (1..=MAX_SIDE).contains(&pixels);
        check(side(width) && side(height), "size", format!("{width}x{height}"), "must be 1 to 16384 pixels a side")?;
        check(azimuth.is_finite(), "azimuth", azimuth.to_string(), "must be an angle in degrees")?;
        let upright = (-90.0..=90.0).contains(&elevation);
        check(upright, "elevation", elevation.to_string(), "must be an angle from -90 to 90 degrees")?;
        check(positive(zoom), "zoom", zoom.to_string(), "must be positive and finite")?;
        let samples = (1..=MAX_SAMPLES).contains(&self.samples);
        check(samples, "samples", self.samples.to_string(), "must be 1 to 1024")?;
        if let Some(radius) = self.radius {
            check(positive(radius), "radius", radius.to_string(), "must be positive and finite")?;
        }
        if let Some([lo, hi]) = self.color_range {
            let right = lo.is_finite() && hi.is_finite() && lo < hi;
            check(right, "color range", format!("{lo},{hi}"), "must be a smaller and a larger number")?;
        }
        Ok(())
    }
}
