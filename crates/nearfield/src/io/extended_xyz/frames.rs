//! Reading frames one by one.

use super::columns::{Column, Columns};
use super::comment::Comment;
use crate::io::{
    Configuration, IoError, Problem, Result,
    configuration::SpeciesCollector,
    error::Parsed,
    line_reader::LineReader,
    row::{FORCE, POSITION, Row, VELOCITY},
};
use std::{fs::File, io::BufRead, io::BufReader, path::Path};

/// The frames of an extended XYZ file, read as they are asked for: memory is needed for one at a time.
///
/// ```
/// use nearfield::io::Frames;
/// let text = "1\nfirst\nAr 0 0 0\n1\nsecond\nAr 0 0 0.5\n";
/// let frames: Vec<_> = Frames::new(text.as_bytes(), "text").collect::<Result<_, _>>()?;
/// assert_eq!(frames[1].position.get(0), [0.0, 0.0, 0.5]);
/// # Ok::<(), nearfield::io::IoError>(())
/// ```
pub struct Frames<R> {
    lines: LineReader<R>,
    /// Number of frames read or passed over.
    count: usize,
    failed: bool,
}

impl Frames<BufReader<File>> {
    /// The frames of a file.
    ///
    /// # Errors
    /// [`IoError::Open`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let file = File::open(path).map_err(|source| IoError::Open { path: path.to_owned(), source })?;
        Ok(Self::new(BufReader::with_capacity(1 << 18, file), path.display().to_string()))
    }
}

impl<R: BufRead> Frames<R> {
    /// The frames of any text; `name` stands for it in errors.
    pub fn new(input: R, name: impl Into<String>) -> Self {
        Self { lines: LineReader::new(input, name, 0), count: 0, failed: false }
    }

    /// The next frame, or `None` at the end.
    ///
    /// # Errors
    /// [`IoError::Parse`] naming the line, [`IoError::Read`], and [`IoError::Empty`] when there is not even one frame.
    pub fn next_frame(&mut self) -> Result<Option<Configuration>> {
        let Some(n) = self.next_count()? else { return Ok(None) };
        let comment = self.read_comment(n)?;
        let frame = self.read_particles(n, comment)?;
        self.count += 1;
        Ok(Some(frame))
    }

    /// Frame `index`, counted from 0; the ones before are passed over without parsing their particles.
    ///
    /// # Errors
    /// As [`Frames::next_frame`], and [`IoError::NoSuchFrame`].
    pub fn frame(mut self, index: usize) -> Result<Configuration> {
        let mut text = String::new();
        while self.count < index {
            if self.next_raw(&mut text)?.is_none() {
                break;
            }
        }
        match self.next_frame()? {
            Some(frame) => {
                // Another frame or the end must follow, or else the count was too small.
                self.next_count()?;
                Ok(frame)
            }
            None => Err(IoError::NoSuchFrame { file: self.lines.file().to_owned(), frame: index, found: self.count }),
        }
    }

    /// The last frame; the ones before are passed over without parsing their particles.
    ///
    /// # Errors
    /// As [`Frames::next_frame`].
    pub fn last_frame(mut self) -> Result<Configuration> {
        let (mut text, mut last) = (String::new(), String::new());
        let mut lines_before = 0;
        while let Some(before) = self.next_raw(&mut text)? {
            lines_before = before;
            std::mem::swap(&mut text, &mut last);
        }
        let mut frame = Self::at(&last, self.lines.file(), lines_before);
        frame.next_frame()?.ok_or_else(|| self.lines.empty())
    }

