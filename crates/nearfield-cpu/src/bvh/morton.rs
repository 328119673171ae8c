//! The order of a BVH's slots: by size class, then along a Z-order curve.
//!
//! A code has 60 bits of curve, 20 an axis: 10 an axis, as is common, put whole clusters into one cell. Above them
//! four bits of size class keep large boxes out of the leaves of small ones.

use super::sort::{Key, KeySort};
use crate::{Input, InputRadii};
use rayon::prelude::*;

const BITS: u32 = 20;
const CLASS_SHIFT: u32 = 3 * BITS;
const CLASSES: u32 = 1 << (64 - CLASS_SHIFT);
const CHUNK: usize = 1 << 14;

/// Sorts particles along the curve, keeping its buffers.
#[derive(Clone, Debug, Default)]
pub(crate) struct MortonOrder {
    keys: Vec<Key>,
    sort: KeySort,
}

impl MortonOrder {
    /// The particles of `input` in order.
    pub fn sort(&mut self, input: &Input) -> impl IndexedParallelIterator<Item = u32> + '_ {
        let curve = Curve::over(input);
        self.keys.resize(input.len(), Key::default());
        self.keys.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, keys)| {
            for (i, key) in keys.iter_mut().enumerate() {
                let particle = chunk * CHUNK + i;
                let code = curve.code(input.at(particle), input.radius(particle));
                *key = Key { code, particle: particle as u32 };
            }
        });
        self.sort.sort(&mut self.keys);
        self.keys.par_iter().map(|key| key.particle)
    }

    pub fn bytes(&self) -> usize {
        size_of::<Key>() * self.keys.capacity() + self.sort.bytes()
    }
}

/// A cube of cells over the actual bounds of the particles, and the least radius.
struct Curve {
    origin: [f32; 3],
    cells_per_length: f32,
    least_radius: Option<f32>,
}

impl Curve {
    fn over(input: &Input) -> Self {
        let bounds: [(f32, f32); 3] = input.position.map(range);
        let width = bounds.iter().map(|(lo, hi)| hi - lo).fold(0.0, f32::max);
        Self {
            origin: bounds.map(|(lo, _)| lo),
            // Infinite when all coincide: 0 * inf is NaN, which becomes cell 0.
            cells_per_length: (1 << BITS) as f32 / width,
            least_radius: match input.radii {
                InputRadii::Uniform(_) => None,
                InputRadii::PerParticle(radii) => Some(range(radii).0),
            },
        }
    }

    #[inline(always)]
    fn code(&self, position: [f32; 3], radius: f32) -> u64 {
        let [x, y, z] = std::array::from_fn(|axis| {
            let cell = ((position[axis] - self.origin[axis]) * self.cells_per_length) as u32;
            spread(cell.min((1 << BITS) - 1))
        });
        let class = self.least_radius.map_or(0, |least| octave(radius).saturating_sub(octave(least)).min(CLASSES - 1));
        u64::from(class) << CLASS_SHIFT | x << 2 | y << 1 | z
    }
}

/// The exponent of a positive number.
#[inline(always)]
fn octave(radius: f32) -> u32 {
    radius.to_bits() >> (f32::MANTISSA_DIGITS - 1)
}

/// Moves bit `b` of a 21-bit number to bit `3 b`.
#[inline(always)]
fn spread(cell: u32) -> u64 {
    let mut bits = u64::from(cell);
    bits = (bits | bits << 32) & 0x001F_0000_0000_FFFF;
    bits = (bits | bits << 16) & 0x001F_0000_FF00_00FF;
    bits = (bits | bits << 8) & 0x100F_00F0_0F00_F00F;
    bits = (bits | bits << 4) & 0x10C3_0C30_C30C_30C3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

/// Least and largest value.
pub(super) fn range(values: &[f32]) -> (f32, f32) {
    let of_chunk = |chunk: &[f32]| {
        // Sixteen running extremes: one alone would wait for the latency of each comparison.
        let mut extremes = [(f32::INFINITY, f32::NEG_INFINITY); 16];
        for values in chunk.chunks(16) {
            for (extreme, &value) in extremes.iter_mut().zip(values) {
                *extreme = (extreme.0.min(value), extreme.1.max(value));
            }
        }
        extremes.into_iter().fold((f32::INFINITY, f32::NEG_INFINITY), union)
    };
    values.par_chunks(CHUNK).map(of_chunk).reduce(|| (f32::INFINITY, f32::NEG_INFINITY), union)
}

fn union(a: (f32, f32), b: (f32, f32)) -> (f32, f32) {
    (a.0.min(b.0), a.1.max(b.1))
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
}
