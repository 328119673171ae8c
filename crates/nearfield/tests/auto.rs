//! The cost model of `auto` and its files of constants.

use nearfield::{
    Boundary, Error, Interaction, Method, Radii, System,
    auto::{Choice, Cost, DeviceProfile, Profile, Survey},
    bench::{Outcome, Suite, read_records, results_file},
    generate::{Generate, Positions},
};
use std::{collections::BTreeMap, fs, path::Path};

fn gas(n: usize, radii: Radii) -> System {
    let spec = Generate { n, positions: Positions::Disordered, density: Some(1.0), ..Generate::default() };
    let start = spec.build([Boundary::Periodic; 3], 1.0).unwrap();
    System { sim_box: start.sim_box, particles: start.particles, radii, interaction: Interaction::lennard_jones() }
}

/// Neighbours of a particle by trying all pairs.
fn neighbors(system: &System) -> f64 {
    2.0 * nearfield_core::oracle::pairs(&system.sim_box, &system.particles, &system.radii).len() as f64
        / system.particles.len() as f64
}

#[test]
fn a_survey_of_few_particles_counts_all_neighbors() {
    for radii in [Radii::Uniform(1.5), Radii::PerParticle((0..400).map(|i| 0.5 + 0.003 * i as f32).collect())] {
        let system = gas(400, radii);
        let survey = Survey::of(&system);
        assert!((survey.neighbors - neighbors(&system)).abs() < 1e-9, "{survey:?}");
    }
}

#[test]
fn a_survey_of_many_particles_estimates_their_neighbors() {
    let survey = Survey::of(&gas(200_000, Radii::Uniform(2.0)));
    let expected = 4.0 / 3.0 * std::f64::consts::PI * 8.0;
    assert!((survey.neighbors / expected - 1.0).abs() < 0.15, "{survey:?}");
}

#[test]
fn a_survey_of_nothing_or_one_particle_has_no_neighbors() {
    for n in [0, 1] {
        let mut system = gas(2, Radii::Uniform(0.1));
        system.particles = nearfield::Particles::at(vec![[0.5; 3]; n]);
        assert_eq!(Survey::of(&system), Survey { n, neighbors: 0.0, variable_radii: false });
    }
}

#[test]
fn fitted_constants_are_never_negative_and_predict_what_was_measured() {
    // A term that is not there, and noise of ten per cent.
    let systems: Vec<Survey> = [(1e3, 5.0), (1e4, 50.0), (1e5, 10.0), (1e5, 100.0), (1e6, 1.0), (1e6, 30.0)]
        .map(|(n, neighbors)| Survey { n: n as usize, neighbors, variable_radii: false })
        .to_vec();
    let truth = Cost { step: 2e-5, particle: 0.0, pair: 3e-9 };
    let noise = [1.1, 0.9, 1.05, 1.0, 0.95, 1.1];
    let measured: Vec<(Survey, f64)> =
        systems.iter().zip(noise).map(|(s, noise)| (*s, truth.seconds(Method::Cell, s) * noise)).collect();
    let fitted = Cost::fit(Method::Cell, &measured);
    assert!(fitted.step >= 0.0 && fitted.particle >= 0.0 && fitted.pair > 0.0, "{fitted:?}");
    for (survey, seconds) in &measured {
        let predicted = fitted.seconds(Method::Cell, survey);
        assert!((predicted / seconds - 1.0).abs() < 0.25, "{fitted:?}: {survey:?}: {predicted} for {seconds}");
    }
}

#[test]
fn costs_of_brute_grow_with_all_pairs() {
    let cost = Cost { pair: 1e-9, ..Cost::default() };
    let survey = Survey { n: 1000, neighbors: 3.0, variable_radii: false };
    assert!((cost.seconds(Method::Brute, &survey) - 1e-3).abs() < 1e-12);
    assert!((cost.seconds(Method::Cell, &survey) - 3e-6).abs() < 1e-15);
}

#[test]
fn the_longest_name_that_a_device_begins_with_counts_and_the_users_before_ours() {
    let entry =
        |name: &str, source: &str| DeviceProfile { name: name.into(), source: source.into(), ..Default::default() };
    let devices =
        vec![entry("NVIDIA", "mine"), entry("NVIDIA", "other"), entry("NVIDIA H200", "long"), entry("", "any")];
    let profile = Profile { devices };
    assert_eq!(profile.of("NVIDIA L40").unwrap().source, "mine");
    assert_eq!(profile.of("NVIDIA H200 NVL").unwrap().source, "long");
    assert_eq!(profile.of("Tesla T4").unwrap().source, "any");
}

