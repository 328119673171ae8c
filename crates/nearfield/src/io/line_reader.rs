//! Lines with their numbers, through one reused buffer.

use super::{IoError, Problem, Result};
use std::io::{BufRead, ErrorKind};

/// Reads a text line by line and turns a [`Problem`] into an error that names the place.
pub(super) struct LineReader<R> {
    input: R,
    file: String,
    /// Number of the current line, from 1; 0 before the first.
    number: usize,
    line: String,
    /// The current line is to be given again.
    held: bool,
}

impl<R: BufRead> LineReader<R> {
    /// `file` names the input in errors; `number` lines have been read before.
    pub(super) fn new(input: R, file: impl Into<String>, number: usize) -> Self {
        Self { input, file: file.into(), number, line: String::new(), held: false }
    }

    /// Moves to the next line; `false` at the end.
    pub(super) fn advance(&mut self) -> Result<bool> {
        if std::mem::take(&mut self.held) {
            return Ok(true);
        }
        self.line.clear();
        self.number += 1;
        match self.input.read_line(&mut self.line) {
            Ok(0) => {
                self.number -= 1;
                Ok(false)
            }
            Ok(_) => Ok(true),
            Err(e) if e.kind() == ErrorKind::InvalidData => Err(self.fail(Problem::NotText)),
            Err(source) => Err(IoError::Read { file: self.file.clone(), source }),
        }
    }

    /// Moves to the next line that is more than white space; `false` at the end.
    pub(super) fn advance_to_text(&mut self) -> Result<bool> {
        while self.advance()? {
            if !self.line.trim().is_empty() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The current line, without its line ending.
    pub(super) fn line(&self) -> &str {
        self.line.trim_end_matches(['\n', '\r'])
    }

    /// Number of the current line, from 1.
    pub(super) fn number(&self) -> usize {
        self.number
    }

    /// Name of the input.
    pub(super) fn file(&self) -> &str {
        &self.file
    }

    /// The next `advance` gives the current line again.
    pub(super) fn hold(&mut self) {
        self.held = true;
    }

    /// An error at the current line.
    pub(super) fn fail(&self, problem: Problem) -> IoError {
        IoError::Parse { file: self.file.clone(), line: self.number, problem }
    }

    /// The input ended before anything came.
    pub(super) fn empty(&self) -> IoError {
        IoError::Empty { file: self.file.clone() }
    }

    /// Fails unless nothing but blank lines follows the `expected` entries.
    pub(super) fn end(&mut self, what: &'static str, expected: usize) -> Result<()> {
        if self.advance_to_text()? {
            let text = self.line().to_owned();
            return Err(self.fail(Problem::Trailing { what, expected, text }));
        }
        Ok(())
    }
}
