//! Which of the pairs within range a row keeps.

use crate::lanes::Lanes;

/// Which pairs a row keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rule {
    /// Every neighbour but the particle itself.
    Full,
    /// Neighbours of larger index.
    Half,
    /// Neighbours of larger radius, or of equal radius and larger index: each pair once, found from the side that a
    /// structure which proposes only d < r_j can see it from.
    Acting,
    /// Every point within the query's own radius. Queries and points are different sets, indices mean nothing.
    Bipartite,
}

/// One query in all lanes.
#[derive(Clone, Copy)]
pub(super) struct Query<L: Lanes> {
    pub position: [L::F; 3],
    pub radius: L::F,
    pub radius2: L::F,
    pub particle: L::U,
}

impl<L: Lanes> Query<L> {
    /// Particle `particle` at a position.
    #[inline(always)]
    pub fn new(lanes: L, [x, y, z]: [f32; 3], radius: f32, particle: u32) -> Self {
        Self {
            position: [lanes.splat(x), lanes.splat(y), lanes.splat(z)],
            radius: lanes.splat(radius),
            radius2: lanes.splat(radius * radius),
            particle: lanes.splat_u(particle),
        }
    }
}

/// Candidates, one in each lane.
#[derive(Clone, Copy)]
pub(super) struct Lane<L: Lanes> {
    pub radius: L::F,
    pub particle: L::U,
}

/// A [`Rule`] known when a kernel is compiled.
pub(super) trait Keep {
    /// Whether the range is max(r_i, r_j) rather than r_i, so that candidates' radii are read.
    const RADII: bool;

    /// The lanes to keep, apart from their distance.
    fn keep<L: Lanes>(lanes: L, query: &Query<L>, candidate: Lane<L>) -> u16;
}

/// [`Rule::Full`].
pub(super) struct Full<const RADII: bool>;

impl<const RADII: bool> Keep for Full<RADII> {
    const RADII: bool = RADII;

    #[inline(always)]
    fn keep<L: Lanes>(lanes: L, query: &Query<L>, candidate: Lane<L>) -> u16 {
        lanes.ne_u(candidate.particle, query.particle)
    }
}

/// [`Rule::Half`].
pub(super) struct Half<const RADII: bool>;

impl<const RADII: bool> Keep for Half<RADII> {
    const RADII: bool = RADII;

    #[inline(always)]
    fn keep<L: Lanes>(lanes: L, query: &Query<L>, candidate: Lane<L>) -> u16 {
        lanes.gt_u(candidate.particle, query.particle)
    }
}

/// [`Rule::Acting`].
pub(super) struct Acting;

impl Keep for Acting {
    const RADII: bool = true;

    #[inline(always)]
    fn keep<L: Lanes>(lanes: L, query: &Query<L>, candidate: Lane<L>) -> u16 {
        let larger = lanes.lt(query.radius, candidate.radius);
        let smaller = lanes.lt(candidate.radius, query.radius);
        larger | (!smaller & lanes.gt_u(candidate.particle, query.particle))
    }
}

/// [`Rule::Bipartite`].
pub(super) struct Bipartite;

impl Keep for Bipartite {
    const RADII: bool = false;

    #[inline(always)]
    fn keep<L: Lanes>(_: L, _: &Query<L>, _: Lane<L>) -> u16 {
        u16::MAX
    }
}
