//! Face-centred cubic crystal, the usual start of a Lennard-Jones melt.

use super::{Error, Result, inside};
use nearfield_core::{SimBox, Vec3s};

/// Atoms of the unit cell, in cell edges; the first sits at the lower corner, as in LAMMPS.
const BASIS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];

/// A perfect crystal of `n` atoms filling the box, cells as nearly cubic as whole numbers of them allow.
/// Order: cells with x fastest, the four atoms of a cell together.
///
/// ```
/// use nearfield::generate::fcc;
/// use nearfield_core::{Boundary, SimBox};
/// let sim_box = SimBox::cubic(3.0, Boundary::Periodic)?;
/// assert_eq!(fcc(32, &sim_box)?.get(1), [0.75, 0.75, 0.0]);
/// let error = fcc(33, &sim_box).unwrap_err().to_string();
/// assert!(error.ends_with("the nearest numbers that do are 32 and 108"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
/// # Errors
/// [`Error::ImperfectCrystal`] when `n` is not 4 atoms times whole numbers of such cells (4 m³ in a cube).
pub fn fcc(n: usize, sim_box: &SimBox) -> Result<Vec3s> {
    let lengths = sim_box.lengths().map(f64::from);
    let atoms = |cells: [usize; 3]| 4 * cells.iter().product::<usize>();
    let (mut smaller, mut cells) = (None, [1; 3]);
    let mut shapes = shapes(lengths);
    for shape in shapes.by_ref() {
        cells = shape;
        if atoms(shape) >= n {
            break;
        }
        smaller = Some(atoms(shape));
    }
    if atoms(cells) != n {
        // Nothing is smaller than one cell: name the two smallest.
        let (below, above) = match smaller {
            Some(below) => (below, atoms(cells)),
            None => (atoms(cells), shapes.map(atoms).next().unwrap_or(usize::MAX)),
        };
        return Err(Error::ImperfectCrystal { n, below, above });
    }
    let edge: [f64; 3] = std::array::from_fn(|axis| lengths[axis] / cells[axis] as f64);
    let mut positions = Vec3s::default();
    for z in 0..cells[2] {
        for y in 0..cells[1] {
            for x in 0..cells[0] {
                let cell = [x as f64, y as f64, z as f64];
                for atom in BASIS {
                    positions.push(std::array::from_fn(|axis| {
                        let offset = (cell[axis] + atom[axis]) * edge[axis];
                        inside(sim_box, axis, f64::from(sim_box.lo()[axis]) + offset)
                    }));
                }
            }
        }
    }
    Ok(positions)
}

/// Cells per axis for ever smaller cubic cells, without end. Each count is the nearest whole number, so the next shape
/// comes where an axis reaches a half.
fn shapes(lengths: [f64; 3]) -> impl Iterator<Item = [usize; 3]> {
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    let mut scale = 1.0 / longest;
    std::iter::from_fn(move || {
        let cells: [usize; 3] = std::array::from_fn(|axis| ((lengths[axis] * scale).round() as usize).max(1));
        let next = (0..3).map(|axis| (cells[axis] as f64 + 0.5) / lengths[axis]).fold(f64::INFINITY, f64::min);
        // A hair further, so that axes of equal length step together in spite of rounding.
        scale = next * (1.0 + 1e-9);
        Some(cells)
    })
}
