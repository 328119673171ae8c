//! GROMACS coordinate files, which have fixed columns.
//!
//! The format: <https://manual.gromacs.org/current/reference-manual/file-formats.html#gro>. Lengths stay in nanometres.
//! The file does not say which axes are periodic. A box of zeros stands for none.

use super::{
    Bounds, Configuration, Problem, Result,
    configuration::SpeciesCollector,
    error::Parsed,
    line_reader::LineReader,
    number,
    row::{POSITION, VELOCITY},
};
use std::{io::BufRead, ops::Range};

const TITLE: &str = "a title, the number of atoms, the atoms, the box";

/// Reads a file of one frame.
pub(super) fn read(mut lines: LineReader<impl BufRead>) -> Result<Configuration> {
    if !lines.advance()? {
        return Err(lines.empty());
    }
    let title = lines.line().trim().to_owned();
    if !lines.advance()? {
        return Err(if title.is_empty() { lines.empty() } else { lines.fail(Problem::expected(TITLE, &title)) });
    }
    let n: usize =
        lines.line().trim().parse().map_err(|_| lines.fail(Problem::expected("the number of atoms", lines.line())))?;
    let mut configuration = Configuration { id: Some(Vec::new()), ..Configuration::default() };
    let mut species = SpeciesCollector::default();
    let mut columns = None;
    for particle in 0..n {
        if !lines.advance()? {
            return Err(lines.fail(Problem::TooFew { what: "atoms", expected: n, found: particle }));
        }
        let line = lines.line();
        parse_atom(line, particle, &mut columns, &mut configuration, &mut species).map_err(|p| lines.fail(p))?;
    }
    if !lines.advance()? {
        return Err(lines.fail(Problem::MissingBox("the file ends before the line with the box")));
    }
    configuration.bounds = parse_box(lines.line()).map_err(|p| lines.fail(p))?;
    lines.end("atoms and the box", n)?;
    configuration.species = species.finish();
    configuration.time = after(&title, "t=");
    configuration.step = after(&title, "step=");
    configuration.comment = (!title.is_empty()).then_some(title);
    Ok(configuration)
}

/// Where the numbers of an atom's line stand. Told by the first atom, since files of more than three decimals have
/// wider columns: the distance between two decimal points is the width.
#[derive(Clone, Copy)]
struct Columns {
    width: usize,
    with_velocity: bool,
}

/// Residue number, residue name, atom name, atom number: five characters each.
const NAME: Range<usize> = 10..15;
const NUMBER: Range<usize> = 15..20;
const NUMBERS_FROM: usize = 20;

impl Columns {
    fn of(line: &str) -> Option<Self> {
        let numbers = line.get(NUMBERS_FROM..)?;
        let mut points = numbers.match_indices('.').map(|(at, _)| at);
        let first = points.next()?;
        let width = points.next()? - first;
        Some(Self { width, with_velocity: numbers.trim_end().len() > 3 * width })
    }

    /// Numbers of a line.
    fn count(&self) -> usize {
        if self.with_velocity { 6 } else { 3 }
    }

    /// Number `k` of the line: three positions, then three velocities of the same width.
    fn field<'a>(&self, line: &'a str, k: usize) -> Option<&'a str> {
        let from = NUMBERS_FROM + k * self.width;
        line.get(from..from + self.width).map(str::trim)
    }

    fn vector(&self, line: &str, from: usize, names: [&'static str; 3], particle: usize) -> Parsed<[f32; 3]> {
        let mut vector = [0.0; 3];
        for axis in 0..3 {
            let text = self.field(line, from + axis).ok_or_else(|| short_line(line))?;
            vector[axis] = number::finite(text, names[axis], particle)?;
        }
        Ok(vector)
    }
}

fn short_line(line: &str) -> Problem {
    Problem::expected(
        "an atom in fixed columns (5 residue, 5 residue name, 5 atom name, 5 number, 3 x 8 position)",
        line,
    )
}

fn parse_atom(
    line: &str,
    particle: usize,
    columns: &mut Option<Columns>,
    into: &mut Configuration,
    species: &mut SpeciesCollector,
) -> Parsed<()> {
    let (Some(name), Some(id)) = (line.get(NAME), line.get(NUMBER)) else { return Err(short_line(line)) };
    let columns = match *columns {
        Some(columns) => columns,
        None => *columns.insert(Columns::of(line).ok_or_else(|| short_line(line))?),
    };
    if line.trim_end().len() > NUMBERS_FROM + columns.count() * columns.width {
        return Err(Problem::expected(format!("{} numbers, as for the first atom", columns.count()), line));
    }
    into.position.push(columns.vector(line, 0, POSITION, particle)?);
    if columns.with_velocity {
        into.velocity.get_or_insert_default().push(columns.vector(line, 3, VELOCITY, particle)?);
    }
    species.push(if name.trim().is_empty() { "X" } else { name.trim() });
    let id = id.trim();
    let id = id.parse().map_err(|_| number::not_a_number(id, "atom number", particle))?;
    into.id.get_or_insert_default().push(id);
    Ok(())
}

/// `v1(x) v2(y) v3(z)`, and for a triclinic box `v1(y) v1(z) v2(x) v2(z) v3(x) v3(y)`.
fn parse_box(line: &str) -> Parsed<Option<Bounds>> {
    let numbers: Option<Vec<f64>> = line.split_ascii_whitespace().map(|v| v.parse().ok()).collect();
    let numbers = numbers.filter(|n| n.len() == 3 || n.len() == 9);
    let numbers = numbers.ok_or_else(|| Problem::expected("a box of 3 or 9 numbers after the last atom", line))?;
    if numbers.iter().all(|&v| v == 0.0) {
        return Ok(None);
    }
    if numbers[3..].iter().any(|&v| v != 0.0) {
        return Err(Problem::Triclinic { what: format!("box line `{}`", line.trim()) });
    }
    Bounds::new([0.0; 3], [numbers[0], numbers[1], numbers[2]], None).map(Some)
}

/// The number after a key of the title, such as `t= 1.5`.
fn after<T: std::str::FromStr>(title: &str, key: &str) -> Option<T> {
    let mut words = title.split_ascii_whitespace();
    words.find(|&word| word == key)?;
    words.next()?.parse().ok()
}
