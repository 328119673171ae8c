//! Atom styles: which columns the `Atoms` section has.

use crate::io::{Problem, error::Parsed};

/// The columns before the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Style {
    /// id type
    Atomic,
    /// id type charge
    Charge,
    /// id molecule type
    Molecular,
    /// id molecule type charge
    Full,
}

impl Style {
    /// The style by the comment after `Atoms`, or else by the first line of the section.
    pub(super) fn tell(section_line: &str, first_atom: &str) -> Parsed<Self> {
        let comment = section_line.split_once('#').map_or("", |(_, comment)| comment.trim());
        match comment.split_ascii_whitespace().next() {
            Some("atomic") => Ok(Self::Atomic),
            Some("charge") => Ok(Self::Charge),
            Some("molecular" | "bond" | "angle") => Ok(Self::Molecular),
            Some("full") => Ok(Self::Full),
            Some(_) => Err(Problem::expected("atom style atomic, charge, molecular, bond, angle or full", comment)),
            None => Self::by_field_count(first_atom),
        }
    }

    /// Image flags add three fields to any style.
    fn by_field_count(atom: &str) -> Parsed<Self> {
        let fields: Vec<&str> = atom.split_ascii_whitespace().collect();
        match fields.len() {
            5 | 8 => Ok(Self::Atomic),
            // A charge with a point or an exponent cannot be the type that a molecular file has here.
            6 | 9 if fields[2].parse::<i64>().is_err() => Ok(Self::Charge),
            7 | 10 => Ok(Self::Full),
            6 | 9 => Err(Problem::expected(
                "the atom style after the section name, as in `Atoms # charge` or \
                `Atoms # molecular`, since this line could be either",
                atom,
            )),
            _ => Err(Problem::expected("an atom of style atomic, charge, molecular or full", atom)),
        }
    }

    /// Names of the fields, without and with image flags, and the number of the former.
    pub(super) fn layout(self) -> (usize, &'static str, &'static str) {
        match self {
            Self::Atomic => (5, "id type x y z", "id type x y z ix iy iz"),
            Self::Charge => (6, "id type charge x y z", "id type charge x y z ix iy iz"),
            Self::Molecular => (6, "id molecule type x y z", "id molecule type x y z ix iy iz"),
            Self::Full => (7, "id molecule type charge x y z", "id molecule type charge x y z ix iy iz"),
        }
    }
}
