//! Tail corrections against NIST's published values for its Lennard-Jones reference configurations
//! (Lennard-Jones Fluid Reference Calculations: Cuboid Cell, NIST Standard Reference Simulation Website).

use nearfield_core::{
    Boundary, Interaction, Mixing, ParticleType, Particles, Radii, SimBox, System, Truncation,
    potentials::{Potential, Wca},
};

/// A homogeneous system; only its numbers matter.
fn fluid(n: usize, length: f32, cutoff: f32) -> System {
    System {
        sim_box: SimBox::cubic(length, Boundary::Periodic).unwrap(),
        particles: Particles::at((0..n).map(|i| [i as f32 * length / n as f32; 3])),
        radii: Radii::Uniform(cutoff),
        interaction: Interaction::lennard_jones(),
    }
}

#[test]
fn the_energy_equals_the_published_values_to_their_last_digit() {
    for (n, length, cutoff, published) in
        [(800, 10.0, 3.0, -198.49), (800, 10.0, 4.0, -83.769), (200, 8.0, 3.0, -24.230), (200, 8.0, 4.0, -10.226)]
    {
        let energy = fluid(n, length, cutoff).tail_correction().unwrap().energy;
        assert!((energy / published - 1.0).abs() < 5e-5, "N {n}, cutoff {cutoff}: {energy} for {published}");
    }
}

#[test]
fn energy_and_virial_are_the_integrals_beyond_the_cutoff() {
    let (n, length, cutoff) = (800.0, 10.0, 3.0);
    let tail = fluid(800, length, cutoff).tail_correction().unwrap();
    // Midpoint rule in 1/r: with x = 1/r, dr = dx / x², and U, -r U' as functions of x.
    let steps = 20_000;
    let dx = 1.0 / f64::from(cutoff) / f64::from(steps);
    let integral = |value: &dyn Fn(f64) -> f64| (0..steps).map(|k| value((f64::from(k) + 0.5) * dx) * dx).sum::<f64>();
    let pairs = 2.0 * std::f64::consts::PI * n * n / f64::from(length).powi(3);
    let energy = pairs * integral(&|x| 4.0 * (x.powi(12) - x.powi(6)) / x.powi(4));
    let virial = pairs * integral(&|x| 24.0 * (2.0 * x.powi(12) - x.powi(6)) / x.powi(4));
    assert!((tail.energy / energy - 1.0).abs() < 1e-6, "{} for {energy}", tail.energy);
    assert!((tail.virial / virial - 1.0).abs() < 1e-6, "{} for {virial}", tail.virial);
}

#[test]
fn splitting_a_fluid_into_two_equal_types_changes_nothing() {
    let plain = fluid(800, 10.0, 3.0);
    let mut split = plain.clone();
    split.interaction.types = vec![ParticleType::default(), ParticleType { name: "2".into(), ..Default::default() }];
    for (i, kind) in split.particles.kind.iter_mut().enumerate() {
        *kind = u32::from(i % 3 == 0);
    }
    for mixing in [Mixing::LorentzBerthelot, Mixing::Geometric] {
        split.interaction.mixing = mixing;
        let (a, b) = (plain.tail_correction().unwrap(), split.tail_correction().unwrap());
        assert!((a.energy - b.energy).abs() < 1e-10 && (a.virial - b.virial).abs() < 1e-10, "{a:?} {b:?}");
    }
}

#[test]
fn there_is_none_where_it_is_not_defined() {
    let plain = fluid(10, 10.0, 3.0);
    assert!(plain.tail_correction().is_some());
    let mut slab = plain.clone();
    slab.sim_box = SimBox::new([0.0; 3], [10.0; 3], [Boundary::Periodic, Boundary::Periodic, Boundary::Wall]).unwrap();
    let mut shifted = plain.clone();
    shifted.interaction.truncation = Truncation::Energy;
    let mut other = plain.clone();
    other.interaction.potential = Potential::Wca(Wca);
    let mut radii = plain.clone();
    radii.radii = Radii::PerParticle(vec![3.0; 10]);
    for system in [slab, shifted, other, radii] {
        assert_eq!(system.tail_correction(), None, "{system:?}");
    }
}
