//! Results of one or more machines.

use crate::{
    Error, Result,
    bench::{Measurement, Outcome, Record, Suite, read_records},
    io::IoError,
};
use nearfield_core::Method;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// All records that were found.
#[derive(Clone, Debug, Default)]
pub(super) struct Results {
    pub records: Vec<Record>,
}

impl Results {
    /// Reads `*.jsonl` in a directory and in the folders directly below it.
    pub fn read(directory: &Path) -> Result<Self> {
        let mut files = entries(directory)?;
        for folder in files.clone().iter().filter(|path| path.is_dir()) {
            files.extend(entries(folder)?);
        }
        files.retain(|path| path.extension().is_some_and(|extension| extension == "jsonl"));
        let mut records = Vec::new();
        for file in files {
            records.extend(read_records(&file)?);
        }
        if records.is_empty() {
            return Err(Error::NoResults { directory: directory.to_owned() });
        }
        Ok(Self { records })
    }

    /// What is shown of a suite: of a device that has full results, its quick ones are left out.
    pub fn of(&self, suite: Suite) -> Vec<&Record> {
        let of_suite = || self.records.iter().filter(move |record| record.suite == suite);
        let has_full = |device: &str| of_suite().any(|record| !record.quick && record.device_name == device);
        of_suite().filter(|record| !record.quick || !has_full(&record.device_name)).collect()
    }
}

fn entries(directory: &Path) -> Result<Vec<PathBuf>> {
    let failed = |source| IoError::Open { path: directory.to_owned(), source };
    let mut paths = Vec::new();
    for entry in fs::read_dir(directory).map_err(failed)? {
        paths.push(entry.map_err(failed)?.path());
    }
    paths.sort();
    Ok(paths)
}

/// The numbers of a measurement that was made.
pub(super) fn measured(record: &Record) -> Option<&Measurement> {
    match &record.outcome {
        Outcome::Measured(measurement) => Some(measurement),
        _ => None,
    }
}

/// The different values of a property, in order of appearance.
pub(super) fn distinct<'a, T: PartialEq>(records: &[&'a Record], property: impl Fn(&'a Record) -> T) -> Vec<T> {
    let mut values = Vec::new();
    for record in records {
        let value = property(record);
        if !values.contains(&value) {
            values.push(value);
        }
    }
    values
}

/// Names of the devices.
pub(super) fn devices<'a>(records: &[&'a Record]) -> Vec<&'a str> {
    distinct(records, |record| record.device_name.as_str())
}

/// The methods, in their usual order.
pub(super) fn methods(records: &[&Record]) -> Vec<Method> {
    let has = |method: Method| records.iter().any(|record| record.plan.method == method);
    Method::ALL.iter().copied().filter(|&method| has(method)).collect()
}

/// Numbers of particles, ascending.
pub(super) fn sizes(records: &[&Record]) -> Vec<usize> {
    let mut sizes = distinct(records, |record| record.n);
    sizes.sort_unstable();
    sizes
}

/// Why there is no number.
pub(super) fn why_not(outcome: &Outcome) -> (&'static str, String) {
    match outcome {
        Outcome::Measured(_) => ("", String::new()),
        Outcome::Unsupported { reason } => ("–", reason.clone()),
        Outcome::OutOfMemory { reason } => ("memory", reason.clone()),
        Outcome::TooSlow { predicted_seconds, .. } => ("slow", format!("it would take about {predicted_seconds:.0} s")),
        Outcome::Mismatch { pairs, expected } => ("WRONG", format!("{pairs} pairs instead of {expected}")),
        Outcome::Failed { reason } => ("failed", reason.clone()),
    }
}

/// A device's name as part of a file's.
pub(super) fn slug(name: &str) -> String {
    let letters = name.to_lowercase().replace(|c: char| !c.is_ascii_alphanumeric(), "-");
    letters.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}
