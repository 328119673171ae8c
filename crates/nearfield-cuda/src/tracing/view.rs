//! How rays see periodic images.

use super::Scene;
use nearfield_core::{Images, SimBox, predicate::conservative_range};

/// What [`nearfield_kernels::layouts::Rays`] calls `view`.
pub(super) fn number(images: Images) -> u32 {
    match images {
        Images::Gamma => 0,
        Images::Instances => 1,
        Images::Ghosts => 2,
    }
}

/// The number by which kernels know an image.
pub(super) fn code(image: [i8; 3]) -> u8 {
    let [x, y, z] = image.map(|k| (k + 1) as u8);
    x + 3 * y + 9 * z
}

/// Codes of all images of a box, which comes first itself, and their number.
pub(super) fn codes(sim_box: &SimBox) -> ([u8; 32], u32) {
    let (images, mut codes) = (sim_box.images(), [0; 32]);
    for (slot, &image) in codes.iter_mut().zip(&images) {
        *slot = code(image);
    }
    (codes, images.len() as u32)
}

/// Coordinates from which on gamma rays go to images -1 and +1: as far from the faces as the largest radius reaches
/// (paper A, section 3.3), because a large particle across a face may hold a ray whose own radius does not reach it.
pub(super) fn near_faces(scene: &Scene) -> ([f32; 3], [f32; 3]) {
    let reach = conservative_range(scene.reach(), 0.0) + rounding(scene);
    (scene.space.lo.map(|face| (face + reach).next_up()), scene.space.hi.map(|face| (face - reach).next_down()))
}

/// What boxes and rays need for roundings: those of a box's corner, of a ray's shifted origin and of the structure's own
/// arithmetic come to those of the predicate.
pub(super) fn rounding(scene: &Scene) -> f32 {
    2.0 * scene.slack
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearfield_core::Boundary::{Open, Periodic, Wall};

    #[test]
    fn images_are_numbered_as_in_kernels_and_the_box_itself_comes_first() {
        let slab = SimBox::new([0.0; 3], [1.0; 3], [Open, Periodic, Wall]).expect("a valid box");
        let (codes, n) = codes(&slab);
        assert_eq!((&codes[..n as usize], codes[3..].iter().max()), ([13u8, 10, 16].as_slice(), Some(&0)));
        assert_eq!((code([-1; 3]), code([1; 3])), (0, 26));
    }
}
