//! Amounts of memory.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::{fmt, str::FromStr};

/// A number of bytes, written as a whole number or with a unit: `"4 GiB"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Bytes(pub u64);

/// Units and their powers of two, smallest first.
const UNITS: [(&str, u32); 5] = [("B", 0), ("KiB", 10), ("MiB", 20), ("GiB", 30), ("TiB", 40)];

/// In the largest unit that makes a whole number.
impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let whole = |power: u32| self.0 > 0 && self.0.is_multiple_of(1 << power);
        let (unit, power) = UNITS.into_iter().rev().find(|&(_, power)| whole(power)).unwrap_or(UNITS[0]);
        write!(f, "{} {unit}", self.0 >> power)
    }
}

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        let unit = text[number.len()..].trim();
        let power = if unit.is_empty() { Some(0) } else { UNITS.iter().find(|(u, _)| *u == unit).map(|&(_, p)| p) };
        let count: Option<f64> = number.trim().parse().ok().filter(|n: &f64| n.is_finite() && *n >= 0.0);
        match (count, power) {
            (Some(count), Some(power)) => Ok(Self((count * f64::from(power).exp2()) as u64)),
            _ => Err(format!(
                "\"{text}\" is not an amount of memory; write bytes, or a number with KiB, MiB, GiB or TiB"
            )),
        }
    }
}

impl Serialize for Bytes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Bytes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl de::Visitor<'_> for Visitor {
            type Value = Bytes;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("bytes or text such as \"4 GiB\"")
            }
            fn visit_i64<E: de::Error>(self, bytes: i64) -> Result<Bytes, E> {
                u64::try_from(bytes).map(Bytes).map_err(E::custom)
            }
            fn visit_u64<E: de::Error>(self, bytes: u64) -> Result<Bytes, E> {
                Ok(Bytes(bytes))
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<Bytes, E> {
                text.parse().map_err(E::custom)
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}
