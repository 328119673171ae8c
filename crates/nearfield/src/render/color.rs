//! Colours: of particles by a number or a type, and between the eye's scale (sRGB) and light (linear).

use super::{Error, Result};
use glam::Vec3;
use std::str::FromStr;

/// Red, green and blue as stored in pictures.
pub type Rgb = [u8; 3];

/// What particles are coloured by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorBy {
    /// A colour for each type.
    #[default]
    Type,
    /// Length of the velocity.
    Speed,
    /// Potential energy: half of the energy of the particle's pairs.
    Energy,
    /// Number of neighbours within range.
    Neighbors,
}

/// Scales of colours in which equal steps look equal, to the colour-blind too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorMap {
    /// Violet, green, yellow.
    #[default]
    Viridis,
    /// Blue, grey, yellow.
    Cividis,
    /// Black, violet, orange, pale yellow.
    Magma,
    /// Blue, violet, orange, yellow.
    Plasma,
    /// Black, red, yellow, pale yellow.
    Inferno,
}

impl ColorMap {
    /// The colour at 0 to 1.
    pub fn at(self, t: f64) -> Rgb {
        let gradient = match self {
            Self::Viridis => colorous::VIRIDIS,
            Self::Cividis => colorous::CIVIDIS,
            Self::Magma => colorous::MAGMA,
            Self::Plasma => colorous::PLASMA,
            Self::Inferno => colorous::INFERNO,
        };
        gradient.eval_continuous(t).as_array()
    }
}

/// Colours of types, in turn: those of Okabe and Ito, which the colour-blind can tell apart
/// (<https://jfly.uni-koeln.de/color/>).
const TYPES: [Rgb; 8] = [
    [0x2f, 0x8f, 0xd0],
    [0xe6, 0x9f, 0x00],
    [0x00, 0x9e, 0x73],
    [0xd5, 0x5e, 0x00],
    [0xcc, 0x79, 0xa7],
    [0x56, 0xc8, 0xe9],
    [0xf0, 0xe4, 0x42],
    [0x99, 0x99, 0x99],
];

/// The colour of a type.
pub(super) fn of_type(kind: u32) -> Rgb {
    TYPES[kind as usize % TYPES.len()]
}

/// What is behind the particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// One colour.
    Color(Rgb),
    /// Nothing.
    Transparent,
}

impl Default for Background {
    fn default() -> Self {
        Self::Color([255; 3])
    }
}

impl FromStr for Background {
    type Err = Error;

    /// `white`, `black`, `transparent` or `#rrggbb`.
    fn from_str(text: &str) -> Result<Self> {
        let invalid = || Error::Invalid {
            option: "background",
            value: text.into(),
            reason: "is none of white, black, transparent and a colour such as #f0f4f8",
        };
        match text {
            "white" => Ok(Self::Color([255; 3])),
            "black" => Ok(Self::Color([0; 3])),
            "transparent" => Ok(Self::Transparent),
            _ => {
                let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii());
                let digits =
                    digits.filter(|digits| digits.chars().all(|c| c.is_ascii_hexdigit())).ok_or_else(invalid)?;
                let channel = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).map_err(|_| invalid());
                Ok(Self::Color([channel(0)?, channel(2)?, channel(4)?]))
            }
        }
    }
}

/// Amounts of light, of a colour as pictures store it.
pub(super) fn light(color: Rgb) -> Vec3 {
    Vec3::from(color.map(|channel| {
        let c = f32::from(channel) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    }))
}

/// The colour as pictures store it, of amounts of light; too much light is cut.
pub(super) fn encoded(light: Vec3) -> Rgb {
    light.to_array().map(|l| {
        let l = l.clamp(0.0, 1.0);
        let c = if l <= 0.003_130_8 { 12.92 * l } else { 1.055 * l.powf(1.0 / 2.4) - 0.055 };
        (255.0 * c).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn color_maps_begin_and_end_where_their_authors_say() {
        assert_eq!((ColorMap::Viridis.at(0.0), ColorMap::Viridis.at(1.0)), ([68, 1, 84], [253, 231, 37]));
        assert_eq!((ColorMap::Plasma.at(0.0), ColorMap::Plasma.at(1.0)), ([13, 8, 135], [240, 249, 33]));
        assert_eq!(ColorMap::Viridis.at(7.0), ColorMap::Viridis.at(1.0));
    }

    #[test]
    fn encoding_undoes_decoding() {
        for c in 0..=255 {
            assert_eq!(encoded(light([c, 255 - c, 0])), [c, 255 - c, 0]);
        }
    }

    #[test]
    fn backgrounds_are_names_or_hexadecimal() {
        assert_eq!("#0a10ff".parse::<Background>().unwrap(), Background::Color([10, 16, 255]));
        assert_eq!("transparent".parse::<Background>().unwrap(), Background::Transparent);
        for wrong in ["blue", "#12345", "#12345g", "#+12345", "", "#éééé"] {
            assert!(wrong.parse::<Background>().is_err(), "{wrong}");
        }
    }
}
