//! The header: counts and box bounds.

use super::sections::section_name;
use crate::io::{Bounds, Problem, Result, error::Parsed, line_reader::LineReader};
use std::io::BufRead;

/// What the header says.
pub(super) struct Header {
    pub(super) title: String,
    pub(super) n_atoms: usize,
    pub(super) n_types: usize,
    pub(super) bounds: Bounds,
}

/// Counts of things that are passed over.
const OTHER_COUNTS: [&str; 12] = [
    "bonds",
    "angles",
    "dihedrals",
    "impropers",
    "bond types",
    "angle types",
    "dihedral types",
    "improper types",
    "ellipsoids",
    "lines",
    "triangles",
    "bodies",
];

/// More atom types than anyone has; a wrong count must not exhaust the memory.
const MAX_TYPES: usize = 1 << 20;

/// The text before a comment, without white space around it.
pub(super) fn without_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or_default().trim()
}

impl Header {
    /// Reads up to the name of the first section, which is the next line then.
    pub(super) fn read(lines: &mut LineReader<impl BufRead>) -> Result<Self> {
        if !lines.advance()? {
            return Err(lines.empty());
        }
        let mut found = Found { title: lines.line().trim().to_owned(), ..Found::default() };
        let mut anything = !found.title.is_empty();
        while lines.advance_to_text()? {
            anything = true;
            if section_name(lines.line()).is_some() {
                lines.hold();
                break;
            }
            found.parse_line(without_comment(lines.line())).map_err(|problem| lines.fail(problem))?;
        }
        if !anything {
            return Err(lines.empty());
        }
        found.finish().map_err(|problem| lines.fail(problem))
    }
}

/// What has been found so far.
#[derive(Default)]
struct Found {
    title: String,
    n_atoms: Option<usize>,
    n_types: Option<usize>,
    lo: [Option<f64>; 3],
    hi: [Option<f64>; 3],
}

impl Found {
    fn parse_line(&mut self, line: &str) -> Parsed<()> {
        if line.is_empty() {
            return Ok(());
        }
        let is_number = |word: &&str| word.parse::<f64>().is_ok();
        let numbers: Vec<f64> = line.split_ascii_whitespace().take_while(is_number).flat_map(str::parse).collect();
        let keyword = line.split_ascii_whitespace().skip(numbers.len()).collect::<Vec<_>>().join(" ");
        match (keyword.as_str(), numbers.as_slice()) {
            ("atoms", _) => self.n_atoms = Some(count(line, i32::MAX as usize)?),
            ("atom types", _) => self.n_types = Some(count(line, MAX_TYPES)?),
            ("xlo xhi", &[lo, hi]) => (self.lo[0], self.hi[0]) = (Some(lo), Some(hi)),
            ("ylo yhi", &[lo, hi]) => (self.lo[1], self.hi[1]) = (Some(lo), Some(hi)),
            ("zlo zhi", &[lo, hi]) => (self.lo[2], self.hi[2]) = (Some(lo), Some(hi)),
            ("xy xz yz", tilts) if tilts.len() == 3 && tilts.iter().all(|&t| t == 0.0) => {}
            ("xy xz yz" | "avec" | "bvec" | "cvec" | "abc origin", [_, _, _]) => {
                return Err(Problem::Triclinic { what: line.to_owned() });
            }
            (other, [_]) if OTHER_COUNTS.contains(&other) || other.starts_with("extra ") => {}
            _ => {
                let wanted = "a header line (`N atoms`, `N atom types`, `LO HI xlo xhi`, ...) or a section name";
                return Err(Problem::expected(wanted, line));
            }
        }
        Ok(())
    }

    fn finish(self) -> Parsed<Header> {
        let missing =
            |what: &str| Problem::expected(format!("a header line `{what}`"), "none before the first section");
        let bound = |bound: [Option<f64>; 3]| match bound {
            [Some(x), Some(y), Some(z)] => Ok([x, y, z]),
            _ => {
                Err(Problem::MissingBox("the header lacks xlo xhi, ylo yhi or zlo zhi: a LAMMPS data file needs a box"))
            }
        };
        Ok(Header {
            n_atoms: self.n_atoms.ok_or_else(|| missing("N atoms"))?,
            n_types: self.n_types.ok_or_else(|| missing("N atom types"))?,
            bounds: Bounds::new(bound(self.lo)?, bound(self.hi)?, None)?,
            title: self.title,
        })
    }
}

fn count(line: &str, limit: usize) -> Parsed<usize> {
    let word = line.split_ascii_whitespace().next().unwrap_or_default();
    let count = word.parse().ok().filter(|&count| count <= limit);
    count.ok_or_else(|| Problem::expected(format!("a count of at most {limit}"), line))
}
