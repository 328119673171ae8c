//! Tables of a report.

/// A table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Table {
    pub caption: String,
    pub header: Vec<String>,
    pub rows: Vec<Vec<Cell>>,
}

/// A cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Cell {
    pub text: String,
    /// The best of its row.
    pub is_best: bool,
    /// More, shown when pointed at.
    pub hint: String,
}

impl Cell {
    pub fn text(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    pub fn number(value: f64) -> Self {
        Self::text(number(value))
    }
}

/// Marks the least of the cells that hold a value.
pub(super) fn mark_least(cells: &mut [(Option<f64>, Cell)]) {
    let least = cells.iter().filter_map(|(value, _)| *value).fold(f64::INFINITY, f64::min);
    for (value, cell) in cells {
        cell.is_best = *value == Some(least);
    }
}

/// Three significant digits.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    match size {
        0.0 => "0".into(),
        _ if !size.is_finite() => "-".into(),
        _ if !(1e-3..1e7).contains(&size) => format!("{value:.2e}"),
        _ if size >= 99.95 => format!("{value:.0}"),
        _ => {
            let digits = 2 - size.log10().floor() as i32;
            format!("{value:.*}", digits.max(0) as usize)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let texts = [0.0, 0.00123, 0.5, 1.0, 12.34, 123.4, 12_345.0, 1.7e9].map(number);
        assert_eq!(texts, ["0", "0.00123", "0.500", "1.00", "12.3", "123", "12345", "1.70e9"]);
    }
}
