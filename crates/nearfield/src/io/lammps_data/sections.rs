//! Names of sections.

use super::header::without_comment;

/// Sections that are read.
pub(super) const MASSES: &str = "Masses";
pub(super) const LABELS: &str = "Atom Type Labels";
pub(super) const ATOMS: &str = "Atoms";
pub(super) const VELOCITIES: &str = "Velocities";

/// Sections that are known and passed over.
const OTHER: [&str; 26] = [
    "Pair Coeffs",
    "PairIJ Coeffs",
    "Bond Coeffs",
    "Angle Coeffs",
    "Dihedral Coeffs",
    "Improper Coeffs",
    "BondBond Coeffs",
    "BondAngle Coeffs",
    "MiddleBondTorsion Coeffs",
    "EndBondTorsion Coeffs",
    "AngleTorsion Coeffs",
    "AngleAngleTorsion Coeffs",
    "BondBond13 Coeffs",
    "AngleAngle Coeffs",
    "Bond Type Labels",
    "Angle Type Labels",
    "Dihedral Type Labels",
    "Improper Type Labels",
    "Bonds",
    "Angles",
    "Dihedrals",
    "Impropers",
    "Ellipsoids",
    "Lines",
    "Triangles",
    "Bodies",
];

/// The name of the section that begins with this line, if one does.
pub(super) fn section_name(line: &str) -> Option<&'static str> {
    let text = without_comment(line);
    // Section names start with a letter, almost all lines of a section with a number.
    if !text.starts_with(|c: char| c.is_ascii_uppercase()) {
        return None;
    }
    [MASSES, LABELS, ATOMS, VELOCITIES].into_iter().chain(OTHER).find(|&name| name == text)
}
