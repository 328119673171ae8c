//! Brute force in float64: the reference every method is tested against. Slow and plain on purpose.

use crate::{
    ListKind, NeighborList, Particles, Radii, SimBox, System, interaction::Truncated, potentials::PairPotential,
};
use crate::{interaction::PairLaw, predicate, with_potential};

/// A pair within range: `i < j`, and the image of j it was found at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair {
    /// Smaller index.
    pub i: u32,
    /// Larger index.
    pub j: u32,
    /// `dr = (x_j - x_i) + image * box length`.
    pub image: [i8; 3],
}

/// Every pair within range by testing all pairs in all images, sorted.
pub fn pairs(sim_box: &SimBox, particles: &Particles, radii: &Radii) -> Vec<Pair> {
    let images = sim_box.images();
    let mut found = Vec::new();
    for i in 0..particles.len() {
        let xi = particles.position.get(i);
        for j in i + 1..particles.len() {
            let xj = particles.position.get(j);
            for &image in &images {
                let dr = predicate::displacement(xi, xj, sim_box.shift(image));
                if predicate::is_neighbor(predicate::squared_length(dr), radii.range(i, j)) {
                    found.push(Pair { i: i as u32, j: j as u32, image });
                }
            }
        }
    }
    found
}

/// A list as sorted pairs, for comparison with [`pairs`]. Needs `shifts` where the box is periodic.
///
/// # Panics
/// When a full list is not symmetric or an entry is listed twice.
pub fn canonical(list: &NeighborList) -> Vec<Pair> {
    let mut found = Vec::with_capacity(list.n_entries());
    for i in 0..list.n_particles() {
        for entry in list.row_range(i) {
            let j = list.indices[entry];
            let image = list.shifts.as_ref().map_or([0; 3], |shifts| shifts[entry]);
            let i = i as u32;
            found.push(if i < j { Pair { i, j, image } } else { Pair { i: j, j: i, image: image.map(|s| -s) } });
        }
    }
    found.sort_unstable();
    if list.kind == ListKind::Full {
        assert!(found.chunks(2).all(|c| c.len() == 2 && c[0] == c[1]), "a full list holds each pair twice");
        found = found.into_iter().step_by(2).collect();
    }
    assert!(found.windows(2).all(|w| w[0] != w[1]), "a pair is listed twice");
    found
}

/// Forces, energies and their scale.
#[derive(Clone, Debug, Default)]
pub struct Reference {
    /// Forces, `[N]`.
    pub force: Vec<[f64; 3]>,
    /// Sum of the magnitudes of the pair forces on each particle, `[N]`: what rounding errors scale with.
    pub magnitude: Vec<f64>,
    /// Half of the energy of each particle's pairs, `[N]`.
    pub energy: Vec<f64>,
    /// Potential energy.
    pub potential_energy: f64,
    /// Sum of the magnitudes of the pair energies.
    pub energy_magnitude: f64,
    /// W = sum over pairs of r_ij . f_ij.
    pub virial: f64,
    /// Sum of the magnitudes of the pair virials.
    pub virial_magnitude: f64,
    /// Neighbours of each particle, `[N]`.
    pub neighbors: Vec<u32>,
    /// Pairs within range.
    pub pairs: u64,
}

/// Forces and energies in float64, of the pairs that the f32 predicate accepts. Displacements are recomputed in f64
/// from the f32 positions and shifts.
pub fn evaluate(system: &System) -> Reference {
    evaluate_pairs(system, &pairs(&system.sim_box, &system.particles, &system.radii))
}

/// As [`evaluate`], of the given pairs.
pub fn evaluate_pairs(system: &System, pairs: &[Pair]) -> Reference {
    with_potential!(&system.interaction.potential, p => sum(system, pairs, p))
}

fn sum<P: PairPotential>(system: &System, pairs: &[Pair], potential: &P) -> Reference {
    let n = system.particles.len();
    let mut out = Reference {
        force: vec![[0.0; 3]; n],
        magnitude: vec![0.0; n],
        energy: vec![0.0; n],
        neighbors: vec![0; n],
        pairs: pairs.len() as u64,
        ..Reference::default()
    };
    let law = Truncated::<_, true>(potential);
    for pair in pairs {
        let (i, j) = (pair.i as usize, pair.j as usize);
        let (xi, xj) = (system.particles.position.get(i), system.particles.position.get(j));
        let shift = system.sim_box.shift(pair.image);
        let dr: [f64; 3] = std::array::from_fn(|a| f64::from(xj[a]) - f64::from(xi[a]) + f64::from(shift[a]));
        let r2 = dr.iter().map(|d| d * d).sum::<f64>();
        let kind = &system.particles.kind;
        let c = system.interaction.pair_f64(kind[i], kind[j], system.radii.range(i, j), system.radii.is_uniform());
        let (f, u) = (law.f_over_r(r2, &c), law.energy(r2, &c));
        for (axis, d) in dr.into_iter().enumerate() {
            out.force[i][axis] -= f * d;
            out.force[j][axis] += f * d;
        }
        let size = (f * r2.sqrt()).abs();
        out.magnitude[i] += size;
        out.magnitude[j] += size;
        out.energy[i] += 0.5 * u;
        out.energy[j] += 0.5 * u;
        out.neighbors[i] += 1;
        out.neighbors[j] += 1;
        out.potential_energy += u;
        out.energy_magnitude += u.abs();
        out.virial += f * r2;
        out.virial_magnitude += (f * r2).abs();
    }
    out
}
