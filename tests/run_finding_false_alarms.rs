//! What looks like a run and is none, and runs that the tank cannot have made.

use devices::{Quantity, Sample};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rolltank::run::Limits;

use super::run_finding_scene::{AT_REST, Found, LIMITS, Scene, UNDER_WAY, find, find_in};

/// A roll record [deg] of 200 s with noise, and nothing else.
fn record(rate_hz: f64, noise_deg: f64, roll_deg: impl Fn(f64) -> f64) -> Found {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(11);
    let noise = Normal::new(0.0, noise_deg).expect("the noise is positive");
    let samples: Vec<Sample> = (0..(200.0 * rate_hz) as usize)
        .map(|k| {
            let time_s = k as f64 / rate_hz;
            let value = (roll_deg(time_s) + noise.sample(&mut rng)).to_radians();
            Sample { quantity: Quantity::Roll, time_s, value }
        })
        .collect();
    let found = find_in(&samples, LIMITS);
    found.print();
    found
}

/// A burst of vibration in every tenth second.
fn burst(t: f64, amplitude_deg: f64, frequency_hz: f64) -> f64 {
    let on = (t % 10.0) < 1.0;
    if on { amplitude_deg * (std::f64::consts::TAU * frequency_hz * t).sin() } else { 0.0 }
}

#[test]
fn noise_alone_is_no_run() {
    for (rate_hz, noise_deg) in [(20.0, 0.2), (100.0, 0.05), (100.0, 0.2), (1000.0, 0.2)] {
        let found = record(rate_hz, noise_deg, |_| 0.0);
        assert!(found.runs.is_empty() && found.rejected.is_empty());
    }
}

#[test]
fn a_drifting_zero_is_no_run() {
    assert!(record(100.0, 0.05, |t| 0.02 * t).runs.is_empty());
    assert!(record(100.0, 0.05, |t| 2.0 * (t / 30.0).sin()).runs.is_empty());
    assert!(record(100.0, 0.05, |t| if t < 100.0 { 0.0 } else { 3.0 }).runs.is_empty());
}

#[test]
fn bursts_of_vibration_are_no_run() {
    for frequency_hz in [5.0, 7.3, 10.0, 12.0, 15.0] {
        let found = record(100.0, 0.02, |t| burst(t, 1.0, frequency_hz));
        assert!(found.runs.is_empty(), "{frequency_hz} Hz");
    }
}

#[test]
fn single_knocks_are_no_run() {
    let knock = |t: f64| {
        let since_s = t % 20.0;
        if since_s < 1.5 { 4.0 * (std::f64::consts::TAU * since_s / 3.0).sin() } else { 0.0 }
    };
    assert!(record(100.0, 0.05, knock).runs.is_empty());
}

#[test]
fn irregular_waves_are_no_run() {
    let waves = |t: f64| {
        2.0 * (6.2 * t).sin()
            + 1.6 * (7.3 * t + 1.0).sin()
            + 1.3 * (5.1 * t + 2.0).sin()
            + 0.9 * (8.4 * t + 0.4).sin()
    };
    let found = record(100.0, 0.05, waves);
    assert!(found.runs.is_empty());
    found.rejected_for("neither decays freely nor is steady");
}

#[test]
fn the_shock_of_the_carriage_is_no_run() {
    let pass = "froude = 0.3\ncarriage = { start_s = 4.0, shock_n_m_s = 0.5 }";
    let played = Scene { pass, ..UNDER_WAY }.play("{ rest = { duration_s = 35.0 } }");
    let found = find(&played, LIMITS);
    found.print();
    assert!(found.runs.is_empty());
    found.rejected_for("speed");
}

#[test]
fn a_pass_that_the_carriage_cannot_make_is_refused_with_the_arithmetic() {
    let played = AT_REST.play(
        "{ rest = { duration_s = 4.0 } }, { hold = { heel_deg = 10.0, duration_s = 4.0 } }, \
         { release = { duration_s = 12.0 } }",
    );
    let found = find(&played, Limits { declared_speed_m_s: Some(4.952), ..LIMITS });
    assert!(found.runs.is_empty());
    let reason = "Fr 1.00 needs 4.95 m/s, the carriage does 2.00 m/s (Fr 0.404)";
    let refused = found.rejected_for(reason);
    assert!((refused.start_s - 8.0).abs() < 0.2 && (refused.end_s - 20.0).abs() < 0.1);
}

#[test]
fn samples_that_cannot_be_true_are_told() {
    let sample = |time_s: f64, value: f64| Sample { quantity: Quantity::Roll, time_s, value };
    let mut samples: Vec<Sample> = (0..50).map(|k| sample(f64::from(k) * 0.1, 0.0)).collect();
    samples.insert(20, sample(0.3, 0.0));
    samples.insert(30, sample(2.9, 57.0));
    samples.insert(40, sample(3.85, f64::NAN));
    let found = find_in(&samples, LIMITS);
    found.rejected_for("time runs backwards from 1.900 s to 0.300 s");
    found.rejected_for("roll of 57.000 rad is beyond 3.14 rad; hint: check the unit");
    found.rejected_for("no number");
}
