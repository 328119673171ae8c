//! The list of bodies, written once.

/// Stamps the whole suite on an engine: a module of that name with a `#[test]` for each body.
///
/// ```
/// use nearfield_conformance::OracleEngine;
///
/// nearfield_conformance::engine_tests!(oracle, OracleEngine::new());
/// # fn main() {}
/// ```
#[macro_export]
macro_rules! engine_tests {
    ($name:ident, $engine:expr) => {
        mod $name {
            #[allow(unused_imports, reason = "the expression for the engine may be fully qualified")]
            use super::*;

            $crate::large_bodies!(bodies_on; $engine);
            mod small {
                #[allow(unused_imports, reason = "the expression for the engine may be fully qualified")]
                use super::*;

                $crate::small_bodies!(bodies_on; $engine);
            }
        }
    };
}

/// As [`engine_tests!`] without the inputs that brute force on one thread cannot manage.
#[macro_export]
macro_rules! small_engine_tests {
    ($name:ident, $engine:expr) => {
        mod $name {
            #[allow(unused_imports, reason = "the expression for the engine may be fully qualified")]
            use super::*;

            $crate::small_bodies!(bodies_on; $engine);
        }
    };
}

/// Hands the bodies for a hundred thousand particles to a macro of this crate, after the other arguments.
#[doc(hidden)]
#[macro_export]
macro_rules! large_bodies {
    ($callback:ident; $($argument:tt)*) => {
        $crate::$callback! { $($argument)*;
            large: every_structure_finds_the_same_pairs_among_a_hundred_thousand_particles,
        }
    };
}

/// Hands the bodies for systems of up to a few thousand particles to a macro of this crate, after the other arguments.
#[doc(hidden)]
#[macro_export]
macro_rules! small_bodies {
    ($callback:ident; $($argument:tt)*) => {
        $crate::$callback! { $($argument)*;
            neighbors: half_and_full_lists_equal_the_oracle_bit_for_bit,
            neighbors: lists_of_random_systems_equal_the_oracle,
            neighbors: lists_of_thousands_of_particles_equal_the_oracle,
            neighbors: a_list_holds_only_what_was_asked_for,
            neighbors: counts_of_neighbors_equal_the_oracle,
            neighbors: a_list_after_a_run_is_that_of_the_present_positions,
            forces: forces_energies_and_virials_equal_the_oracle_on_every_input,
            forces: every_potential_and_truncation_equals_the_oracle,
            forces: mixtures_of_types_equal_the_oracle,
            forces: forces_sum_to_zero,
            forces: asking_for_forces_only_changes_no_force,
            forces: kinetic_energy_momentum_and_largest_force_are_those_of_the_particles,
            forces: coincident_particles_are_an_error_that_names_both_where_the_potential_diverges,
            forces: deterministic_forces_are_bitwise_equal_between_all_plans_and_repeats,
            plans: different_radii_are_refused_exactly_by_the_methods_that_cannot_treat_them,
            plans: an_engine_without_a_system_says_so,
            plans: loading_forgets_the_system_before,
            motion: every_plan_follows_the_same_trajectory,
            motion: maintenance_and_skin_do_not_change_a_deterministic_trajectory,
            motion: free_flight_keeps_input_order_and_continuous_unwrapped_positions,
            motion: momentum_is_conserved,
            motion: energy_fluctuations_fall_with_the_square_of_the_time_step,
            motion: reversed_velocities_lead_back_to_the_start,
            motion: walls_reflect_elastically_and_keep_particles_inside,
            motion: an_interacting_gas_between_walls_conserves_energy,
            motion: continuing_from_a_snapshot_equals_not_having_stopped,
            limits: no_particle_moves_further_than_the_limit_and_overlapping_starts_survive,
            limits: a_run_that_blows_up_is_an_error,
            limits: a_list_beyond_the_memory_budget_gives_the_same_forces_and_trajectory,
            ensembles: langevin_velocities_of_free_particles_follow_maxwell_and_boltzmann,
            ensembles: langevin_keeps_a_liquid_at_its_temperature,
            ensembles: rescaling_gives_free_particles_canonical_kinetic_energies,
            ensembles: rescaling_keeps_a_liquid_at_its_temperature_with_maxwell_boltzmann_velocities,
            reports: a_bvh_is_built_or_refitted_at_each_evaluation,
            reports: every_never_refits_and_fixed_builds_at_each_period,
            reports: a_skin_saves_list_builds,
            reports: history_holds_each_evaluation_while_it_is_recorded,
            reports: a_policy_that_looks_at_energy_reads_the_meter,
        }
    };
}

/// One `#[test]` a body.
#[doc(hidden)]
#[macro_export]
macro_rules! bodies_on {
    ($engine:expr; $($module:ident: $body:ident,)+) => {
        $(
            #[test]
            fn $body() {
                $crate::bodies::$module::$body(&|| Box::new($engine));
            }
        )+
    };
}

/// A list of bodies with their names.
#[doc(hidden)]
#[macro_export]
macro_rules! bodies_as_data {
    (; $($module:ident: $body:ident,)+) => {
        [$((concat!(stringify!($module), "::", stringify!($body)), $crate::bodies::$module::$body as $crate::Body)),+]
    };
}
