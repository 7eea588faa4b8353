//! Decays of the simulated tank are found where they are.

use super::run_finding_scene::{AT_REST, LIMITS, ON_THE_ROD, Scene, UNDER_WAY, find};

/// Rest, held heel, release; `then` follows.
fn released(heel_deg: f64, free_s: f64, then: &str) -> String {
    format!(
        "{{ rest = {{ duration_s = 5.0 }} }}, \
         {{ hold = {{ heel_deg = {heel_deg:?}, duration_s = 4.0 }} }}, \
         {{ release = {{ duration_s = {free_s:?} }} }}, {then}"
    )
}

/// The paper's model with bilge keels.
const KEELS: (f64, f64, f64) = (6.136, 1.2408, 0.6682);

#[test]
fn a_release_from_heel_rolls_until_the_recording_ends() {
    AT_REST.check(&released(12.0, 10.0, ""));
}

#[test]
fn a_release_to_port_is_a_decay_too() {
    AT_REST.check(&released(-12.0, 10.0, ""));
}

#[test]
fn a_decay_is_lost_in_the_noise() {
    AT_REST.check(&released(12.0, 60.0, ""));
}

#[test]
fn a_decay_in_strong_noise_is_lost_early() {
    let noisy = Scene { roll: "sample_rate_hz = 100.0\nnoise_deg = 0.2", ..AT_REST };
    noisy.check(&released(10.0, 40.0, ""));
}

#[test]
fn a_decay_in_weak_noise_is_followed_far_down() {
    let calm = Scene { roll: "sample_rate_hz = 100.0\nnoise_deg = 0.005", ..AT_REST };
    calm.check(&released(10.0, 60.0, ""));
}

#[test]
fn a_coarse_digitiser_ends_the_decay_at_three_times_its_noise() {
    let coarse =
        Scene { roll: "sample_rate_hz = 100.0\nnoise_deg = 0.02\nquantum_deg = 0.1", ..AT_REST };
    coarse.check(&released(10.0, 40.0, ""));
}

#[test]
fn bilge_keels_leave_a_few_half_cycles() {
    Scene { model: KEELS, ..AT_REST }.check(&released(15.0, 20.0, ""));
}

#[test]
fn a_release_at_one_degree_is_found() {
    AT_REST.check(&released(1.2, 20.0, ""));
}

#[test]
fn a_release_at_thirty_degrees_is_found() {
    AT_REST.check(&released(30.0, 20.0, ""));
}

#[test]
fn a_period_of_ten_seconds_is_found() {
    let slow = Scene { model: (0.6283, 0.03, 0.5), ..AT_REST };
    slow.check(&released(10.0, 120.0, ""));
}

#[test]
fn a_period_of_half_a_second_is_found_at_five_kilohertz() {
    let quick = Scene {
        model: (12.566, 0.5, 0.05),
        roll: "sample_rate_hz = 5000.0\nnoise_deg = 0.05",
        ..AT_REST
    };
    quick.check(&released(10.0, 8.0, ""));
}

#[test]
fn twenty_hertz_are_enough_for_a_period_of_a_second() {
    let sparse = Scene { roll: "sample_rate_hz = 20.0\nnoise_deg = 0.05", ..AT_REST };
    sparse.check(&released(10.0, 12.0, ""));
}

#[test]
fn uneven_sampling_changes_nothing() {
    let uneven =
        Scene { roll: "sample_rate_hz = 50.0\nnoise_deg = 0.05\ntime_jitter_s = 0.003", ..AT_REST };
    uneven.check(&released(10.0, 12.0, ""));
}

#[test]
fn a_heeled_model_with_a_wrong_and_drifting_zero_is_found() {
    let pass = "froude = 0.0\nstatic_heel_deg = 2.0\n\
                zero = { roll_deg = 3.0, roll_drift_deg_per_s = 0.01 }";
    let found = Scene { pass, ..AT_REST }.check(&released(8.0, 12.0, ""));
    let still = found.runs[0].still.expect("the rest before the hold");
    // Static heel and zero, and 0.01 deg/s over the rest.
    assert!((still.roll_rad.to_degrees() - 5.03).abs() < 0.1, "{still:?}");
}

#[test]
fn the_rest_before_the_hold_is_the_still_stretch() {
    let found = AT_REST.check(&released(8.0, 12.0, ""));
    let still = found.runs[0].still.expect("the rest before the hold");
    assert!(still.end_s <= 5.4 && still.roll_rad.abs() < 3e-4, "{still:?}");
}

#[test]
fn a_trembling_hand_does_not_start_the_run() {
    AT_REST.check(
        "{ rest = { duration_s = 4.0 } }, \
         { hold = { heel_deg = 10.0, duration_s = 6.0, tremor_deg = 0.2 } }, \
         { release = { duration_s = 10.0 } }",
    );
}

#[test]
fn a_short_hold_is_enough() {
    AT_REST.check(
        "{ rest = { duration_s = 4.0 } }, \
         { hold = { heel_deg = 10.0, duration_s = 1.2, ramp_s = 0.6 } }, \
         { release = { duration_s = 10.0 } }",
    );
}

#[test]
fn a_slow_release_starts_when_the_hand_is_off() {
    AT_REST.check(
        "{ rest = { duration_s = 4.0 } }, { hold = { heel_deg = 10.0, duration_s = 4.0 } }, \
         { release = { duration_s = 12.0, fade_s = 0.15 } }",
    );
}

