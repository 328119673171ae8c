//! What keys exist, what they accept and what they mean, said once: for the check of unknown keys, for the wording
//! of errors, and for the comments of a printed configuration. The serde structs hold the same keys; tests compare.

mod keys;

pub(super) use keys::ROOT;

use super::{Error, Origin};
use toml::{Table, Value};

/// What a key accepts, as words after "expected".
#[derive(Clone, Copy)]
pub(super) enum Accepts {
    /// A description.
    Words(&'static str),
    /// One of these names; `K` and `N` in them stand for numbers.
    Names(fn() -> Vec<&'static str>),
}

/// A key.
pub(super) struct Key {
    pub(super) name: &'static str,
    pub(super) accepts: Accepts,
    pub(super) about: &'static str,
    /// A value to show, in TOML, where there is no default.
    pub(super) example: Option<&'static str>,
}

/// A table of the file.
pub(super) struct Section {
    pub(super) name: &'static str,
    pub(super) about: &'static str,
    /// Whether it is an array of tables.
    pub(super) repeated: bool,
    pub(super) keys: &'static [Key],
    pub(super) sections: &'static [Section],
}

impl Key {
    /// Why `value`, printed as TOML, was refused.
    pub(super) fn refusal(&self, value: &str) -> String {
        match self.accepts {
            Accepts::Words(words) => format!("expected {words}"),
            Accepts::Names(names) => {
                let near = nearest(value.trim_matches('"'), names().into_iter());
                let hint = near.map_or_else(String::new, |near| format!("; did you mean \"{near}\"?"));
                format!("expected {}{hint}", names().join(" | "))
            }
        }
    }
}

/// The key of a dotted path; indices of repeated sections are skipped.
pub(super) fn find(path: &str) -> Option<&'static Key> {
    let mut section = &ROOT;
    let mut segments = path.split('.').filter(|segment| segment.parse::<usize>().is_err()).peekable();
    while let Some(segment) = segments.next() {
        if segments.peek().is_none() {
            return section.keys.iter().find(|key| key.name == segment);
        }
        section = section.sections.iter().find(|section| section.name == segment)?;
    }
    None
}

/// A key that should not be there, or a table that is none.
pub(super) enum Wrong {
    Unknown { path: String, hint: String },
    NotATable { path: String, value: String, expected: String },
}

impl Wrong {
    pub(super) fn into_error(self, origin: impl FnOnce(&str) -> Origin) -> Error {
        match self {
            Self::Unknown { path, hint } => {
                let (section, key) = path.rsplit_once('.').unwrap_or(("", &path));
                Error::UnknownKey { at: origin(&path), key: key.into(), section: without_indices(section), hint }
            }
            Self::NotATable { path, value, expected } => {
                Error::InvalidValue { at: origin(&path), key: path, value, reason: expected }
            }
        }
    }
}

fn without_indices(path: &str) -> String {
    path.split('.').filter(|segment| segment.parse::<usize>().is_err()).collect::<Vec<_>>().join(".")
}

/// Checks that every key of the document is known and every section is a table.
pub(super) fn check_keys(table: &Table) -> Result<(), Wrong> {
    check_section(&ROOT, table, "")
}

fn check_section(section: &Section, table: &Table, path: &str) -> Result<(), Wrong> {
    for (name, value) in table {
        let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        if section.keys.iter().any(|key| key.name == name) {
            continue;
        }
        let Some(inner) = section.sections.iter().find(|inner| inner.name == name) else {
            return Err(Wrong::Unknown { hint: hint(section, name), path });
        };
        match value {
            Value::Table(table) if !inner.repeated => check_section(inner, table, &path)?,
            Value::Array(entries) if inner.repeated && entries.iter().all(Value::is_table) => {
                for (i, entry) in entries.iter().filter_map(Value::as_table).enumerate() {
                    check_section(inner, entry, &format!("{path}.{i}"))?;
                }
            }
            _ => {
                let header = if inner.repeated { format!("[[{path}]]") } else { format!("[{path}]") };
                return Err(Wrong::NotATable {
                    path,
                    value: value.to_string(),
                    expected: format!("expected a section {header}"),
                });
            }
        }
    }
    Ok(())
}

/// What to tell about an unknown key: the nearest known one, else the section it belongs to, else all known ones.
fn hint(section: &Section, name: &str) -> String {
    let known = || section.keys.iter().map(|key| key.name).chain(section.sections.iter().map(|inner| inner.name));
    if let Some(near) = nearest(name, known()) {
        return format!("did you mean \"{near}\"?");
    }
    let mut homes = Vec::new();
    collect_homes(&ROOT, "", name, &mut homes);
    match homes.as_slice() {
        [home] => format!("it belongs to [{home}]"),
        _ => format!("known keys are {}", known().collect::<Vec<_>>().join(", ")),
    }
}

/// Paths of the sections that have a key.
fn collect_homes(section: &Section, path: &str, key: &str, homes: &mut Vec<String>) {
    if section.keys.iter().any(|known| known.name == key) {
        homes.push(path.to_owned());
    }
    for inner in section.sections {
        let path = if path.is_empty() { inner.name.to_owned() } else { format!("{path}.{}", inner.name) };
        collect_homes(inner, &path, key, homes);
    }
}

/// The most similar of the known words, if any is similar. The limit lets through a typing error in a short word and
/// a beginning such as "dir" of "directory".
fn nearest(word: &str, known: impl Iterator<Item = &'static str>) -> Option<&'static str> {
    const SIMILAR: f64 = 0.8;
    known
        .map(|known| (strsim::jaro_winkler(word, known), known))
        .filter(|(similarity, _)| *similarity >= SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, known)| known)
}
