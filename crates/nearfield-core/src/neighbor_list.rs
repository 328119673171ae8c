//! Neighbour lists in compressed sparse rows (CSR).

/// How often a pair is listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ListKind {
    /// Each pair once, in the row of the smaller index.
    Half,
    /// Each pair twice: j in the row of i and i in the row of j.
    Full,
}

/// What a neighbour list should hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ListRequest {
    /// Half or full.
    pub kind: ListKind,
    /// Also list the periodic image of each neighbour.
    pub shifts: bool,
    /// Also list each distance.
    pub distances: bool,
    /// Rows in ascending order of the neighbour's index; otherwise the order within a row is unspecified.
    pub sorted: bool,
}

impl ListRequest {
    /// Indices only, unsorted.
    pub fn new(kind: ListKind) -> Self {
        Self { kind, shifts: false, distances: false, sorted: false }
    }
}

/// Neighbours of N particles: row `i` is `indices[offsets[i]..offsets[i + 1]]`. Rows are in input order.
#[derive(Clone, Debug, PartialEq)]
pub struct NeighborList {
    /// Half or full.
    pub kind: ListKind,
    /// Row starts, `[N + 1]`.
    pub offsets: Vec<u64>,
    /// Neighbour indices, `[P]`.
    pub indices: Vec<u32>,
    /// Periodic image of each neighbour, `[P]`, where asked for: `dr = (x_j - x_i) + image * box length`.
    pub shifts: Option<Vec<[i8; 3]>>,
    /// Distances, `[P]`, \[length\], where asked for.
    pub distances: Option<Vec<f32>>,
}

impl NeighborList {
    /// Number of particles, N.
    pub fn n_particles(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of entries, P: pairs in a half list, twice that in a full one.
    pub fn n_entries(&self) -> usize {
        self.indices.len()
    }

    /// Unordered pairs.
    pub fn n_pairs(&self) -> usize {
        match self.kind {
            ListKind::Half => self.n_entries(),
            ListKind::Full => self.n_entries() / 2,
        }
    }

    /// Entries of row `i`.
    #[inline]
    pub fn row_range(&self, i: usize) -> std::ops::Range<usize> {
        self.offsets[i] as usize..self.offsets[i + 1] as usize
    }

    /// Neighbours of particle `i`.
    #[inline]
    pub fn row(&self, i: usize) -> &[u32] {
        &self.indices[self.row_range(i)]
    }

    /// Every listed (i, j).
    pub fn pairs(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        (0..self.n_particles()).flat_map(|i| self.row(i).iter().map(move |&j| (i as u32, j)))
    }
}
