//! Seeded generators, one independent stream for each thing that is drawn.

use nearfield_core::philox::philox4x32;
use rand::SeedableRng;
use rand_pcg::Pcg64;

/// What a stream of random numbers is for.
#[derive(Clone, Copy)]
#[repr(u32)]
pub(super) enum Stream {
    Positions = 1,
    Radii = 2,
    Velocities = 3,
}

/// Draws after which a rejection loop gives up: at this count a range holds less than about 1e-4 of the distribution.
pub(super) const MAX_DRAWS: u32 = 100_000;

/// The generator of a stream. Seed and stream are hashed into the whole state, because PCG sequences of nearby
/// states or streams are correlated.
pub(super) fn generator(seed: u64, stream: Stream) -> Pcg64 {
    let key = [seed as u32, (seed >> 32) as u32];
    let words = [0, 1].map(|block| philox4x32([stream as u32, block, 0, 0], key));
    let mut state = [0; 32];
    for (bytes, word) in state.chunks_exact_mut(4).zip(words.as_flattened()) {
        bytes.copy_from_slice(&word.to_le_bytes());
    }
    Pcg64::from_seed(state)
}
