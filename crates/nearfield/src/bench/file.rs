//! Files of results: one record a line.

use super::{Record, Suite};
use crate::{
    Error, Result,
    io::{AppendFile, IoError},
};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Where a suite's results are.
pub fn results_file(directory: &Path, suite: Suite) -> PathBuf {
    directory.join(format!("{suite}.jsonl"))
}

/// The records of a file; a last line that was cut short by a kill is left out.
///
/// # Errors
/// [`IoError`] when it cannot be read, [`Error::Results`] for a line that is no record.
pub fn read_records(path: &Path) -> Result<Vec<Record>> {
    let text = fs::read_to_string(path).map_err(|source| IoError::Open { path: path.to_owned(), source })?;
    let whole = &text[..text.rfind('\n').map_or(0, |end| end + 1)];
    let parse = |(k, line): (usize, &str)| {
        let wrong = |reason: serde_json::Error| Error::Results {
            path: path.to_owned(),
            line: k + 1,
            reason: reason.to_string(),
        };
        serde_json::from_str(line).map_err(wrong)
    };
    whole.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).map(parse).collect()
}

/// A growing file of results.
pub(super) struct ResultsFile {
    file: AppendFile,
    pub records: Vec<Record>,
}

impl ResultsFile {
    /// Opens or makes it. Records for which `keep` is false are dropped from it.
    pub fn open(directory: &Path, suite: Suite, keep: impl Fn(&Record) -> bool) -> Result<Self> {
        let path = results_file(directory, suite);
        fs::create_dir_all(directory).map_err(|source| IoError::Write { path: directory.to_owned(), source })?;
        let mut records = if path.exists() { read_records(&path)? } else { Vec::new() };
        records.retain(keep);
        let text: String = records.iter().map(line).collect();
        // Also takes off a line that was cut short.
        crate::io::atomic_write(&path, |out| out.write_all(text.as_bytes()))?;
        Ok(Self { file: AppendFile::open_at(&path, text.len() as u64)?, records })
    }

    pub fn add(&mut self, record: Record) -> Result<()> {
        self.file.append(line(&record).as_bytes())?;
        self.records.push(record);
        Ok(())
    }
}

fn line(record: &Record) -> String {
    serde_json::to_string(record).expect("a record can be encoded") + "\n"
}
