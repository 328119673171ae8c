//! The fields of one particle's line.

use super::{Problem, error::Parsed, number};
use std::str::{FromStr, SplitAsciiWhitespace};

/// Names of position components, for messages.
pub(super) const POSITION: [&str; 3] = ["x", "y", "z"];
/// Names of velocity components, for messages.
pub(super) const VELOCITY: [&str; 3] = ["vx", "vy", "vz"];
/// Names of force components, for messages.
pub(super) const FORCE: [&str; 3] = ["fx", "fy", "fz"];
/// Names of image counts, for messages.
pub(super) const IMAGE: [&str; 3] = ["ix", "iy", "iz"];

/// A cursor over the white-space separated fields of a line. Nothing is allocated unless there is an error.
pub(super) struct Row<'a> {
    line: &'a str,
    fields: SplitAsciiWhitespace<'a>,
    particle: usize,
    /// Number and names of the fields of a correct line, for messages.
    expected: (usize, &'a str),
}

impl<'a> Row<'a> {
    pub(super) fn new(line: &'a str, particle: usize, expected: (usize, &'a str)) -> Self {
        Self { line, fields: line.split_ascii_whitespace(), particle, expected }
    }

    /// The next field as it stands.
    pub(super) fn text(&mut self) -> Parsed<&'a str> {
        self.fields.next().ok_or_else(|| self.wrong_count())
    }

    /// The next field, a finite number.
    pub(super) fn real(&mut self, what: &'static str) -> Parsed<f32> {
        let text = self.text()?;
        number::finite(text, what, self.particle)
    }

    /// The next three fields, finite numbers.
    pub(super) fn vector(&mut self, what: [&'static str; 3]) -> Parsed<[f32; 3]> {
        Ok([self.real(what[0])?, self.real(what[1])?, self.real(what[2])?])
    }

    /// The next field, an integer.
    pub(super) fn integer<T: FromStr>(&mut self, what: &'static str) -> Parsed<T> {
        let text = self.text()?;
        text.parse().map_err(|_| number::not_a_number(text, what, self.particle))
    }

    /// The next three fields, image counts.
    pub(super) fn image(&mut self) -> Parsed<[i32; 3]> {
        Ok([self.integer(IMAGE[0])?, self.integer(IMAGE[1])?, self.integer(IMAGE[2])?])
    }

    /// Passes over `count` fields.
    pub(super) fn skip(&mut self, count: usize) -> Parsed<()> {
        for _ in 0..count {
            self.text()?;
        }
        Ok(())
    }

    /// Fails when fields are left.
    pub(super) fn end(mut self) -> Parsed<()> {
        match self.fields.next() {
            None => Ok(()),
            Some(_) => Err(self.wrong_count()),
        }
    }

    fn wrong_count(&self) -> Problem {
        let (expected, layout) = self.expected;
        Problem::Fields { expected, layout: layout.to_owned(), found: self.line.split_ascii_whitespace().count() }
    }
}
