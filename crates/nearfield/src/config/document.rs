//! The TOML document before typing: where each key stands, overrides, and the translation of errors.

use super::{Error, Origin, Result, schema};
use serde::de::DeserializeOwned;
use serde_path_to_error::Segment;
use toml::{
    Spanned, Table, Value,
    de::{DeTable, DeValue},
};

/// A parsed document with its overrides applied.
pub(super) struct Document<'a> {
    text: &'a str,
    /// The tree as written, with the place of each key.
    written: Spanned<DeTable<'a>>,
    /// The tree with overrides.
    table: Table,
    /// Dotted keys set by options, and the options.
    set: Vec<(String, String)>,
}

impl<'a> Document<'a> {
    pub(super) fn parse(text: &'a str) -> Result<Self> {
        let syntax = |error: toml::de::Error| Error::Syntax {
            at: error.span().map_or(Origin::Unknown, |span| Origin::Line(line_of(text, span.start))),
            message: error.message().to_owned(),
        };
        let written = DeTable::parse(text).map_err(syntax)?;
        let table = text.parse().map_err(syntax)?;
        Ok(Self { text, written, table, set: Vec::new() })
    }

    /// Applies `KEY=VALUE`.
    pub(super) fn set(&mut self, option: &str) -> Result<()> {
        let not_key_value = || Error::NotKeyValue(option.to_owned());
        let (key, value) = option.split_once('=').ok_or_else(not_key_value)?;
        let (key, value) = (key.trim(), parse_value(value.trim(), option)?);
        let mut segments: Vec<&str> = key.split('.').collect();
        let last = segments.pop().filter(|last| !last.is_empty()).ok_or_else(not_key_value)?;
        self.set.push((key.to_owned(), option.to_owned()));

        let mut table = &mut self.table;
        let mut segments = segments.into_iter().peekable();
        while let Some(segment) = segments.next() {
            let index = segments.next_if(|next| next.parse::<usize>().is_ok()).and_then(|next| next.parse().ok());
            let empty = || if index.is_some() { Value::Array(Vec::new()) } else { Value::Table(Table::new()) };
            table = descend(table.entry(segment).or_insert_with(empty), index).ok_or_else(|| Error::Syntax {
                at: Origin::Option(option.to_owned()),
                message: match index {
                    Some(index) => format!("there is no entry {index} of \"{segment}\"; they are numbered from 0"),
                    None => format!("\"{segment}\" is not a section"),
                },
            })?;
        }
        table.insert(last.to_owned(), value);
        Ok(())
    }

    /// Reads the tree into a type after checking its keys.
    pub(super) fn read<T: DeserializeOwned>(&self) -> Result<T> {
        schema::check_keys(&self.table).map_err(|wrong| wrong.into_error(|key| self.origin(key)))?;
        serde_path_to_error::deserialize(Value::Table(self.table.clone())).map_err(|error| {
            let mut key = String::new();
            for segment in error.path() {
                let name = match segment {
                    Segment::Map { key } => key.clone(),
                    Segment::Seq { index } => index.to_string(),
                    Segment::Enum { .. } | Segment::Unknown => break,
                };
                key = if key.is_empty() { name } else { format!("{key}.{name}") };
                // An element of an array value is reported as the whole value: that is what the schema knows.
                if schema::find(&key).is_some() {
                    break;
                }
            }
            let value = self.value(&key).map_or_else(String::new, |value| value.to_string());
            let reason = schema::find(&key).map_or_else(|| error.inner().to_string(), |known| known.refusal(&value));
            Error::InvalidValue { at: self.origin(&key), key, value, reason }
        })
    }

    /// The value of a dotted key.
    fn value(&self, key: &str) -> Option<&Value> {
        let mut segments = key.split('.');
        let first = self.table.get(segments.next()?)?;
        segments.try_fold(first, |value, segment| match value {
            Value::Array(entries) => entries.get(segment.parse::<usize>().ok()?),
            other => other.get(segment),
        })
    }

    /// Where the value of a dotted key comes from: the last option that set it or a table around it, else the
    /// deepest written key on the way to it.
    pub(super) fn origin(&self, key: &str) -> Origin {
        let within = |outer: &str, inner: &str| {
            inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let option = |decides: &dyn Fn(&str) -> bool| {
            self.set.iter().rev().find(|(set, _)| decides(set)).map(|(_, option)| Origin::Option(option.clone()))
        };
        if let Some(origin) = option(&|set| within(set, key)) {
            return origin;
        }
        let mut start = None;
        let mut at: Option<&DeValue> = None;
        for segment in key.split('.') {
            let table = match at {
                None => Some(self.written.get_ref()),
                Some(DeValue::Table(table)) => Some(table),
                _ => None,
            };
            if let Some((key, value)) = table.and_then(|table| table.get_key_value(segment)) {
                start = Some(key.span().start);
                at = Some(value.get_ref());
            } else if let Some(DeValue::Array(entries)) = at
                && let Some(entry) = segment.parse().ok().and_then(|index: usize| entries.get(index))
            {
                start = Some(entry.span().start);
                at = Some(entry.get_ref());
            } else {
                break;
            }
        }
        match start {
            Some(start) => Origin::Line(line_of(self.text, start)),
            // A section that exists only because an option set something in it.
            None => option(&|set| within(key, set)).unwrap_or(Origin::Unknown),
        }
    }
}

/// The table in a value: the value itself, or its entry `index`, one past the last being added.
fn descend(value: &mut Value, index: Option<usize>) -> Option<&mut Table> {
    match (value, index) {
        (Value::Table(table), None) => Some(table),
        (Value::Array(entries), Some(index)) => {
            if index == entries.len() {
                entries.push(Value::Table(Table::new()));
            }
            entries.get_mut(index)?.as_table_mut()
        }
        _ => None,
    }
}

/// A value as TOML, or else as a bare word. What begins like a string, array or table must be one.
fn parse_value(value: &str, option: &str) -> Result<Value> {
    let parsed = format!("value = {value}").parse::<Table>().ok().and_then(|mut table| table.remove("value"));
    match parsed {
        Some(Value::Datetime(_)) => Ok(Value::String(value.to_owned())),
        Some(parsed) => Ok(parsed),
        None if value.starts_with(['"', '\'', '[', '{']) => Err(Error::Syntax {
            at: Origin::Option(option.to_owned()),
            message: format!("{value} is not a TOML value"),
        }),
        None => Ok(Value::String(value.to_owned())),
    }
}

/// Line of a byte, from 1.
fn line_of(text: &str, byte: usize) -> usize {
    1 + text.as_bytes()[..byte.min(text.len())].iter().filter(|&&b| b == b'\n').count()
}
