//! The suite tested: an engine that keeps its promises passes, and each planted fault is caught.

use nearfield_conformance::{Factory, Fault, OracleEngine, bodies, small_engine_tests};
use std::{collections::BTreeSet, panic};

small_engine_tests!(oracle, OracleEngine::new());

/// Runs a body on a faulty engine and gives the message of its panic.
fn caught(fault: Fault, body: impl Fn(Factory) + panic::RefUnwindSafe) -> String {
    let payload = panic::catch_unwind(|| body(&|| Box::new(OracleEngine::broken(fault))));
    let payload = payload.expect_err(&format!("{fault:?} went unnoticed"));
    payload.downcast_ref::<String>().cloned().unwrap_or_default()
}

#[test]
fn a_lost_pair_is_noticed_in_lists_counts_and_forces() {
    let message = caught(Fault::DropPair, bodies::neighbors::half_and_full_lists_equal_the_oracle_bit_for_bit);
    assert!(message.contains("first missing Some"), "{message}");
    caught(Fault::DropPair, bodies::neighbors::counts_of_neighbors_equal_the_oracle);
    caught(Fault::DropPair, bodies::forces::every_potential_and_truncation_equals_the_oracle);
}

#[test]
fn a_shift_before_the_subtraction_is_noticed() {
    caught(Fault::ShiftFirst, bodies::neighbors::lists_of_random_systems_equal_the_oracle);
}

#[test]
fn pairs_at_exactly_the_cutoff_are_noticed() {
    let message = caught(Fault::TiesIncluded, bodies::neighbors::half_and_full_lists_equal_the_oracle_bit_for_bit);
    assert!(message.contains("first too many Some"), "{message}");
}

#[test]
fn images_of_the_wrong_sign_are_noticed() {
    caught(Fault::WrongImageSign, bodies::neighbors::half_and_full_lists_equal_the_oracle_bit_for_bit);
}

#[test]
fn a_force_of_the_wrong_sign_is_noticed() {
    let message = caught(Fault::WrongForceSign, bodies::forces::mixtures_of_types_equal_the_oracle);
    assert!(message.contains("force 0 on 0"), "{message}");
    caught(Fault::WrongForceSign, bodies::forces::forces_sum_to_zero);
    caught(Fault::WrongForceSign, bodies::motion::momentum_is_conserved);
}

#[test]
fn a_method_that_accepts_radii_it_cannot_treat_is_noticed() {
    let body = bodies::plans::different_radii_are_refused_exactly_by_the_methods_that_cannot_treat_them;
    caught(Fault::SupportsAll, body);
}

#[test]
fn forgotten_masses_are_noticed() {
    caught(Fault::IgnoresMass, bodies::motion::momentum_is_conserved);
    caught(Fault::IgnoresMass, bodies::motion::every_plan_follows_the_same_trajectory);
}

#[test]
fn a_first_order_integrator_is_noticed() {
    let message = caught(Fault::FirstOrder, bodies::motion::energy_fluctuations_fall_with_the_square_of_the_time_step);
    assert!(message.contains("fluctuations"), "{message}");
    caught(Fault::FirstOrder, bodies::motion::reversed_velocities_lead_back_to_the_start);
}

#[test]
fn a_thermostat_with_wrong_noise_is_noticed() {
    let body = bodies::ensembles::langevin_velocities_of_free_particles_follow_maxwell_and_boltzmann;
    caught(Fault::NoiseTooStrong, body);
    caught(Fault::NoiseTooStrong, bodies::ensembles::langevin_keeps_a_liquid_at_its_temperature);
}

#[test]
fn leaky_walls_are_noticed() {
    caught(Fault::LeakyWalls, bodies::motion::walls_reflect_elastically_and_keep_particles_inside);
}

#[test]
fn refits_against_the_policy_are_noticed() {
    caught(Fault::NeverRebuilds, bodies::reports::every_never_refits_and_fixed_builds_at_each_period);
}

#[test]
fn overlaps_passed_over_in_silence_are_noticed() {
    let body = bodies::forces::coincident_particles_are_an_error_that_names_both_where_the_potential_diverges;
    caught(Fault::SilentOverlaps, body);
    caught(Fault::SilentOverlaps, bodies::limits::a_run_that_blows_up_is_an_error);
}

#[test]
fn an_ignored_displacement_limit_is_noticed() {
    let body = bodies::limits::no_particle_moves_further_than_the_limit_and_overlapping_starts_survive;
    caught(Fault::Unlimited, body);
}

#[test]
fn lost_images_and_memory_order_are_noticed() {
    let body = bodies::motion::free_flight_keeps_input_order_and_continuous_unwrapped_positions;
    caught(Fault::LosesImages, body);
    caught(Fault::MemoryOrder, body);
}

#[test]
fn a_method_that_rounds_differently_is_noticed() {
    let body = bodies::forces::deterministic_forces_are_bitwise_equal_between_all_plans_and_repeats;
    caught(Fault::MethodRounds, body);
    caught(Fault::MethodRounds, bodies::motion::maintenance_and_skin_do_not_change_a_deterministic_trajectory);
}

#[test]
fn the_suite_as_data_names_each_body_once() {
    let names: BTreeSet<&str> = nearfield_conformance::bodies().into_iter().map(|(name, _)| name).collect();
    assert_eq!(names.len(), nearfield_conformance::bodies().len());
    assert!(names.contains("neighbors::counts_of_neighbors_equal_the_oracle"));
    assert!(names.iter().any(|name| name.starts_with("large::")));
}
