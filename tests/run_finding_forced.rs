//! Forced runs of the simulated tank are found where they are.

use devices::Quantity;
use rolltank::run::RunKind;

use super::run_finding_scene::{AT_REST, LIMITS, ON_THE_ROD, Scene, UNDER_WAY, find, find_in};

const IMPOSED: &str = "{ rest = { duration_s = 10.0 } }, \
    { forced = { amplitude_deg = 8.0, frequency_rad_s = 5.12, duration_s = 20.0 } }";

#[test]
fn an_imposed_roll_is_a_forced_run() {
    let found = ON_THE_ROD.check(&format!("{IMPOSED}, {{ stop = {{ duration_s = 6.0 }} }}"));
    let still = found.runs[0].still.expect("the rest before");
    assert!(still.end_s - still.start_s > 5.0 && still.force.unwrap().abs() < 0.05, "{still:?}");
    assert_eq!(found.runs[0].drive.time_s.len(), found.runs[0].roll.time_s.len());
}

#[test]
fn the_force_of_the_still_stretch_is_its_zero() {
    let pass = "froude = 0.0\nzero = { force_n = 0.7 }";
    let found = Scene { pass, ..ON_THE_ROD }.check(IMPOSED);
    let force = found.runs[0].still.and_then(|still| still.force).expect("a force was recorded");
    // 0.12 N of noise over some 1000 samples.
    assert!((force - 0.7).abs() < 0.02, "{force} N");
}

#[test]
fn three_frequencies_in_one_stay_are_three_runs() {
    let actions = format!(
        "{IMPOSED}, \
         {{ forced = {{ amplitude_deg = 8.0, frequency_rad_s = 6.9, duration_s = 20.0 }} }}, \
         {{ forced = {{ amplitude_deg = 8.0, frequency_rad_s = 8.0, duration_s = 20.0 }} }}"
    );
    ON_THE_ROD.check(&actions);
}

#[test]
fn two_amplitudes_at_one_frequency_are_two_runs() {
    let actions = format!(
        "{IMPOSED}, \
         {{ forced = {{ amplitude_deg = 5.0, frequency_rad_s = 5.12, duration_s = 20.0 }} }}, \
         {{ stop = {{ duration_s = 6.0 }} }}"
    );
    ON_THE_ROD.check(&actions);
}

#[test]
fn close_frequencies_are_told_apart() {
    let actions = format!(
        "{IMPOSED}, \
         {{ forced = {{ amplitude_deg = 8.0, frequency_rad_s = 5.5, duration_s = 20.0 }} }}"
    );
    ON_THE_ROD.check(&actions);
}

#[test]
fn the_answer_to_a_moment_is_a_forced_run() {
    ON_THE_ROD.check(
        "{ rest = { duration_s = 10.0 } }, \
         { driven = { moment_n_m = 0.8, frequency_rad_s = 6.9, duration_s = 60.0 } }",
    );
}

#[test]
fn the_answer_off_resonance_is_used_when_its_beats_have_died() {
    ON_THE_ROD.check(
        "{ rest = { duration_s = 10.0 } }, \
         { driven = { moment_n_m = 3.0, frequency_rad_s = 6.0, duration_s = 60.0 } }",
    );
}

#[test]
fn a_decay_follows_when_the_moment_is_taken_away() {
    ON_THE_ROD.check(
        "{ rest = { duration_s = 10.0 } }, \
         { driven = { moment_n_m = 1.0, frequency_rad_s = 6.9, duration_s = 50.0 } }, \
         { release = { duration_s = 15.0 } }",
    );
}

#[test]
fn a_decay_and_a_forced_run_share_a_stay() {
    ON_THE_ROD.check(
        "{ rest = { duration_s = 6.0 } }, { hold = { heel_deg = 10.0, duration_s = 4.0 } }, \
         { release = { duration_s = 20.0 } }, { rest = { duration_s = 8.0 } }, \
         { forced = { amplitude_deg = 6.0, frequency_rad_s = 6.9, duration_s = 20.0 } }",
    );
}

#[test]
fn a_forced_run_ends_with_the_pass() {
    let pass = "froude = 0.2\ncarriage = { start_s = 2.0, brake_s = 28.0 }";
    let actions = IMPOSED.replace("20.0 }", "40.0 }");
    Scene { pass, ..UNDER_WAY }.check(&actions);
}

#[test]
fn a_forced_roll_that_began_before_the_carriage_is_used_at_steady_speed() {
    let pass = "froude = 0.2\ncarriage = { start_s = 16.0 }";
    let actions = IMPOSED.replace("20.0 }", "40.0 }");
    let played = Scene { pass, ..UNDER_WAY }.play(&actions);
    let found = find(&played, LIMITS);
    found.print();
    // Steady from 16 s + 0.99 m/s / 0.5 m/s2.
    let last = found.runs.last().expect("a run at steady speed");
    assert!((last.start_s - 17.98).abs() < 0.7, "{}", last.start_s);
}

#[test]
fn a_hole_parts_a_forced_run_in_two() {
    let pass = "froude = 0.0\ngap = [ { start_s = 20.0, duration_s = 1.0 } ]";
    Scene { pass, ..ON_THE_ROD }.check(IMPOSED);
}

#[test]
fn a_sustained_roll_without_force_channel_is_forced() {
    AT_REST.check(IMPOSED);
}

#[test]
fn a_slow_forced_roll_is_found() {
    let slow = Scene { model: (1.2, 0.06, 0.5), ..ON_THE_ROD };
    slow.check(
        "{ rest = { duration_s = 20.0 } }, \
         { forced = { amplitude_deg = 5.0, frequency_rad_s = 0.9, duration_s = 90.0, \
         ramp_s = 8.0 } }",
    );
}

#[test]
fn crosstalk_of_the_roll_into_the_force_does_not_make_a_decay_forced() {
    let played = ON_THE_ROD.play(
        "{ rest = { duration_s = 6.0 } }, { hold = { heel_deg = 12.0, duration_s = 4.0 } }, \
         { release = { duration_s = 20.0 } }",
    );
    let mut samples = played.samples;
    let mut roll_rad = 0.0;
    for sample in &mut samples {
        match sample.quantity {
            Quantity::Roll => roll_rad = sample.value,
            // Ten times what is known of load cells, so that it cannot be missed.
            _ => sample.value += 20.0 * roll_rad,
        }
    }
    let found = find_in(&samples, LIMITS);
    found.print();
    assert_eq!(found.runs.len(), 1);
    assert_eq!(found.runs[0].kind, RunKind::Decay);
    assert!((found.runs[0].start_s - 10.0).abs() < 0.5 && found.runs[0].end_s > 29.0);
}
