//! The second line of a frame.

use super::columns::Columns;
use crate::io::{Bounds, Problem, error::Parsed};

/// What the comment line says about its frame.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Comment {
    pub(super) columns: Columns,
    pub(super) bounds: Option<Bounds>,
    pub(super) step: Option<u64>,
    pub(super) time: Option<f64>,
    /// The key `comment`, or the whole line where it is free text.
    pub(super) text: Option<String>,
}

impl Comment {
    /// A line with none of `Properties=`, `Lattice=`, `pbc=` is the free text of plain XYZ.
    pub(super) fn parse(line: &str) -> Parsed<Self> {
        let text = line.trim();
        if !["Properties", "Lattice", "pbc"].iter().any(|key| declares(text, key)) {
            return Ok(Self { text: (!text.is_empty()).then(|| text.to_owned()), ..Self::default() });
        }
        let mut comment = Self::default();
        let (mut lattice, mut origin, mut pbc) = (None, None, None);
        for (key, value) in key_values(text)? {
            match key.as_str() {
                "Properties" => comment.columns = Columns::parse(&value)?,
                "Lattice" => lattice = Some(reals::<9>("Lattice", &value)?),
                "Origin" => origin = Some(reals::<3>("Origin", &value)?),
                "pbc" => pbc = Some(booleans(&value)?),
                "comment" => comment.text = Some(value),
                "step" | "Step" => comment.step = value.parse().ok(),
                "time" | "Time" => comment.time = value.parse().ok(),
                _ => {}
            }
        }
        comment.bounds = match lattice {
            // The format's default: a lattice is periodic unless `pbc` says otherwise.
            Some(lattice) => Some(bounds(lattice, origin.unwrap_or_default(), pbc.unwrap_or([true; 3]))?),
            None if pbc.is_some_and(|pbc| pbc.contains(&true)) => {
                return Err(Problem::MissingBox(
                    "pbc declares a periodic axis, but there is no Lattice to give its length",
                ));
            }
            None => None,
        };
        Ok(comment)
    }
}

/// Whether `key =` is somewhere in the line.
fn declares(line: &str, key: &str) -> bool {
    line.match_indices(key).any(|(at, _)| line[at + key.len()..].trim_start().starts_with('='))
}

fn bounds(lattice: [f64; 9], lo: [f64; 3], periodic: [bool; 3]) -> Parsed<Bounds> {
    let lengths = [lattice[0], lattice[4], lattice[8]];
    let largest = lattice.iter().fold(0.0f64, |a, b| a.max(b.abs()));
    // Other programs leave residues such as 1e-16 where the matrix was rotated; single precision cannot see them.
    let is_residue = |v: f64| v.abs() <= largest * f64::from(f32::EPSILON) / 4.0;
    for row in 0..3 {
        for column in (0..3).filter(|&column| column != row) {
            if !is_residue(lattice[3 * row + column]) {
                let what = format!(
                    "Lattice vector {} has {} = {}",
                    ["a", "b", "c"][row],
                    ["x", "y", "z"][column],
                    lattice[3 * row + column]
                );
                return Err(Problem::Triclinic { what });
            }
        }
    }
    Bounds::new(lo, std::array::from_fn(|axis| lo[axis] + lengths[axis]), Some(periodic))
}

fn reals<const N: usize>(key: &str, value: &str) -> Parsed<[f64; N]> {
    let numbers: Option<Vec<f64>> = values(value).map(|v| v.parse().ok()).collect();
    let wrong = || Problem::expected(format!("{N} numbers in {key}"), value);
    numbers.and_then(|n| n.try_into().ok()).ok_or_else(wrong)
}

fn booleans(value: &str) -> Parsed<[bool; 3]> {
    let parse = |text: &str| match text {
        "T" | "True" | "true" | "TRUE" | "1" => Some(true),
        "F" | "False" | "false" | "FALSE" | "0" => Some(false),
        _ => None,
    };
    let flags: Option<Vec<bool>> = values(value).map(parse).collect();
    let wrong = || Problem::expected("three of T or F in pbc", value);
    flags.and_then(|f| f.try_into().ok()).ok_or_else(wrong)
}

fn values(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| c.is_whitespace() || c == ',').filter(|v| !v.is_empty())
}

/// Splits `key=value` pairs. A value may be enclosed in "", '', {} or []; a backslash takes the next character as it
/// is. A word without `=` is a key with the value `T`.
fn key_values(line: &str) -> Parsed<Vec<(String, String)>> {
    let mut pairs = Vec::new();
    let mut characters = line.chars().peekable();
    loop {
        while characters.next_if(|c| c.is_whitespace()).is_some() {}
        if characters.peek().is_none() {
            return Ok(pairs);
        }
        let key = word(&mut characters, line)?;
        while characters.next_if(|c| c.is_whitespace()).is_some() {}
        let value = match characters.next_if_eq(&'=') {
            Some(_) => {
                while characters.next_if(|c| c.is_whitespace()).is_some() {}
                word(&mut characters, line)?
            }
            None => "T".to_owned(),
        };
        pairs.push((key, value));
    }
}

/// Characters up to white space or `=`, or an enclosed text.
fn word(characters: &mut std::iter::Peekable<std::str::Chars>, line: &str) -> Parsed<String> {
    let closing = match characters.peek() {
        Some('"') => Some('"'),
        Some('\'') => Some('\''),
        Some('{') => Some('}'),
        Some('[') => Some(']'),
        _ => None,
    };
    let mut word = String::new();
    let Some(closing) = closing else {
        while let Some(c) = characters.next_if(|&c| !c.is_whitespace() && c != '=') {
            word.push(c);
        }
        if word.is_empty() {
            // A stray `=`: taken as it is, so that every call makes progress.
            word.extend(characters.next());
        }
        return Ok(word);
    };
    characters.next();
    while let Some(c) = characters.next() {
        match c {
            '\\' => word.extend(characters.next()),
            c if c == closing => return Ok(word),
            c => word.push(c),
        }
    }
    Err(Problem::expected(format!("a closing {closing} on the comment line"), line))
}
