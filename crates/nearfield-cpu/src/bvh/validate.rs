//! The promises of a tree, checked one by one.

use super::{Bvh, node::Aabb, tree::half_width};
use crate::LANES;
use crate::Slots;

impl Bvh {
    /// Checks what tracing relies on: every particle in exactly one real slot, padding as promised, every slot's box
    /// inside its leaf's, every child's inside its parent's.
    ///
    /// # Errors
    /// The first broken promise, in words.
    pub fn validate(&self) -> Result<(), String> {
        self.validate_particles()?;
        self.validate_padding()?;
        self.validate_leaves()?;
        self.tree.validate()
    }

    fn validate_particles(&self) -> Result<(), String> {
        let mut seen = vec![false; self.n_particles];
        for &particle in &self.slots.particle[..self.n_particles] {
            match seen.get_mut(particle as usize) {
                Some(seen) if !*seen => *seen = true,
                _ => return Err(format!("particle {particle} is in two slots or does not exist")),
            }
        }
        Ok(())
    }

    fn validate_padding(&self) -> Result<(), String> {
        let slots = &self.slots;
        let length = slots.particle.len();
        let lengths = [slots.x.len(), slots.y.len(), slots.z.len()];
        if lengths != [length; 3] || !length.is_multiple_of(LANES) {
            return Err(format!("arrays of {lengths:?} slots for {length} particles"));
        }
        for (slot, &particle) in slots.particle.iter().enumerate() {
            let is_padding = particle == u32::MAX;
            if slots.at(slot).iter().any(|&c| (c == Slots::FAR) != is_padding) {
                return Err(format!("slot {slot}: padding must be far away, and nothing else may be"));
            }
            if (slot >= slots.len() && !is_padding) || (slot < self.n_particles && is_padding) {
                return Err(format!("slot {slot}: padding out of place"));
            }
        }
        Ok(())
    }

    fn validate_leaves(&self) -> Result<(), String> {
        let Some(sim_box) = &self.sim_box else { return Ok(()) };
        for slot in (0..self.slots.len()).filter(|&slot| self.slots.particle[slot] != u32::MAX) {
            let leaf = slot / LANES;
            let half = self.probe.body() * half_width(self.uniform_radius.unwrap_or_else(|| self.slots.radius[slot]));
            let image = self.views.ghosts().map_or([0; 3], |ghosts| ghosts.image(leaf));
            let shift = sim_box.shift(image);
            let center: [f32; 3] = std::array::from_fn(|axis| self.slots.at(slot)[axis] + shift[axis]);
            let own = Aabb { lo: center.map(|c| c - half), hi: center.map(|c| c + half) };
            if !self.tree.leaf(leaf).holds(&own) {
                return Err(format!("slot {slot}: {own:?} is outside of its leaf {:?}", self.tree.leaf(leaf)));
            }
        }
        Ok(())
    }
}
