//! What a model does after a decay is followed until somebody touches it or a minute is over.

use devices::{Quantity, Sample};

use super::run_finding_scene::{Found, LIMITS, find_in};

/// Rolls held at `heel_deg` until 8 s, then as `free` has it, at 100 Hz with some noise.
fn found(heel_deg: f64, free_s: f64, free: impl Fn(f64) -> f64) -> Found {
    let samples: Vec<Sample> = (0..((8.0 + free_s) * 100.0) as usize)
        .map(|k| {
            let time_s = k as f64 * 0.01;
            let noise_deg = 0.01 * ((977.0 * time_s).sin() + (3111.0 * time_s).sin());
            let roll_deg = match time_s {
                ..3.0 => 0.0,
                3.0..4.0 => heel_deg * (time_s - 3.0),
                4.0..8.0 => heel_deg,
                _ => free(time_s - 8.0),
            };
            let value = (roll_deg + noise_deg).to_radians();
            Sample { quantity: Quantity::Roll, time_s, value }
        })
        .collect();
    find_in(&samples, LIMITS)
}

/// Two motions of nearly one frequency: they cancel after five seconds and add up again.
fn beat(free_s: f64) -> f64 {
    let fading = (-0.12 * free_s).exp();
    12.0 * fading * (5.5 * free_s).cos() * (0.31 * free_s).cos()
}

#[test]
fn a_beat_that_grows_again_is_followed_to_its_end() {
    let found = found(12.0, 40.0, beat);
    let [after] = &found.aftermaths[..] else { panic!("{:?}", found.aftermaths) };
    let first = &found.runs[0];
    assert_eq!(after.run_end_s, Some(first.end_s));
    assert!(first.end_s < 14.0, "the run ends as the beat does, at {:.1} s", first.end_s);
    let (from_s, to_s) = (after.roll.time_s[0], after.roll.time_s[after.roll.time_s.len() - 1]);
    assert!(from_s > first.end_s && from_s < first.end_s + 0.02, "{from_s:.3} s");
    assert!(to_s > 25.0, "{to_s:.1} s");
    assert!(after.roll.time_s.windows(2).all(|pair| pair[1] - pair[0] < 0.015));
}

#[test]
fn a_release_of_which_too_little_decays_is_followed_from_the_release() {
    // The other motion takes the roll over within a period.
    let free = |t: f64| 12.0 * (-0.12 * t).exp() * (5.5 * t).cos() * (1.3 * t).cos();
    let found = found(12.0, 40.0, free);
    let [after] = &found.aftermaths[..] else { panic!("{:?}", found.aftermaths) };
    assert_eq!(after.run_end_s, None, "{:?}", found.runs.iter().map(|r| r.start_s).next());
    let from_s = after.roll.time_s[0];
    assert!((8.0..8.2).contains(&from_s), "{from_s:.3} s");
}

#[test]
fn nothing_comes_after_a_decay_that_is_lost_in_the_noise() {
    let found = found(12.0, 60.0, |t| 12.0 * (-0.2 * t).exp() * (5.5 * t).cos());
    assert_eq!((found.runs.len(), found.aftermaths.len()), (1, 0), "{:?}", found.aftermaths);
}

#[test]
fn waves_that_come_back_after_a_rest_are_followed_and_a_model_held_at_heel_is_not() {
    let decay = |t: f64| 12.0 * (-0.8 * t).exp() * (5.5 * t).cos();
    let back = |t: f64| 1.2 * (-((t - 18.0) / 2.5).powi(2)).exp() * (5.5 * t).cos();
    let rested = found(12.0, 40.0, |t| decay(t) + back(t));
    let [after] = &rested.aftermaths[..] else { panic!("{:?}", rested.aftermaths) };
    assert_eq!(after.run_end_s, Some(rested.runs[0].end_s));
    let (from_s, to_s) = (after.roll.time_s[0], after.roll.time_s[after.roll.time_s.len() - 1]);
    // Ten seconds of rest lie between the decay and the waves at 26 s.
    assert!(from_s < 16.0 && to_s > 27.0, "from {from_s:.1} s to {to_s:.1} s");
    // A hand heels the model within the minute, holds it there, and stirs it before it lets go.
    let held = found(12.0, 40.0, |t| match t {
        ..14.0 => decay(t),
        14.0..17.0 => 3.0 * (t - 14.0),
        17.0..25.0 => 9.0,
        _ => 9.0 + 0.8 * (5.5 * t).sin(),
    });
    assert!(held.aftermaths.is_empty(), "{:?}", held.aftermaths.len());
}

#[test]
fn the_next_release_is_no_part_of_what_came_before() {
    // A hand heels the model again while it still beats, and lets go at once.
    let (touched_s, released_s) = (12.0, 13.2);
    let free = |t: f64| match t {
        ..12.0 => beat(t),
        12.0..13.2 => 12.0 * (t - touched_s) / (released_s - touched_s),
        _ => 12.0 * (-0.12 * (t - released_s)).exp() * (5.5 * (t - released_s)).cos(),
    };
    let found = found(12.0, 40.0, free);
    let after = found.aftermaths.first().expect("the beat is followed");
    let to_s = after.roll.time_s[after.roll.time_s.len() - 1];
    assert!(
        to_s < 8.0 + released_s,
        "{to_s:.1} s, and the release is at {:.1} s",
        8.0 + released_s
    );
}