    /// The frames of `text`, which follows `lines_before` lines of the file.
    fn at<'a>(text: &'a str, file: &str, lines_before: usize) -> Frames<&'a [u8]> {
        Frames { lines: LineReader::new(text.as_bytes(), file, lines_before), count: 0, failed: false }
    }

    /// Copies the next frame's lines and gives the number of lines before it.
    fn next_raw(&mut self, text: &mut String) -> Result<Option<usize>> {
        let Some(n) = self.next_count()? else { return Ok(None) };
        let lines_before = self.lines.number() - 1;
        text.clear();
        self.copy_line(text);
        for found in 0..=n {
            if !self.lines.advance()? {
                return Err(self.too_few(n, found.saturating_sub(1)));
            }
            self.copy_line(text);
        }
        self.count += 1;
        Ok(Some(lines_before))
    }

    fn copy_line(&self, text: &mut String) {
        text.push_str(self.lines.line());
        text.push('\n');
    }

    /// The number of particles, with which a frame begins.
    fn next_count(&mut self) -> Result<Option<usize>> {
        if !self.lines.advance_to_text()? {
            return if self.count == 0 { Err(self.lines.empty()) } else { Ok(None) };
        }
        let line = self.lines.line();
        let wanted = || match self.count {
            0 => "the number of atoms".to_owned(),
            _ => "the number of atoms of the next frame, or the end of the file".to_owned(),
        };
        let count = line.trim().parse().map_err(|_| self.lines.fail(Problem::expected(wanted(), line)))?;
        Ok(Some(count))
    }

    fn read_comment(&mut self, n: usize) -> Result<Comment> {
        if !self.lines.advance()? {
            return Err(self.too_few(n, 0));
        }
        Comment::parse(self.lines.line()).map_err(|problem| self.lines.fail(problem))
    }

    fn read_particles(&mut self, n: usize, comment: Comment) -> Result<Configuration> {
        let mut particles = Particles::default();
        for particle in 0..n {
            if !self.lines.advance()? {
                return Err(self.too_few(n, particle));
            }
            particles.push(self.lines.line(), &comment.columns).map_err(|problem| self.lines.fail(problem))?;
        }
        Ok(particles.finish(comment))
    }

    fn too_few(&self, expected: usize, found: usize) -> IoError {
        self.lines.fail(Problem::TooFew { what: "atoms", expected, found })
    }
}

impl<R: BufRead> Iterator for Frames<R> {
    type Item = Result<Configuration>;

    /// The next frame; after an error there is no other.
    fn next(&mut self) -> Option<Self::Item> {
        if self.failed {
            return None;
        }
        let frame = self.next_frame().transpose();
        self.failed = matches!(frame, Some(Err(_)));
        frame
    }
}

/// The particles of a frame as they come.
#[derive(Default)]
struct Particles {
    configuration: Configuration,
    species: SpeciesCollector,
}

impl Particles {
    fn push(&mut self, line: &str, columns: &Columns) -> Parsed<()> {
        let particle = self.configuration.len();
        let mut row = Row::new(line, particle, (columns.width, &columns.layout));
        let (mut species, mut mass) = ("X", None);
        let into = &mut self.configuration;
        for column in &columns.list {
            match column {
                Column::Species => species = row.text()?,
                Column::Position => into.position.push(row.vector(POSITION)?),
                Column::Velocity => into.velocity.get_or_insert_default().push(row.vector(VELOCITY)?),
                Column::Force => into.force.get_or_insert_default().push(row.vector(FORCE)?),
                Column::Mass => mass = Some(row.real("mass")?),
                Column::Radius => into.radius.get_or_insert_default().push(row.real("radius")?),
                Column::Image => into.image.get_or_insert_default().push(row.image()?),
                Column::Id => into.id.get_or_insert_default().push(row.integer("id")?),
                Column::Other(count) => row.skip(*count)?,
            }
        }
        if !columns.open_ended {
            row.end()?;
        }
        let kind = self.species.push(species) as usize;
        match mass {
            Some(mass) => self.note_mass(particle, species, kind, mass),
            None => Ok(()),
        }
    }

    /// Mass belongs to the species: all its particles must agree.
    fn note_mass(&mut self, particle: usize, species: &str, kind: usize, found: f32) -> Parsed<()> {
        let masses = self.configuration.mass.get_or_insert_default();
        match masses.get(kind) {
            None => masses.push(found),
            Some(&first) if first == found => {}
            Some(&first) => return Err(Problem::MassDiffers { particle, species: species.to_owned(), first, found }),
        }
        Ok(())
    }

    fn finish(self, comment: Comment) -> Configuration {
        Configuration {
            species: self.species.finish(),
            bounds: comment.bounds,
            step: comment.step,
            time: comment.time,
            comment: comment.text,
            ..self.configuration
        }
    }
}
