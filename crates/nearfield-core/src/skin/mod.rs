//! The margin of stored neighbour lists: a number, chosen while a simulation runs, or by what lists may miss.

mod intervals;
mod missed;
mod power_law;
mod tuner;

pub use intervals::{Limits, ListCosts, ListIntervals};
pub use missed::{CutoffEdge, ListSize, Missed};
pub use tuner::{LearnedSkin, ListUse, SkinTuner};

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::fmt;

/// Verlet skin of list methods. Written as a number, or as `"auto"`.
///
/// ```
/// use nearfield_core::Skin;
/// assert_eq!(Skin::Fixed(0.3).to_string(), "0.3");
/// assert_eq!(Skin::Auto.to_string(), "auto");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Skin {
    /// Chosen from what the lists before cost and how long they served: see [`SkinTuner`].
    Auto,
    /// This, \[length\]; 0 makes a list at each step.
    Fixed(f32),
}

impl Skin {
    /// A list at each step.
    pub const NONE: Self = Self::Fixed(0.0);

    /// What engines without a [`SkinTuner`] take for [`Skin::Auto`], \[length\].
    pub const USUAL: f32 = 0.3;

    /// The number, [`Skin::USUAL`] where it is to be chosen.
    pub fn or_usual(self) -> f32 {
        match self {
            Self::Auto => Self::USUAL,
            Self::Fixed(skin) => skin,
        }
    }
}

impl fmt::Display for Skin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.pad("auto"),
            Self::Fixed(skin) => skin.fmt(f),
        }
    }
}

impl Serialize for Skin {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Auto => serializer.serialize_str("auto"),
            // The shortest decimal that gives the same f32: 0.3, not 0.30000001192.
            Self::Fixed(skin) => serializer.serialize_f64(skin.to_string().parse().map_err(serde::ser::Error::custom)?),
        }
    }
}

impl<'de> Deserialize<'de> for Skin {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl de::Visitor<'_> for Visitor {
            type Value = Skin;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or \"auto\"")
            }
            fn visit_f64<E: de::Error>(self, skin: f64) -> Result<Skin, E> {
                Ok(Skin::Fixed(skin as f32))
            }
            fn visit_i64<E: de::Error>(self, skin: i64) -> Result<Skin, E> {
                Ok(Skin::Fixed(skin as f32))
            }
            fn visit_u64<E: de::Error>(self, skin: u64) -> Result<Skin, E> {
                Ok(Skin::Fixed(skin as f32))
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<Skin, E> {
                if text == "auto" { Ok(Skin::Auto) } else { Err(E::invalid_value(de::Unexpected::Str(text), &self)) }
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}
