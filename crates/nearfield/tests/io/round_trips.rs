//! Whatever is written reads back the same, bit by bit. proptest prints the case, and the seed, that fails.

use nearfield::io::{Bounds, Configuration, ReadOptions, Species, read, write};
use nearfield_core::Vec3s;
use proptest::prelude::*;
use proptest::{collection::vec, option};

/// Any finite number, subnormal ones and the largest included.
fn real() -> impl Strategy<Value = f32> {
    any::<f32>().prop_filter("finite", |v| v.is_finite())
}

fn vectors(n: usize) -> impl Strategy<Value = Vec3s> {
    vec([real(), real(), real()], n).prop_map(|v| v.into_iter().collect())
}

fn bounds() -> impl Strategy<Value = Bounds> {
    let axis = || (-1.0e4f32..1.0e4, 1.0e-2f32..1.0e5).prop_map(|(lo, length)| (lo, lo + length));
    ([axis(), axis(), axis()], any::<[bool; 3]>()).prop_map(|(axes, periodic)| Bounds {
        lo: axes.map(|axis| axis.0),
        hi: axes.map(|axis| axis.1),
        periodic: Some(periodic),
    })
}

/// Species in order of first appearance, as a reader numbers them.
fn species(n: usize) -> impl Strategy<Value = Species> {
    let names = prop_oneof![Just(["Ar", "Ne", "Xe"]), Just(["1", "2", "3"]), Just(["big", "Ar", "β-C:x"])];
    (names, vec(0..3u32, n)).prop_map(|(names, of)| {
        let mut order: Vec<u32> = Vec::new();
        for &kind in &of {
            if !order.contains(&kind) {
                order.push(kind);
            }
        }
        let renumbered = of.iter().map(|kind| order.iter().position(|o| o == kind).unwrap() as u32).collect();
        Species { names: order.iter().map(|&kind| names[kind as usize].to_owned()).collect(), of: renumbered }
    })
}

prop_compose! {
    fn configuration()(n in 1..20usize)(
        position in vectors(n),
        velocity in option::of(vectors(n)),
        force in option::of(vectors(n)),
        species in species(n),
        masses in option::of([1.0e-3f32..1.0e3, 1.0e-3f32..1.0e3, 1.0e-3f32..1.0e3]),
        radius in option::of(vec(1.0e-3f32..1.0e3, n)),
        image in option::of(vec(any::<[i32; 3]>(), n)),
        first_id in option::of(any::<u32>()),
        bounds in option::of(bounds()),
        step in option::of(any::<u64>()),
        time in option::of(any::<f64>().prop_filter("finite", |v| v.is_finite())),
        comment in option::of("[ -~]{0,30}"),
    ) -> Configuration {
        let mass = masses.map(|masses| masses[..species.names.len()].to_vec());
        // Descending, so that the order of the file is not that of the ids.
        let id = first_id.map(|first| (0..position.len() as u64).map(|i| u64::from(first) + 100 - i).collect());
        Configuration { position, velocity, force, species, mass, radius, image, id, bounds, step, time, comment }
    }
}

fn through_a_file(name: &str, configuration: &Configuration) -> Configuration {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write(&path, configuration).unwrap();
    read(&path, &ReadOptions::default()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(100) })]

    #[test]
    fn extended_xyz_gives_everything_back(configuration in configuration()) {
        prop_assert_eq!(through_a_file("a.xyz", &configuration), configuration);
    }

    #[test]
    fn lammps_data_gives_back_what_it_can_hold(configuration in configuration(), bounds in bounds()) {
        let written = Configuration { bounds: Some(bounds), ..configuration };
        let back = through_a_file("a.data", &written);
        prop_assert_eq!(back.bounds, Some(Bounds { periodic: None, ..bounds }));
        prop_assert_eq!(back.id, Some(written.id.unwrap_or_else(|| (1..=back.position.len() as u64).collect())));
        prop_assert_eq!(back.position, written.position);
        prop_assert_eq!(back.velocity, written.velocity);
        prop_assert_eq!(back.species, written.species);
        prop_assert_eq!(back.mass, written.mass);
        prop_assert_eq!(back.image, written.image);
    }

    #[test]
    fn any_text_is_read_or_refused_by_name(
        text in "([0-9]{1,2}|[a-z =\"\\-.0-9\n]{0,40}\n){0,6}",
        name in "a\\.(xyz|data|gro)",
    ) {
        if let Err(error) = crate::read_text(&name, &text) {
            prop_assert!(error.to_string().contains(&name), "{}", error);
        }
    }
}
