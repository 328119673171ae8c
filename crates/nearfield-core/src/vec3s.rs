//! Three parallel arrays: vectors stored as a structure of arrays.

use serde::{Deserialize, Serialize};

/// N three-dimensional vectors as three `[N]` arrays, the layout that SIMD kernels read.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Vec3s {
    /// x components, `[N]`.
    pub x: Vec<f32>,
    /// y components, `[N]`.
    pub y: Vec<f32>,
    /// z components, `[N]`.
    pub z: Vec<f32>,
}

impl Vec3s {
    /// `n` zero vectors.
    pub fn zeros(n: usize) -> Self {
        Self { x: vec![0.0; n], y: vec![0.0; n], z: vec![0.0; n] }
    }

    /// Number of vectors.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Vector `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> [f32; 3] {
        [self.x[i], self.y[i], self.z[i]]
    }

    /// Replaces vector `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: [f32; 3]) {
        self.x[i] = v[0];
        self.y[i] = v[1];
        self.z[i] = v[2];
    }

    /// Appends a vector.
    pub fn push(&mut self, v: [f32; 3]) {
        self.x.push(v[0]);
        self.y.push(v[1]);
        self.z.push(v[2]);
    }

    /// Resizes to `n` vectors, new ones zero.
    pub fn resize(&mut self, n: usize) {
        for axis in self.axes_mut() {
            axis.resize(n, 0.0);
        }
    }

    /// The vectors in order.
    pub fn iter(&self) -> impl Iterator<Item = [f32; 3]> + '_ {
        (0..self.len()).map(|i| self.get(i))
    }

    /// The largest length of a vector; zero where there are none.
    pub fn largest_norm(&self) -> f32 {
        self.iter().map(|[x, y, z]| x * x + y * y + z * z).fold(0.0, f32::max).sqrt()
    }

    /// The three component arrays.
    pub fn axes(&self) -> [&Vec<f32>; 3] {
        [&self.x, &self.y, &self.z]
    }

    /// The three component arrays, mutable.
    pub fn axes_mut(&mut self) -> [&mut Vec<f32>; 3] {
        [&mut self.x, &mut self.y, &mut self.z]
    }
}

impl FromIterator<[f32; 3]> for Vec3s {
    fn from_iter<I: IntoIterator<Item = [f32; 3]>>(vectors: I) -> Self {
        let mut out = Self::default();
        for v in vectors {
            out.push(v);
        }
        out
    }
}
