//! Particles copied into the order of a structure: what kernels read.

use nearfield_core::SimBox;

/// Lanes a kernel works on at once. Slot arrays are padded to be readable this far past their end.
pub const LANES: usize = 16;

/// The particles a structure is built from, in the engine's memory order.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// The box. Positions are wrapped on periodic axes; on open axes they may lie outside.
    pub sim_box: &'a SimBox,
    /// Positions, three arrays `[N]`.
    pub position: [&'a [f32]; 3],
    /// Search radii: the structure must propose every j with distance < max(r_i, r_j) (grids), or < r_j (BVHs).
    pub radii: InputRadii<'a>,
    /// Types, `[N]`, or empty where there is only one.
    pub kind: &'a [u32],
}

/// Search radii of an [`Input`].
#[derive(Clone, Copy, Debug)]
pub enum InputRadii<'a> {
    /// One for all.
    Uniform(f32),
    /// One each, `[N]`.
    PerParticle(&'a [f32]),
}

impl Input<'_> {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.position[0].len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Position of particle `i`.
    #[inline(always)]
    pub fn at(&self, i: usize) -> [f32; 3] {
        [self.position[0][i], self.position[1][i], self.position[2][i]]
    }

    /// Radius of particle `i`.
    #[inline(always)]
    pub fn radius(&self, i: usize) -> f32 {
        match self.radii {
            InputRadii::Uniform(r) => r,
            InputRadii::PerParticle(radii) => radii[i],
        }
    }
}

/// N slots as a structure of arrays in the structure's order, each array `[N + LANES]`.
///
/// **Invariant:** the last `LANES` slots are padding: coordinates [`Slots::FAR`], `particle` `u32::MAX`. Structures may
/// hold more slots than particles (ghosts) and pad elsewhere by the same convention.
#[derive(Clone, Debug, Default)]
pub struct Slots {
    /// x coordinates.
    pub x: Vec<f32>,
    /// y coordinates.
    pub y: Vec<f32>,
    /// z coordinates.
    pub z: Vec<f32>,
    /// Index of the particle in the input's order; `u32::MAX` is padding.
    pub particle: Vec<u32>,
    /// Radii; empty when uniform.
    pub radius: Vec<f32>,
    /// Types; empty when there is only one.
    pub kind: Vec<u32>,
}

impl Slots {
    /// Coordinate of padding: finite, so that a masked force of zero times the displacement stays zero, and so far
    /// that the squared distance is infinite and the predicate refuses it whatever the range.
    pub const FAR: f32 = f32::MAX / 8.0;

    /// Copies particles in the given order and pads.
    pub fn fill(&mut self, input: &Input, order: impl Iterator<Item = u32> + Clone) {
        for (axis, out) in [&mut self.x, &mut self.y, &mut self.z].into_iter().enumerate() {
            out.clear();
            out.extend(order.clone().map(|i| input.position[axis][i as usize]));
            out.resize(out.len() + LANES, Self::FAR);
        }
        let n = self.x.len();
        self.particle.clear();
        self.particle.extend(order.clone());
        self.particle.resize(n, u32::MAX);
        self.radius.clear();
        if let InputRadii::PerParticle(radii) = input.radii {
            self.radius.extend(order.clone().map(|i| radii[i as usize]));
            self.radius.resize(n, 0.0);
        }
        self.kind.clear();
        if !input.kind.is_empty() {
            self.kind.extend(order.map(|i| input.kind[i as usize]));
            self.kind.resize(n, 0);
        }
    }

    /// Number of slots without the final padding.
    pub fn len(&self) -> usize {
        self.x.len().saturating_sub(LANES)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Position of slot `s`.
    #[inline(always)]
    pub fn at(&self, s: usize) -> [f32; 3] {
        [self.x[s], self.y[s], self.z[s]]
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.x.capacity() + self.y.capacity() + self.z.capacity())
            + 4 * (self.particle.capacity() + self.radius.capacity() + self.kind.capacity())
    }
}
