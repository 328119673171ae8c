//! Places along a Hilbert curve, sixteen at a time.
//!
//! After J. Skilling, "Programming the Hilbert curve", AIP Conf. Proc. 707 (2004) 381, doi:10.1063/1.1751381, with
//! masks for branches, so that it vectorises.

use crate::LANES;

/// Cells an axis, as a power of two.
pub(super) const BITS: u32 = 20;

/// The places of the cells `(x, y, z)`, numbers of `3 BITS` bits.
#[inline(always)]
#[expect(clippy::needless_range_loop, reason = "kernels index, see node.rs")]
pub(super) fn places(mut cells: [[u32; LANES]; 3]) -> [u64; LANES] {
    // Undo the rotations and reflections of the curve from the coarsest level on.
    for bit in (1..BITS).rev() {
        let below = (1u32 << bit) - 1;
        for axis in 0..3 {
            for lane in 0..LANES {
                let reflect = (cells[axis][lane] >> bit & 1).wrapping_neg();
                let exchange = (cells[0][lane] ^ cells[axis][lane]) & below & !reflect;
                cells[0][lane] ^= (below & reflect) ^ exchange;
                // For axis 0 the exchange is nothing.
                cells[axis][lane] ^= exchange;
            }
        }
    }
    let mut places = [0; LANES];
    for lane in 0..LANES {
        let x = cells[0][lane];
        let y = cells[1][lane] ^ x;
        let z = cells[2][lane] ^ y;
        // Gray code: bit b of `flip` is the parity of the bits of z above b.
        let mut flip = z >> 1;
        flip ^= flip >> 1;
        flip ^= flip >> 2;
        flip ^= flip >> 4;
        flip ^= flip >> 8;
        flip ^= flip >> 16;
        places[lane] = spread(x ^ flip) << 2 | spread(y ^ flip) << 1 | spread(z ^ flip);
    }
    places
}

/// Moves bit `b` of a 21-bit number to bit `3 b`.
#[inline(always)]
fn spread(number: u32) -> u64 {
    let mut bits = u64::from(number);
    bits = (bits | bits << 32) & 0x001F_0000_0000_FFFF;
    bits = (bits | bits << 16) & 0x001F_0000_FF00_00FF;
    bits = (bits | bits << 8) & 0x100F_00F0_0F00_F00F;
    bits = (bits | bits << 4) & 0x10C3_0C30_C30C_30C3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreading_moves_each_bit_to_three_times_its_place() {
        for bit in 0..21 {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
        assert_eq!(spread((1 << 21) - 1), 0x1249_2492_4924_9249);
    }

    #[test]
    fn neighbours_along_the_curve_share_a_face() {
        const SIDE: u32 = 16;
        // At the origin, in the middle, where all levels turn, and at the far end.
        for origin in [0, (1 << (BITS - 1)) - SIDE, (1 << BITS) - SIDE] {
            let mut curve: Vec<(u64, [u32; 3])> = (0..SIDE.pow(3))
                .map(|k| {
                    let cell = [k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE].map(|c| c + origin);
                    (places(cell.map(|c| [c; LANES]))[0], cell)
                })
                .collect();
            curve.sort();
            for pair in curve.windows(2) {
                let [(place, cell), (next_place, next)] = pair else { unreachable!() };
                let distance: u32 = (0..3).map(|axis| cell[axis].abs_diff(next[axis])).sum();
                assert_eq!((next_place - place, distance), (1, 1), "from {cell:?} to {next:?}");
            }
        }
    }
}
