//! The whole configuration as a commented file.

use super::{
    Config, Result,
    schema::{Accepts, Key, ROOT, Section},
};
use crate::generate::{Generate, RadiiSpec};
use std::fmt::Write;
use toml::{Table, Value};

/// Column of the comments.
const COMMENT: usize = 40;

impl Config {
    /// Every key with its value and a comment, as TOML that [`Config::parse`] reads back to an equal configuration.
    /// What is absent and has no default is commented out.
    ///
    /// # Errors
    /// [`super::Error::NotToml`] when a program put in what TOML cannot hold: a path that is not UTF-8, a seed of 2^63
    /// or more.
    pub fn to_toml(&self) -> Result<String> {
        let mut defaults = Config::default();
        defaults.system.generate = Some(Generate { radii: Some(RadiiSpec::default()), ..Generate::default() });
        let (values, defaults) = (Table::try_from(self)?, Table::try_from(&defaults)?);
        let mut out = String::new();
        for section in ROOT.sections {
            print_section(&mut out, section, "", values.get(section.name), defaults.get(section.name));
        }
        Ok(out)
    }
}

/// Prints a section and those inside it. One that is absent is printed from its defaults, commented out.
fn print_section(out: &mut String, section: &Section, path: &str, value: Option<&Value>, default: Option<&Value>) {
    let path = if path.is_empty() { section.name.to_owned() } else { format!("{path}.{}", section.name) };
    let entries = match value {
        Some(Value::Array(entries)) => entries.iter().map(Some).collect(),
        other => vec![other],
    };
    for value in entries {
        let header = if section.repeated { format!("[[{path}]]") } else { format!("[{path}]") };
        let hidden = if value.is_none() { "# " } else { "" };
        if !out.is_empty() {
            out.push('\n');
        }
        let _ = writeln!(out, "{:COMMENT$}# {}", format!("{hidden}{header}"), section.about);
        for key in section.keys {
            print_key(out, key, value.and_then(|v| v.get(key.name)), default.and_then(|v| v.get(key.name)), hidden);
        }
        for inner in section.sections {
            let of = |tree: Option<&Value>| tree.and_then(|tree| tree.get(inner.name)).cloned();
            print_section(out, inner, &path, of(value).as_ref(), of(default).as_ref());
        }
    }
}

fn print_key(out: &mut String, key: &Key, value: Option<&Value>, default: Option<&Value>, hidden: &str) {
    let shown = match (value, key.example) {
        (Some(value), _) => format!("{} = {value}", key.name),
        (None, Some(example)) => format!("# {} = {example}", key.name),
        (None, None) => format!("{} = {}", key.name, default.map_or_else(String::new, Value::to_string)),
    };
    let choices = match key.accepts {
        Accepts::Names(names) => format!(": {}", names().join(" | ")),
        Accepts::Words(_) => String::new(),
    };
    let hidden = if shown.starts_with('#') { "" } else { hidden };
    let _ = writeln!(out, "{:COMMENT$}# {}{choices}", format!("{hidden}{shown}"), key.about);
}