/// A system, a method and its seconds of a step.
type Measured = (Survey, Method, f64);

/// Table 2 of paper A and 0.01 to 10⁴ neighbours, as they were measured there (docs/results).
#[test]
fn what_is_predicted_to_be_fastest_on_an_h200_was_so_within_a_tenth() {
    let results = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/results/h200");
    let mut cases: BTreeMap<_, Vec<Measured>> = BTreeMap::new();
    for suite in [Suite::Methods, Suite::Neighbors] {
        for record in read_records(&results_file(&results, suite)).unwrap() {
            let (Outcome::Measured(measured), false) = (&record.outcome, record.plan.deterministic) else { continue };
            let variable_radii = record.case.contains("r=U") || record.case.contains("r=LN");
            let survey = Survey { n: record.n, neighbors: measured.neighbors, variable_radii };
            let case = cases.entry((record.case, record.n)).or_default();
            case.push((survey, record.plan.method, measured.time.median));
        }
    }
    let profile = Profile::load().unwrap();
    let profile = profile.of("NVIDIA H200").unwrap();
    let mut compared = 0;
    for (case, measured) in &cases {
        let predicted = |survey: &Survey, method: Method| {
            profile
                .predict(survey)
                .into_iter()
                .find(|&(of, _)| of == method)
                .map_or(f64::INFINITY, |(_, seconds)| seconds)
        };
        let chosen = |a: &&Measured, b: &&Measured| predicted(&a.0, a.1).total_cmp(&predicted(&b.0, b.1));
        let &(_, method, seconds) = measured.iter().min_by(chosen).unwrap();
        let best = measured.iter().map(|&(_, _, seconds)| seconds).fold(f64::INFINITY, f64::min);
        assert!(seconds <= 1.1 * best, "{case:?}: {method} takes {seconds} s, the best {best}");
        compared += usize::from(measured.len() > 1);
    }
    assert!(compared > 50, "{compared}");
}

#[test]
fn profiles_read_back_as_they_were_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("new").join("profile.toml");
    let mut profile = Profile::default();
    for pair in [1e-9, 2e-9] {
        let method = [("cell".to_owned(), Cost { step: 1e-5, particle: 2e-8, pair })].into();
        profile.put(DeviceProfile { name: "cpu".into(), source: "test".into(), per_thread: true, method });
    }
    assert_eq!(profile.devices.len(), 1, "the later one replaces the earlier");
    profile.write(&path).unwrap();
    assert_eq!(Profile::read(&path).unwrap(), profile);
}

#[test]
fn a_profile_that_cannot_be_read_is_an_error_that_names_the_file_and_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("profile.toml");
    let cell = "[[device]]\nname = \"cpu\"\n[device.method]\n";
    for (text, expected) in [
        ("device = 3".to_owned(), "invalid type"),
        (format!("{cell}octree = {{ step = 1, particle = 1, pair = 1 }}"), "unknown method \"octree\""),
        (format!("{cell}cell = {{ step = 1, particle = 1 }}"), "missing field `pair`"),
        (format!("{cell}cell = {{ step = 1, particle = 1, pair = 1, extra = 2 }}"), "unknown field `extra`"),
    ] {
        fs::write(&path, text).unwrap();
        let error = Profile::read(&path).unwrap_err();
        let message = error.to_string();
        for part in [expected, "profile.toml", "nearfield bench auto"] {
            assert!(message.contains(part), "{message}");
        }
        assert!(matches!(error, Error::Profile { .. }) && error.is_request());
    }
}

#[test]
fn an_explanation_has_a_line_for_each_candidate() {
    let mut choice = Choice::of_user(Method::Cell);
    assert_eq!(choice.explain(), "method cell: chosen by the user");
    let simulation = nearfield::Simulation::builder(gas(300, Radii::Uniform(1.0))).build().unwrap();
    choice = simulation.choice().clone();
    let text = choice.explain();
    assert_eq!(text.lines().count(), 3 + choice.candidates.len(), "{text}");
    for candidate in &choice.candidates {
        assert!(text.contains(candidate.method.name()), "{text}");
    }
}
