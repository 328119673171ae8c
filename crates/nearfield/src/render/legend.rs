//! What the colours mean: a bar with numbers, or the names of types.

use super::{
    ColorMap, Image,
    color::{self, Rgb},
    text::Pen,
};

/// The legend of a picture, in a strip at its right.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Legend {
    /// None: one type, or not wanted.
    None,
    /// A bar of colours, for counts with whole numbers beside it.
    Bar { title: String, map: ColorMap, range: [f64; 2], counts: bool },
    /// Names and their colours.
    Names(Vec<(String, Rgb)>),
}

/// Space between things, in heights of letters.
const GAP: f32 = 0.6;

impl Legend {
    /// Width of the strip, \[pixels\].
    pub fn width(&self, height: u32) -> f32 {
        let letter = letter(height);
        let pen = Pen::new(letter, [0; 3]);
        let widest = |texts: &mut dyn Iterator<Item = &str>| texts.map(|text| pen.width(text)).fold(0.0, f32::max);
        match self {
            Self::None => 0.0,
            Self::Bar { title, range, counts, .. } => {
                let labels: Vec<String> = ticks(*range, *counts).into_iter().map(|(_, label)| label).collect();
                let bar = letter * (1.0 + GAP) + widest(&mut labels.iter().map(String::as_str));
                bar.max(widest(&mut lines(title).iter().map(String::as_str))) + 2.5 * GAP * letter
            }
            Self::Names(names) => widest(&mut names.iter().map(|(name, _)| name.as_str())) + letter * (1.0 + 3.5 * GAP),
        }
    }

    /// Draws the legend into its strip.
    pub fn draw(&self, image: &mut Image, ink: Rgb) {
        let letter = letter(image.height);
        let left = image.width as f32 - self.width(image.height) + GAP * letter;
        let pen = Pen::new(letter, ink);
        match self {
            Self::None => {}
            Self::Bar { title, map, range, counts } => {
                let (top, bottom) = (0.3 * image.height as f32, 0.75 * image.height as f32);
                let lines = lines(title);
                for (row, line) in lines.iter().rev().enumerate() {
                    pen.write(image, left, top - (1.0 + 1.2 * row as f32) * letter, line);
                }
                for y in top as u32..bottom as u32 {
                    let color = map.at(f64::from((bottom - y as f32) / (bottom - top)));
                    for x in left as u32..(left + letter) as u32 {
                        image.blend(x.into(), y.into(), color, 1.0);
                    }
                }
                for (value, label) in ticks(*range, *counts) {
                    let y = bottom - (bottom - top) * ((value - range[0]) / (range[1] - range[0])) as f32;
                    pen.write(image, left + letter * (1.0 + GAP), y, &label);
                    for x in 0..(0.3 * letter) as u32 {
                        image.blend((left + letter) as i64 + i64::from(x), y as i64, ink, 1.0);
                    }
                }
            }
            Self::Names(names) => {
                let pitch = 1.6 * letter;
                let top = 0.5 * (image.height as f32 - pitch * (names.len() - 1) as f32);
                for (row, (name, color)) in names.iter().enumerate() {
                    let y = top + pitch * row as f32;
                    disc(image, [left + 0.5 * letter, y], 0.5 * letter, *color);
                    pen.write(image, left + letter * (1.0 + GAP), y, name);
                }
            }
        }
    }
}

/// Height of letters in a picture of a height, \[pixels\].
fn letter(height: u32) -> f32 {
    (0.028 * height as f32).max(11.0)
}

/// Units go to a line of their own.
fn lines(title: &str) -> Vec<String> {
    match title.split_once(" [") {
        Some((name, unit)) => vec![name.into(), format!("[{unit}")],
        None => vec![title.into()],
    }
}

fn disc(image: &mut Image, center: [f32; 2], radius: f32, color: Rgb) {
    let from = |c: f32| (c - radius) as i64 - 1;
    let to = |c: f32| (c + radius) as i64 + 1;
    for y in from(center[1])..=to(center[1]) {
        for x in from(center[0])..=to(center[0]) {
            let distance = (x as f32 + 0.5 - center[0]).hypot(y as f32 + 0.5 - center[1]);
            image.blend(x, y, color, (radius - distance + 0.5).clamp(0.0, 1.0));
        }
    }
}

/// Round numbers within a range, 3 to 8 of them where there are as many, and how they are written.
fn ticks([lo, hi]: [f64; 2], counts: bool) -> Vec<(f64, String)> {
    let rough = (hi - lo) / 5.0;
    let decade = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|s| s * decade).into_iter().find(|&s| s >= rough).unwrap_or(rough);
    let step = if counts { step.max(1.0) } else { step };
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    let label = |value: f64| {
        if (1e-4..1e6).contains(&step) { format!("{value:.decimals$}") } else { format!("{value:.1e}") }
    };
    let (first, last) = ((lo / step - 1e-9).ceil() as i64, (hi / step + 1e-9).floor() as i64);
    let ticks = (first..=last).map(|tick| tick as f64 * step);
    ticks.map(|value| (value, label(value).replace('-', "−"))).collect()
}

/// Black or white letters, whichever can be read on a background.
pub(super) fn ink(background: Rgb) -> Rgb {
    let luminance = color::light(background).dot(glam::Vec3::new(0.2126, 0.7152, 0.0722));
    if luminance > 0.18 { [0x33; 3] } else { [0xe0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(range: [f64; 2]) -> Vec<String> {
        ticks(range, false).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_within_the_range() {
        assert_eq!(labels([0.0, 1.0]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels([-7.2, -3.1]), ["−7", "−6", "−5", "−4"]);
        assert_eq!(labels([8.0, 62.0]), ["20", "40", "60"]);
        for range in [[1e-9, 3e-9], [-1e12, 1e12], [5.0, 5.001]] {
            let n = labels(range).len();
            assert!((3..=8).contains(&n), "{range:?}: {n}");
        }
    }

    #[test]
    fn counts_have_whole_numbers() {
        let labels: Vec<String> = ticks([11.0, 13.0], true).into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["11", "12", "13"]);
    }

    #[test]
    fn a_bar_runs_from_the_colour_of_the_least_at_the_bottom_to_that_of_the_most_at_the_top() {
        let mut image = Image { width: 400, height: 300, pixels: vec![[255; 4]; 400 * 300] };
        let legend = Legend::Bar { title: "speed".into(), map: ColorMap::Viridis, range: [0.0, 1.0], counts: false };
        legend.draw(&mut image, [0; 3]);
        let x = (400.0 - legend.width(300) + 1.2 * letter(300)) as u32;
        let near = |[r, g, b, _]: [u8; 4], color: Rgb| [r, g, b].iter().zip(color).all(|(a, b)| a.abs_diff(b) < 6);
        assert!(near(image.pixel(x, 91), ColorMap::Viridis.at(1.0)), "{:?}", image.pixel(x, 91));
        assert!(near(image.pixel(x, 223), ColorMap::Viridis.at(0.0)), "{:?}", image.pixel(x, 223));
    }
}
