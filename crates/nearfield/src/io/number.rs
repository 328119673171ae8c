//! Numbers as text.
//!
//! What is written is the shortest text that reads back as the same number, so a round trip is exact.

use super::{Problem, error::Parsed};

/// Parses a number that must be finite in single precision.
///
/// Rounds once, from the decimal text to f32. (By way of f64 it would be rounded twice, which is off by one unit in the
/// last place where the f64 falls half way between two f32.)
pub(super) fn finite(text: &str, what: &'static str, particle: usize) -> Parsed<f32> {
    match text.parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(Problem::NotFinite { what, particle, text: text.to_owned() }),
        Err(_) => Err(not_a_number(text, what, particle)),
    }
}

/// The error for a field that is no number.
pub(super) fn not_a_number(text: &str, what: &'static str, particle: usize) -> Problem {
    Problem::NotANumber { what, particle, text: text.to_owned() }
}

/// Appends a space and the number.
pub(super) fn push<F: zmij::Float>(out: &mut Vec<u8>, value: F) {
    out.push(b' ');
    out.extend_from_slice(zmij::Buffer::new().format(value).as_bytes());
}

/// Appends three numbers, a space before each.
pub(super) fn push_vector(out: &mut Vec<u8>, vector: [f32; 3]) {
    for component in vector {
        push(out, component);
    }
}
