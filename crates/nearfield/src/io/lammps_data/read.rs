//! Reading.

use super::{
    header::{Header, without_comment},
    sections::{ATOMS, LABELS, MASSES, VELOCITIES, section_name},
    style::Style,
};
use crate::io::{
    Configuration, IoError, Problem, Result, Species,
    error::Parsed,
    line_reader::LineReader,
    number,
    row::{POSITION, Row, VELOCITY},
};
use nearfield_core::Vec3s;
use std::io::BufRead;

/// Reads a data file; atoms keep the order of the file.
pub(in crate::io) fn read(mut lines: LineReader<impl BufRead>) -> Result<Configuration> {
    let header = Header::read(&mut lines)?;
    let mut reader = Reader::new(lines, &header);
    reader.sections()?;
    Ok(reader.finish(header))
}

struct Reader<R> {
    lines: LineReader<R>,
    n_atoms: usize,
    n_types: usize,
    /// Atom type labels, which are the names of species; without any, the numbers are.
    names: Vec<String>,
    masses: Option<Vec<f32>>,
    atoms: Option<Atoms>,
    velocity: Option<Vec3s>,
}

/// What the `Atoms` section gives.
#[derive(Default)]
struct Atoms {
    id: Vec<u64>,
    kind: Vec<u32>,
    position: Vec3s,
    image: Option<Vec<[i32; 3]>>,
    /// Ids in ascending order, each with its atom's index.
    index: Vec<(u64, u32)>,
}

impl<R: BufRead> Reader<R> {
    fn new(lines: LineReader<R>, header: &Header) -> Self {
        let names = (1..=header.n_types).map(|kind| kind.to_string()).collect();
        let (n_atoms, n_types) = (header.n_atoms, header.n_types);
        Self { lines, n_atoms, n_types, names, masses: None, atoms: None, velocity: None }
    }

    fn sections(&mut self) -> Result<()> {
        while self.lines.advance_to_text()? {
            match section_name(self.lines.line()) {
                Some(MASSES) => self.masses()?,
                Some(LABELS) => self.labels()?,
                Some(ATOMS) => self.atoms()?,
                Some(VELOCITIES) => self.velocities()?,
                Some(_) => self.skip_section()?,
                None if without_comment(self.lines.line()).is_empty() => {}
                None => {
                    let wanted = "a section name (Masses, Atoms, Velocities, Pair Coeffs, ...)";
                    return Err(self.fail(Problem::expected(wanted, self.lines.line())));
                }
            }
        }
        if self.atoms.is_none() && self.n_atoms > 0 {
            return Err(self.too_few("atoms", self.n_atoms, 0));
        }
        Ok(())
    }

    fn fail(&self, problem: Problem) -> IoError {
        self.lines.fail(problem)
    }

    fn too_few(&self, what: &'static str, expected: usize, found: usize) -> IoError {
        self.fail(Problem::TooFew { what, expected, found })
    }

    /// Moves to entry `found` of a section that has `expected` of them.
    fn advance_to_entry(&mut self, what: &'static str, expected: usize, found: usize) -> Result<()> {
        loop {
            if !self.lines.advance_to_text()? || section_name(self.lines.line()).is_some() {
                return Err(self.too_few(what, expected, found));
            }
            if !without_comment(self.lines.line()).is_empty() {
                return Ok(());
            }
        }
    }

    /// Fails unless the end or another section follows the entries.
    fn end_section(&mut self, what: &'static str, expected: usize) -> Result<()> {
        while self.lines.advance_to_text()? {
            let line = self.lines.line();
            if section_name(line).is_some() {
                self.lines.hold();
                return Ok(());
            }
            if without_comment(line).starts_with(|c: char| c.is_ascii_digit()) {
                return Err(self.fail(Problem::Trailing { what, expected, text: line.to_owned() }));
            }
            if !without_comment(line).is_empty() {
                self.lines.hold();
                return Ok(());
            }
        }
        Ok(())
    }

    fn skip_section(&mut self) -> Result<()> {
        while self.lines.advance_to_text()? {
            if section_name(self.lines.line()).is_some() {
                self.lines.hold();
                return Ok(());
            }
        }
        Ok(())
    }

    /// Reads one value for each atom type; `what` names the entries.
    fn per_type<T>(&mut self, what: &'static str, parse: impl Fn(&str) -> Parsed<T>) -> Result<Vec<T>> {
        let mut values: Vec<Option<T>> = (0..self.n_types).map(|_| None).collect();
        for found in 0..self.n_types {
            self.advance_to_entry(what, self.n_types, found)?;
            let line = without_comment(self.lines.line());
            let parsed = match line.split_ascii_whitespace().collect::<Vec<_>>()[..] {
                [kind, value] => self.kind(kind).and_then(|kind| Ok((kind, parse(value)?))),
                _ => Err(Problem::expected("an atom type and a value", line)),
            };
            let (kind, value) = parsed.map_err(|problem| self.fail(problem))?;
            if values[kind as usize].replace(value).is_some() {
                return Err(self.fail(Problem::expected("each atom type once", line)));
            }
        }
        self.end_section(what, self.n_types)?;
        Ok(values.into_iter().flatten().collect())
    }

    fn masses(&mut self) -> Result<()> {
        let parse = |text: &str| match text.parse::<f32>() {
            Ok(mass) if mass.is_finite() && mass > 0.0 => Ok(mass),
            _ => Err(Problem::expected("a positive mass", text)),
        };
        self.masses = Some(self.per_type("masses", parse)?);
        Ok(())
    }

