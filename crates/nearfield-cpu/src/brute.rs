//! No structure: every slot is a candidate of every query, in every image.

use crate::{GroupBox, Input, LANES, Run, Slots, Structure, Vicinity};
use std::ops::Range;

/// All pairs. Slots are in input order.
#[derive(Clone, Debug, Default)]
pub struct Brute {
    slots: Slots,
    images: Vec<[i8; 3]>,
}

impl Brute {
    /// An empty one.
    pub fn new() -> Self {
        Self::default()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.slots.bytes()
    }

    /// Copies the particles.
    pub fn build(&mut self, input: &Input) {
        self.slots.fill(input, 0..input.len() as u32);
        self.images = input.sim_box.images();
    }
}

impl Structure for Brute {
    fn slots(&self) -> &Slots {
        &self.slots
    }

    fn n_groups(&self) -> usize {
        self.slots.len().div_ceil(LANES)
    }

    fn group(&self, g: usize) -> Range<usize> {
        g * LANES..((g + 1) * LANES).min(self.slots.len())
    }

    fn runs(&self, _: &GroupBox, _: &mut Vicinity, out: &mut Vec<Run>) {
        let end = self.slots.len() as u32;
        if end > 0 {
            out.extend(self.images.iter().map(|&image| Run { start: 0, end, image }));
        }
    }
}
