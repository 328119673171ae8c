//! The `Properties` key: which columns a particle's line has.

use crate::io::{Problem, error::Parsed};

/// One property of a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Column {
    Species,
    Position,
    Velocity,
    Force,
    Mass,
    Radius,
    Image,
    Id,
    /// So many fields that mean nothing here.
    Other(usize),
}

/// The properties of a line in order.
#[derive(Debug, PartialEq)]
pub(super) struct Columns {
    pub(super) list: Vec<Column>,
    /// Number of fields.
    pub(super) width: usize,
    /// The text of `Properties`, for messages.
    pub(super) layout: String,
    /// A line may have more fields: without `Properties` nothing says that it has not.
    pub(super) open_ended: bool,
}

impl Default for Columns {
    /// Plain XYZ.
    fn default() -> Self {
        Self {
            list: vec![Column::Species, Column::Position],
            width: 4,
            layout: "species:S:1:pos:R:3".into(),
            open_ended: true,
        }
    }
}

impl Columns {
    /// Parses `name:type:count[:name:type:count]...`. Other names in common use are understood.
    pub(super) fn parse(text: &str) -> Parsed<Self> {
        let mut columns = Self { list: Vec::new(), width: 0, layout: text.to_owned(), open_ended: false };
        let parts: Vec<&str> = text.split(':').collect();
        for triplet in parts.chunks(3) {
            let (name, kind, count) = match *triplet {
                [name, kind, count] => (name, kind, count.parse::<usize>().unwrap_or(0)),
                _ => (triplet[0], "", 0),
            };
            if !matches!(kind, "S" | "R" | "I" | "L") || !(1..=1000).contains(&count) {
                return Err(Problem::expected("Properties made of name:S|R|I|L:count", text));
            }
            let column = columns.recognise(name, kind, count)?;
            columns.list.push(column);
            columns.width += count;
        }
        if !columns.has(Column::Position) {
            return Err(Problem::expected("a property pos:R:3 in Properties", text));
        }
        Ok(columns)
    }

    /// Whether the lines have this property.
    pub(super) fn has(&self, column: Column) -> bool {
        self.list.contains(&column)
    }

    fn recognise(&self, name: &str, kind: &str, count: usize) -> Parsed<Column> {
        let (column, kinds, width) = match name {
            "species" | "type" | "element" => (Column::Species, "SI", 1),
            "pos" => (Column::Position, "RI", 3),
            "velo" | "vel" | "velocity" | "velocities" => (Column::Velocity, "RI", 3),
            "force" | "forces" => (Column::Force, "RI", 3),
            "mass" | "masses" => (Column::Mass, "RI", 1),
            "radius" => (Column::Radius, "RI", 1),
            "map_shift" => (Column::Image, "I", 3),
            "id" => (Column::Id, "I", 1),
            _ => return Ok(Column::Other(count)),
        };
        if self.has(column) {
            return Ok(Column::Other(count));
        }
        if !kinds.contains(kind) || count != width {
            let first = &kinds[..1];
            return Err(Problem::expected(format!("{name}:{first}:{width}"), &format!("{name}:{kind}:{count}")));
        }
        Ok(column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_names_become_columns_and_others_are_passed_over() {
        let columns = Columns::parse("id:I:1:species:S:1:pos:R:3:magmom:R:2:type:I:1").unwrap();
        assert_eq!(columns.list, [Column::Id, Column::Species, Column::Position, Column::Other(2), Column::Other(1)]);
        assert_eq!(columns.width, 8);
    }

    #[test]
    fn malformed_properties_are_refused() {
        for text in [
            "pos",
            "pos:R",
            "pos:R:x",
            "pos:Q:3",
            "pos:R:2",
            "pos:S:3",
            "species:S:1",
            "pos:R:3:id:R:1",
            "pos:R:3:a:R:0",
        ] {
            assert!(matches!(Columns::parse(text), Err(Problem::Expected { .. })), "{text}");
        }
    }
}
