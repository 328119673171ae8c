//! What a figure shows, apart from how it is drawn.

use super::palette::Look;

/// Panels in rows, with one legend.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Figure {
    /// File name without extension.
    pub id: String,
    /// What is shown, for the caption.
    pub caption: String,
    pub columns: usize,
    pub panels: Vec<Panel>,
}

/// One pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Panel {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    /// A shaded area behind the series, scaled to the height of the panel.
    pub shade: Vec<(f64, f64)>,
}

/// One axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    /// Quantity and unit.
    pub label: String,
    pub log: bool,
    /// Names instead of numbers, at 0, 1, 2, ...
    pub names: Vec<String>,
}

impl Axis {
    pub fn linear(label: &str) -> Self {
        Self { label: label.into(), log: false, names: Vec::new() }
    }

    pub fn log(label: &str) -> Self {
        Self { log: true, ..Self::linear(label) }
    }

    pub fn names(names: Vec<String>) -> Self {
        Self { names, ..Self::linear("") }
    }
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Series {
    /// For the legend; series of the same name share an entry.
    pub name: String,
    pub look: Look,
    pub style: Style,
    pub points: Vec<(f64, f64)>,
    /// Points that get a marker; all where `None`.
    pub marked: Option<Vec<(f64, f64)>>,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Style {
    Line,
    Dashed,
    /// Hollow markers without a line: a paper's values.
    Hollow,
    /// Filled markers without a line.
    Points,
    /// A bar from the axis, at a name.
    Bar,
}

impl Figure {
    /// Size in pixels of its first size.
    pub fn size(&self) -> (u32, u32) {
        let columns = self.columns.max(1);
        let rows = self.panels.len().div_ceil(columns);
        let (width, height) = match columns {
            1 => (760, 420),
            2 => (520, 340),
            3 => (390, 290),
            _ => (320, 250),
        };
        (width * columns as u32, height * rows as u32 + super::draw::LEGEND_HEIGHT * self.legend_rows())
    }

    /// Entries of the legend, each once.
    pub fn legend(&self) -> Vec<&Series> {
        let mut entries: Vec<&Series> = Vec::new();
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            if !series.name.is_empty() && entries.iter().all(|known| known.name != series.name) {
                entries.push(series);
            }
        }
        entries
    }

    pub fn legend_rows(&self) -> u32 {
        let letters: usize = self.legend().iter().map(|entry| entry.name.chars().count() + 8).sum();
        let width = 1.0 + letters as f64 * 7.5;
        let columns = self.columns.max(1) as f64;
        let available = match self.columns {
            0 | 1 => 760.0,
            2 => 520.0,
            3 => 390.0,
            _ => 320.0,
        } * columns;
        (width / available).ceil() as u32
    }

    /// Whether there is anything to see.
    pub fn is_empty(&self) -> bool {
        self.panels.iter().all(|panel| panel.series.iter().all(|series| series.points.is_empty()))
    }
}
