//! Rolls under the rod that do not repeat are found as one run each.

use rolltank::run::{Run, RunEnd, RunKind};

use super::run_finding_scene::{Found, LIMITS, ON_THE_ROD, Scene, UNDER_WAY, find};

const REST: &str = "{ rest = { duration_s = 10.0 } }";

fn found_in(scene: &Scene, actions: &str) -> Found {
    let played = scene.play(&format!("{REST}, {actions}"));
    for truth in &played.truth.runs {
        println!("truth {:?} {:.2} to {:.2} s", truth.kind, truth.start_s, truth.end_s);
    }
    let found = find(&played, LIMITS);
    found.print();
    found
}

/// Checks that the run is forced without a frequency and holds nearly all from `start_s` to
/// `end_s`: its first and last half cycles may be too small, or cut by the end.
fn assert_whole(run: &Run, start_s: f64, end_s: f64) {
    assert_eq!((run.kind, run.excitation_rad_s), (RunKind::Forced, None));
    assert!((-0.3..2.0).contains(&(run.start_s - start_s)), "starts at {}", run.start_s);
    assert!((-2.0..1.0).contains(&(run.end_s - end_s)), "ends at {}", run.end_s);
    assert!(run.drive.time_s.len() + 2 > run.roll.time_s.len());
}

#[test]
fn an_imposed_sweep_is_one_run() {
    for (from, to, duration_s) in [(5.0, 9.0, 40.0), (9.0, 5.0, 40.0), (4.0, 10.0, 60.0)] {
        let sweep = format!(
            "{{ forced_sweep = {{ amplitude_deg = 8.0, from_rad_s = {from}, to_rad_s = {to}, \
             duration_s = {duration_s:.1} }} }}, {{ stop = {{ duration_s = 6.0 }} }}"
        );
        let found = found_in(&ON_THE_ROD, &sweep);
        assert_eq!(found.runs.len(), 1, "{from} to {to} rad/s");
        assert_whole(&found.runs[0], 10.0, 10.0 + duration_s);
        let still = found.runs[0].still.expect("the rest before");
        assert!(still.force.unwrap().abs() < 0.05, "{still:?}");
    }
}

#[test]
fn the_answer_to_a_swept_moment_is_one_run() {
    for (from, to) in [(5.0, 9.0), (9.0, 5.0)] {
        let sweep = format!(
            "{{ driven_sweep = {{ moment_n_m = 1.5, from_rad_s = {from}, to_rad_s = {to}, \
             duration_s = 45.0 }} }}"
        );
        let found = found_in(&ON_THE_ROD, &sweep);
        assert_eq!(found.runs.len(), 1, "{from} to {to} rad/s");
        assert_whole(&found.runs[0], 10.0, 55.0);
    }
}

#[test]
fn an_irregular_roll_is_one_run_whatever_the_draw() {
    for action in ["forced_irregular = { rms_deg = 4.0", "driven_irregular = { rms_n_m = 1.2"] {
        for seed in 0..8 {
            let actions =
                format!("{{ {action}, from_rad_s = 4.5, to_rad_s = 9.0, duration_s = 60.0 }} }}");
            let found = found_in(&Scene { seed, ..ON_THE_ROD }, &actions);
            assert_eq!(found.runs.len(), 1, "{action}, seed {seed}");
            assert_whole(&found.runs[0], 10.0, 70.0);
        }
    }
}

#[test]
fn a_sweep_ends_where_the_carriage_brakes() {
    let pass = "froude = 0.2\ncarriage = { start_s = 2.0, brake_s = 30.0 }";
    let found = found_in(
        &Scene { pass, ..UNDER_WAY },
        "{ forced_sweep = { amplitude_deg = 8.0, from_rad_s = 5.0, to_rad_s = 9.0, \
         duration_s = 40.0 } }",
    );
    assert_eq!(found.runs.len(), 1);
    assert_whole(&found.runs[0], 10.0, 30.0);
    assert_eq!(found.runs[0].end, RunEnd::PassEnded);
}

#[test]
fn a_sweep_and_the_steady_roll_behind_it_are_two_runs() {
    let found = found_in(
        &ON_THE_ROD,
        "{ forced_sweep = { amplitude_deg = 8.0, from_rad_s = 4.5, to_rad_s = 8.5, \
         duration_s = 40.0 } }, \
         { forced = { amplitude_deg = 8.0, frequency_rad_s = 6.0, duration_s = 25.0 } }",
    );
    assert_eq!(found.runs.len(), 2);
    // The rod takes 2 s to the next frequency, which belong to what does not repeat.
    assert_whole(&found.runs[0], 10.0, 52.0);
    let steady = found.runs[1].excitation_rad_s.expect("it repeats");
    assert!((steady / 6.0 - 1.0).abs() < 2e-3, "{steady}");
}

#[test]
fn a_decay_follows_an_irregular_roll() {
    let found = found_in(
        &ON_THE_ROD,
        "{ driven_irregular = { rms_n_m = 1.5, from_rad_s = 5.0, to_rad_s = 8.5, \
         duration_s = 40.0 } }, { release = { duration_s = 20.0 } }",
    );
    let kinds: Vec<RunKind> = found.runs.iter().map(|run| run.kind).collect();
    assert_eq!(kinds, [RunKind::Forced, RunKind::Decay]);
    assert_whole(&found.runs[0], 10.0, 50.0);
    assert!((found.runs[1].start_s - 50.0).abs() < 1.5, "{}", found.runs[1].start_s);
}

#[test]
fn a_sweep_of_a_few_cycles_is_refused_with_the_number_that_it_lacks() {
    let found = found_in(
        &ON_THE_ROD,
        "{ forced_sweep = { amplitude_deg = 8.0, from_rad_s = 5.0, to_rad_s = 7.0, \
         duration_s = 2.5, ramp_s = 1.0 } }, { stop = { duration_s = 6.0, ramp_s = 1.0 } }",
    );
    assert!(found.runs.is_empty());
    found.rejected_for("fewer than 8 half cycles of it have an excitation of their own");
}

#[test]
fn a_hand_that_rocks_the_model_is_no_rod_even_when_the_roll_leaks_into_the_force() {
    let mut played = ON_THE_ROD.play(
        "{ rest = { duration_s = 6.0 } }, \
         { rock = { amplitude_deg = 10.0, frequency_rad_s = 6.8, duration_s = 9.0 } }, \
         { release = { duration_s = 20.0 } }",
    );
    let mut roll_rad = 0.0;
    for sample in &mut played.samples {
        match sample.quantity {
            devices::Quantity::Roll => roll_rad = sample.value,
            _ => sample.value += 3.0 * roll_rad,
        }
    }
    let found = find(&played, LIMITS);
    found.print();
    let kinds: Vec<RunKind> = found.runs.iter().map(|run| run.kind).collect();
    assert_eq!(kinds, [RunKind::Decay]);
}

#[test]
fn a_hand_on_the_rod_for_five_periods_is_no_run() {
    let found = found_in(
        &ON_THE_ROD,
        "{ forced_sweep = { amplitude_deg = 6.0, from_rad_s = 6.0, to_rad_s = 8.0, \
         duration_s = 5.0, ramp_s = 1.0 } }, { stop = { duration_s = 6.0, ramp_s = 0.5 } }",
    );
    assert!(found.runs.is_empty());
    found.rejected_for("at least 24");
}
