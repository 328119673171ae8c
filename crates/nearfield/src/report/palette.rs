//! Colours that people with the common kinds of colour blindness tell apart (Okabe and Ito, 2008), with a marker each so
//! that nothing depends on colour alone.

use nearfield_core::Method;

/// Red, green, blue.
pub(super) type Rgb = (u8, u8, u8);

/// Shape of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross,
}

/// How a series looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Look {
    pub color: Rgb,
    pub marker: Marker,
}

pub(super) const INK: Rgb = (0, 0, 0);
pub(super) const PAPER: Rgb = (255, 255, 255);
pub(super) const GRID: Rgb = (222, 222, 222);
pub(super) const SHADE: Rgb = (235, 235, 235);

const LOOKS: [Look; 9] = [
    Look { color: (120, 120, 120), marker: Marker::Cross },
    Look { color: (0, 114, 178), marker: Marker::Circle },
    Look { color: (213, 94, 0), marker: Marker::Square },
    Look { color: (0, 158, 115), marker: Marker::Triangle },
    Look { color: (204, 121, 167), marker: Marker::Diamond },
    Look { color: (230, 159, 0), marker: Marker::Circle },
    Look { color: (86, 180, 233), marker: Marker::Square },
    Look { color: (145, 80, 40), marker: Marker::Triangle },
    Look { color: (190, 175, 0), marker: Marker::Diamond },
];

/// The look of the k-th series.
pub(super) fn look(k: usize) -> Look {
    LOOKS[k % LOOKS.len()]
}

/// The look of a method, the same in all figures.
pub(super) fn of_method(method: Method) -> Look {
    look(Method::ALL.iter().position(|&other| other == method).unwrap_or_default())
}