    fn labels(&mut self) -> Result<()> {
        self.names = self.per_type("atom type labels", |text| Ok(text.to_owned()))?;
        Ok(())
    }

    /// The species index of a type, given as number or label.
    fn kind(&self, text: &str) -> Parsed<u32> {
        let number = text.parse().ok().filter(|number| (1..=self.n_types).contains(number)).map(|number| number - 1);
        let kind = number.or_else(|| self.names.iter().position(|name| name == text));
        let wanted = || match self.n_types {
            1 => "atom type 1".to_owned(),
            n => format!("an atom type from 1 to {n}"),
        };
        kind.map(|kind| kind as u32).ok_or_else(|| Problem::expected(wanted(), text))
    }

    fn atoms(&mut self) -> Result<()> {
        let section_line = self.lines.line().to_owned();
        let mut style = None;
        let mut atoms = Atoms::default();
        for found in 0..self.n_atoms {
            self.advance_to_entry("atoms", self.n_atoms, found)?;
            let line = without_comment(self.lines.line());
            self.atom(line, &section_line, &mut style, &mut atoms).map_err(|problem| self.fail(problem))?;
        }
        self.end_section("atoms", self.n_atoms)?;
        atoms.make_index().map_err(|problem| self.fail(problem))?;
        self.atoms = Some(atoms);
        Ok(())
    }

    fn atom(&self, line: &str, section_line: &str, style: &mut Option<(Style, bool)>, atoms: &mut Atoms) -> Parsed<()> {
        let (style, with_images) = match *style {
            Some(style) => style,
            None => {
                let told = Style::tell(section_line, line)?;
                let with_images = line.split_ascii_whitespace().count() > told.layout().0;
                *style.insert((told, with_images))
            }
        };
        let (width, short, long) = style.layout();
        let expected = if with_images { (width + 3, long) } else { (width, short) };
        let mut row = Row::new(line, atoms.id.len(), expected);
        atoms.id.push(row.integer("id")?);
        if matches!(style, Style::Molecular | Style::Full) {
            row.integer::<i64>("molecule")?;
        }
        atoms.kind.push(self.kind(row.text()?)?);
        if matches!(style, Style::Charge | Style::Full) {
            row.real("charge")?;
        }
        atoms.position.push(row.vector(POSITION)?);
        if with_images {
            atoms.image.get_or_insert_default().push(row.image()?);
        }
        row.end()
    }

    fn velocities(&mut self) -> Result<()> {
        let Some(atoms) = &self.atoms else {
            return Err(self.fail(Problem::expected("the Atoms section before Velocities", self.lines.line())));
        };
        let mut velocity = Vec3s::zeros(atoms.id.len());
        let mut seen = vec![false; atoms.id.len()];
        for found in 0..self.n_atoms {
            self.advance_to_entry("velocities", self.n_atoms, found)?;
            let line = without_comment(self.lines.line());
            let atoms = self.atoms.as_ref().expect("checked above");
            let (particle, value) = parse_velocity(line, found, atoms).map_err(|problem| self.fail(problem))?;
            if std::mem::replace(&mut seen[particle], true) {
                return Err(self.fail(Problem::DuplicateId { id: atoms.id[particle] }));
            }
            velocity.set(particle, value);
        }
        self.velocity = Some(velocity);
        self.end_section("velocities", self.n_atoms)
    }

    fn finish(self, header: Header) -> Configuration {
        let atoms = self.atoms.unwrap_or_default();
        Configuration {
            position: atoms.position,
            velocity: self.velocity,
            species: Species { names: self.names, of: atoms.kind },
            mass: self.masses,
            image: atoms.image,
            id: Some(atoms.id),
            bounds: Some(header.bounds),
            step: step(&header.title),
            comment: (!header.title.is_empty()).then_some(header.title),
            ..Configuration::default()
        }
    }
}

impl Atoms {
    fn make_index(&mut self) -> Parsed<()> {
        self.index = self.id.iter().zip(0..).map(|(&id, i)| (id, i)).collect();
        self.index.sort_unstable();
        match self.index.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            Some(pair) => Err(Problem::DuplicateId { id: pair[0].0 }),
            None => Ok(()),
        }
    }

    /// Index of the atom with this id; atom `guess` has it if both sections have the same order.
    fn find(&self, id: u64, guess: usize) -> Option<usize> {
        if self.id[guess] == id {
            return Some(guess);
        }
        let at = self.index.binary_search_by_key(&id, |entry| entry.0).ok()?;
        Some(self.index[at].1 as usize)
    }
}

fn parse_velocity(line: &str, entry: usize, atoms: &Atoms) -> Parsed<(usize, [f32; 3])> {
    let id = line.split_ascii_whitespace().next().unwrap_or_default();
    let number = id.parse().map_err(|_| number::not_a_number(id, "id of a velocity", entry))?;
    let particle = atoms.find(number, entry).ok_or_else(|| Problem::expected("the id of an atom", id))?;
    let mut row = Row::new(line, particle, (4, "id vx vy vz"));
    row.skip(1)?;
    let velocity = row.vector(VELOCITY)?;
    row.end()?;
    Ok((particle, velocity))
}

/// `write_data` puts `timestep = N` into the title.
fn step(title: &str) -> Option<u64> {
    let (_, after) = title.split_once("timestep = ")?;
    after.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
}
