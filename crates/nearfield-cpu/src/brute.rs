//! All pairs: the structure that has none. Right by construction, and fastest for a handful of particles.

use crate::{GroupBox, Input, InputRadii, LANES, Run, Slots, Structure};
use std::ops::Range;

/// Particles to a group.
const GROUP_SIZE: usize = 16;

/// Particles in input order; every image proposes all of them.
#[derive(Debug, Default)]
pub struct Brute {
    slots: Slots,
    images: Vec<[i8; 3]>,
}

impl Brute {
    /// An empty one.
    pub fn new() -> Self {
        Self::default()
    }

    /// Copies the particles of `input`.
    pub fn build(&mut self, input: &Input) {
        let Slots { x, y, z, particle, radius, kind } = &mut self.slots;
        for (to, from) in [x, y, z].into_iter().zip(input.position) {
            to.clear();
            to.extend_from_slice(from);
            to.extend([f32::NAN; LANES]);
        }
        particle.clear();
        particle.extend(0..input.len() as u32);
        particle.extend([u32::MAX; LANES]);
        radius.clear();
        if let InputRadii::PerParticle(radii) = input.radii {
            radius.extend_from_slice(radii);
            radius.extend([0.0; LANES]);
        }
        kind.clear();
        if !input.kind.is_empty() {
            kind.extend_from_slice(input.kind);
            kind.extend([0; LANES]);
        }
        self.images = input.sim_box.images();
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.slots.bytes() + 3 * self.images.capacity()
    }
}

impl Structure for Brute {
    fn slots(&self) -> &Slots {
        &self.slots
    }

    fn n_groups(&self) -> usize {
        self.slots.len().div_ceil(GROUP_SIZE)
    }

    fn group(&self, g: usize) -> Range<usize> {
        g * GROUP_SIZE..((g + 1) * GROUP_SIZE).min(self.slots.len())
    }

    fn runs(&self, _: &GroupBox, out: &mut Vec<Run>) {
        let end = self.slots.len() as u32;
        if end > 0 {
            out.extend(self.images.iter().map(|&image| Run { start: 0, end, image }));
        }
    }
}
