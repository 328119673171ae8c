//! Counter-based random numbers for the thermostats: Philox4x32-10 (Salmon et al., SC 2011, doi:10.1145/2063384.2063405).
//!
//! A draw is a pure function of (seed, step, particle), so it depends on neither memory order, thread count nor
//! device, and a resumed run continues exactly. Generators of initial conditions use the `rand` crates instead;
//! this one exists because the same function must run inside GPU kernels.

const MULTIPLIERS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];

/// The ten-round Philox block: 128 random bits for a 128-bit counter and a 64-bit key.
#[inline]
pub fn philox4x32(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for _ in 0..10 {
        let a = u64::from(MULTIPLIERS[0]) * u64::from(counter[0]);
        let b = u64::from(MULTIPLIERS[1]) * u64::from(counter[2]);
        counter = [(b >> 32) as u32 ^ counter[1] ^ key[0], b as u32, (a >> 32) as u32 ^ counter[3] ^ key[1], a as u32];
        key = [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])];
    }
    counter
}

/// Which independent sequence a draw belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Stream {
    /// Langevin noise, one draw a particle and step.
    Langevin = 1,
    /// Velocity rescaling, numbered draws of a step.
    Rescale = 2,
}

/// Four uniform numbers in (0, 1) for draw `index` of `step`.
#[inline]
pub fn uniforms(seed: u64, stream: Stream, step: u64, index: u32) -> [f64; 4] {
    let counter = [index, step as u32, (step >> 32) as u32, stream as u32];
    philox4x32(counter, [seed as u32, (seed >> 32) as u32]).map(|bits| (f64::from(bits) + 0.5) / 4_294_967_296.0)
}

/// The sequence of a step as a generator, for distributions that take a varying number of draws.
#[derive(Clone, Debug)]
pub struct PhiloxRng {
    seed: u64,
    stream: Stream,
    step: u64,
    next: u32,
}

impl PhiloxRng {
    /// Draws from index 0 of `step` on.
    pub fn new(seed: u64, stream: Stream, step: u64) -> Self {
        Self { seed, stream, step, next: 0 }
    }
}

impl rand::TryRng for PhiloxRng {
    type Error = std::convert::Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Self::Error> {
        self.try_next_u64().map(|bits| bits as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Self::Error> {
        let counter = [self.next, self.step as u32, (self.step >> 32) as u32, self.stream as u32];
        self.next = self.next.wrapping_add(1);
        let [a, b, ..] = philox4x32(counter, [self.seed as u32, (self.seed >> 32) as u32]);
        Ok(u64::from(a) | u64::from(b) << 32)
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Self::Error> {
        for chunk in bytes.chunks_mut(8) {
            chunk.copy_from_slice(&self.try_next_u64()?.to_le_bytes()[..chunk.len()]);
        }
        Ok(())
    }
}

/// Four standard normal numbers, by the Box-Muller transform.
#[inline]
pub fn normals(seed: u64, stream: Stream, step: u64, index: u32) -> [f64; 4] {
    let u = uniforms(seed, stream, step, index);
    let pair = |a: f64, b: f64| {
        let (sin, cos) = (std::f64::consts::TAU * b).sin_cos();
        let radius = (-2.0 * a.ln()).sqrt();
        [radius * cos, radius * sin]
    };
    let ([a, b], [c, d]) = (pair(u[0], u[1]), pair(u[2], u[3]));
    [a, b, c, d]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matches_the_known_answers_of_random123() {
        assert_eq!(philox4x32([0; 4], [0; 2]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(philox4x32([u32::MAX; 4], [u32::MAX; 2]), [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]);
        assert_eq!(
            philox4x32([0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344], [0xa409_3822, 0x299f_31d0]),
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]
        );
    }

    #[test]
    fn normals_have_the_right_moments() {
        let draws: Vec<f64> = (0..50_000).flat_map(|i| normals(7, Stream::Langevin, 3, i)).collect();
        let n = draws.len() as f64;
        let moment = |k: i32| draws.iter().map(|x| x.powi(k)).sum::<f64>() / n;
        // Five standard errors of each moment's estimate.
        assert!(moment(1).abs() < 5.0 / n.sqrt());
        assert!((moment(2) - 1.0).abs() < 5.0 * (2.0 / n).sqrt());
        assert!((moment(4) - 3.0).abs() < 5.0 * (96.0 / n).sqrt());
    }
}