#[test]
fn a_hand_ends_the_decay() {
    let found = AT_REST.check(&released(12.0, 7.3, "{ catch = { duration_s = 4.0 } }"));
    assert!(!found.runs.is_empty());
}

#[test]
fn a_hand_that_holds_the_model_at_heel_ends_the_decay() {
    let then = "{ hold = { heel_deg = 6.0, duration_s = 5.0, ramp_s = 0.5 } }";
    AT_REST.check(&released(12.0, 6.1, then));
}

#[test]
fn a_model_rocked_up_by_hand_starts_at_its_first_free_peak() {
    AT_REST.check(
        "{ rest = { duration_s = 4.0 } }, \
         { rock = { amplitude_deg = 10.0, frequency_rad_s = 6.9, duration_s = 6.0 } }, \
         { release = { duration_s = 12.0 } }",
    );
}

#[test]
fn a_model_rocked_up_off_its_frequency_is_found_too() {
    AT_REST.check(
        "{ rest = { duration_s = 4.0 } }, \
         { rock = { amplitude_deg = 8.0, frequency_rad_s = 5.5, duration_s = 5.0 } }, \
         { release = { duration_s = 12.0 } }",
    );
}

#[test]
fn a_blow_from_rest_is_a_decay() {
    AT_REST.check(
        "{ rest = { duration_s = 4.0 } }, \
         { strike = { impulse_n_m_s = 2.0, duration_s = 12.0 } }",
    );
}

#[test]
fn a_blow_in_the_middle_of_a_decay_starts_another() {
    let then = "{ strike = { impulse_n_m_s = 2.5, duration_s = 12.0 } }";
    AT_REST.check(&released(10.0, 8.0, then));
}

#[test]
fn three_releases_in_one_stay_are_three_runs() {
    let again = "{ hold = { heel_deg = 8.0, duration_s = 3.0 } }, \
                 { release = { duration_s = 7.0 } }, \
                 { hold = { heel_deg = -6.0, duration_s = 3.0 } }, \
                 { release = { duration_s = 7.0 } }";
    AT_REST.check(&released(12.0, 7.0, again));
}

#[test]
fn a_hole_ends_the_decay() {
    let pass = "froude = 0.0\ngap = [ { start_s = 14.0, duration_s = 1.3 } ]";
    let found = Scene { pass, ..AT_REST }.check(&released(12.0, 12.0, ""));
    found.rejected_for("hole");
}

#[test]
fn a_few_lost_samples_do_not_end_the_decay() {
    let pass = "froude = 0.0\ngap = [ { start_s = 14.0, duration_s = 0.06 } ]";
    let played = Scene { pass, ..AT_REST }.play(&released(12.0, 12.0, ""));
    let found = find(&played, LIMITS);
    assert_eq!(found.runs.len(), 1);
    assert!(found.runs[0].end_s > 20.9, "{}", found.runs[0].end_s);
}

#[test]
fn a_pass_with_speed_channel_gives_its_decay() {
    let found = UNDER_WAY.check(&released(10.0, 25.0, ""));
    let speed_m_s = found.runs[0].speed_m_s.expect("a speed was recorded");
    // Fr 0.2 is 0.990 m/s; 20 s of 0.003 m/s noise leave 0.0002 m/s.
    assert!((speed_m_s - 0.990).abs() < 0.002, "{speed_m_s} m/s");
}

#[test]
fn braking_ends_the_decay() {
    let pass = "froude = 0.2\ncarriage = { start_s = 2.0, brake_s = 16.0, shock_n_m_s = 0.2 }";
    Scene { pass, model: (6.905, 0.15, 0.05), ..UNDER_WAY }.check(&released(12.0, 20.0, ""));
}

#[test]
fn a_release_while_speeding_up_is_used_from_the_steady_speed_on() {
    let pass = "froude = 0.2\ncarriage = { start_s = 8.0 }";
    let found = Scene { pass, ..UNDER_WAY }.check(&released(14.0, 20.0, ""));
    found.rejected_for("changing its speed");
}

#[test]
fn a_pass_without_speed_channel_is_found_from_its_roll() {
    Scene { speed: "", ..UNDER_WAY }.check(&released(10.0, 20.0, ""));
}

#[test]
fn vibration_of_the_carriage_does_not_hide_the_decay() {
    let pass = "froude = 0.2\ncarriage = { start_s = 2.0 }\n\
                vibration = { amplitude_deg = 0.1, frequency_hz = 9.0 }";
    Scene { pass, ..UNDER_WAY }.check(&released(10.0, 20.0, ""));
}

#[test]
fn two_half_cycles_are_too_few() {
    let then = "{ catch = { duration_s = 4.0 } }";
    let played = AT_REST.play(&released(10.0, 1.0, then));
    let found = find(&played, LIMITS);
    found.print();
    assert!(found.runs.is_empty());
    found.rejected_for("at least 3 are needed");
}

#[test]
fn a_decay_with_the_load_cell_hanging_free_is_no_forced_run() {
    ON_THE_ROD.check(&released(10.0, 20.0, ""));
}

#[test]
fn bilge_keels_at_speed_leave_two_periods() {
    let keels = Scene { model: (6.136, 3.2, 0.67), ..AT_REST };
    keels.check(&released(20.0, 8.0, ""));
    keels.check(&released(14.0, 8.0, ""));
}
