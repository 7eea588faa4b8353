//! What the simulated tank does with each kind of action, seen through its samples and its truth.

use devices::{Quantity, Sample};
use rolltank::tank::{PassTruth, RejectedKind, Scenario, SimulatedPass, TrueKind, simulate_pass};

const HEAD: &str = r#"
name = "scenes"
[hull]
length_pp_m = 2.5
beam_m = 0.387
draft_m = 0.132
displacement_m3 = 0.110
gm_m = 0.074
[tank]
length_m = 50.0
width_m = 10.0
depth_m = 5.0
carriage_max_speed_m_s = 2.0
end_margin_m = 7.0
[instruments]
roll = { sample_rate_hz = 100.0 }
moment = { sample_rate_hz = 100.0 }
speed = { sample_rate_hz = 100.0 }
[[condition]]
name = "bare"
natural_frequency_rad_s = 6.905
damping.law = { b0_per_s = 0.4, kappa = 10.0, b3_s = 0.15 }
[[pass]]
condition = "bare"
"#;

/// Simulates one pass written under `[[pass]]`, with ideal instruments.
fn scene(pass: &str) -> SimulatedPass {
    let scenario = Scenario::parse(&format!("{HEAD}{pass}"), "scene").expect("a valid scene");
    simulate_pass(&scenario, 0, 7)
}

fn values(pass: &SimulatedPass, quantity: Quantity) -> Vec<Sample> {
    pass.samples.iter().filter(|s| s.quantity == quantity).copied().collect()
}

fn roll_at(pass: &SimulatedPass, time_s: f64) -> f64 {
    values(pass, Quantity::Roll)[(time_s * 100.0).round() as usize].value
}

fn kinds(truth: &PassTruth) -> Vec<RejectedKind> {
    truth.unusable.iter().map(|u| u.kind).collect()
}

#[test]
fn a_released_model_rolls_at_its_natural_frequency_and_loses_amplitude_as_its_damping_says() {
    let pass = scene(
        "froude = 0.0\naction = [ { rest = { duration_s = 2.0 } }, \
         { hold = { heel_deg = 10.0, duration_s = 3.0 } }, { release = { duration_s = 20.0 } } ]",
    );
    let run = &pass.truth.runs[0];
    assert_eq!((run.kind, run.start_s), (TrueKind::Decay, 5.0));
    assert!((run.initial_roll_rad.to_degrees() - 10.0).abs() < 1e-9);
    assert!((roll_at(&pass, 4.9).to_degrees() - 10.0).abs() < 1e-9, "held before the release");
    // Averaged amplitude equation, dA/dt = -b1 A/2 - 3/8 b3 w^2 A^3 (CONVENTIONS section 2): with
    // u = A^2 it is a Bernoulli equation with a closed form.
    let (b1, b3, w, t) = (0.4, 0.15, 6.905_f64, 9.1);
    let c = 0.75 * b3 * w * w / b1;
    let u0 = 10.0_f64.to_radians().powi(2);
    let u = u0 * f64::exp(-b1 * t) / (1.0 + c * u0 * (1.0 - f64::exp(-b1 * t)));
    let peak = values(&pass, Quantity::Roll)
        .iter()
        .filter(|s| (s.time_s - 5.0 - t).abs() < 0.15)
        .map(|s| s.value.abs())
        .fold(0.0, f64::max);
    // Ten periods after the release the roll is at a peak; averaging is good to (b/w)^2 = 0.3 %.
    assert!((peak / u.sqrt() - 1.0).abs() < 0.01, "{peak} against {}", u.sqrt());
}

#[test]
fn the_moment_of_a_forced_roll_gives_inertia_and_damping_back() {
    let (w, amplitude) = (5.12_f64, 8.0_f64.to_radians());
    let pass = scene(
        "froude = 0.0\naction = [ { rest = { duration_s = 3.0 } }, \
         { forced = { amplitude_deg = 8.0, frequency_rad_s = 5.12, duration_s = 40.0 } } ]",
    );
    let run = &pass.truth.runs[0];
    assert_eq!((run.kind, run.start_s, run.end_s), (TrueKind::Forced, 5.0, 43.0));
    let whole_s = (38.0 / (std::f64::consts::TAU / w)).floor() * std::f64::consts::TAU / w;
    let moments = values(&pass, Quantity::Moment);
    let pair = |t: f64| (roll_at(&pass, t), moments[(t * 100.0).round() as usize]);
    let (mut in_phase, mut roll_square) = (0.0, 0.0);
    let (mut work, mut previous) = (0.0, None);
    for k in 0..=(whole_s * 100.0) as usize {
        let (roll, moment) = pair(5.0 + k as f64 * 0.01);
        in_phase += roll * moment.value;
        roll_square += roll * roll;
        if let Some((r, m)) = previous.replace((roll, moment.value)) {
            work += 0.5 * (moment.value + m) * (roll - r);
        }
    }
    let k = 1000.0 * 9.81 * 0.110 * 0.074;
    let inertia = (k - in_phase / roll_square) / (w * w);
    let n_cycles = whole_s * w / std::f64::consts::TAU;
    let damping = work / n_cycles / (std::f64::consts::PI * w * amplitude * amplitude);
    let expected = run.inertia_kg_m2 * (0.4 + 0.75 * 0.15 * (w * amplitude).powi(2));
    // Sums over 10 ms steps that miss a whole cycle by at most one sample of 123.
    assert!((inertia / run.inertia_kg_m2 - 1.0).abs() < 0.002, "{inertia}");
    assert!((damping / expected - 1.0).abs() < 0.01, "{damping} against {expected}");
}

#[test]
fn a_blow_in_the_middle_of_a_decay_ends_one_run_and_starts_another() {
    let pass = scene(
        "froude = 0.0\naction = [ { hold = { heel_deg = 10.0, duration_s = 2.0 } }, \
         { release = { duration_s = 8.0 } }, \
         { strike = { impulse_n_m_s = 1.5, duration_s = 12.0 } } ]",
    );
    let runs = &pass.truth.runs;
    assert_eq!(runs.len(), 2);
    assert_eq!((runs[0].end_s, runs[1].start_s), (10.0, 10.1));
    // The blow adds impulse over inertia to the roll rate; the model turns by 0.1 s w meanwhile.
    let rate_before = (roll_at(&pass, 10.0) - roll_at(&pass, 9.99)) / 0.01;
    let gained = runs[1].initial_roll_rate_rad_per_s - rate_before;
    assert!((gained - 1.5 / runs[1].inertia_kg_m2).abs() < 0.35, "gained {gained} rad/s");
    assert_eq!(kinds(&pass.truth), [RejectedKind::Held, RejectedKind::Struck]);
}

#[test]
fn a_caught_model_stops_within_a_second_or_two_and_the_run_ends_at_the_hand() {
    let pass = scene(
        "froude = 0.0\naction = [ { hold = { heel_deg = 10.0, duration_s = 2.0 } }, \
         { release = { duration_s = 6.0 } }, { catch = { duration_s = 5.0 } } ]",
    );
    assert!((pass.truth.runs[0].end_s - 8.0).abs() < 1e-9);
    // Damping ratio 1.5: the slow root is 0.38 w, so 5 s leave exp(-13).
    assert!(roll_at(&pass, 13.0).abs() < 1e-6);
}

#[test]
fn a_pass_that_runs_out_of_tank_ends_its_run_when_the_carriage_brakes() {
    let pass = scene(
        "froude = 0.4\naction = [ { rest = { duration_s = 5.0 } }, \
         { hold = { heel_deg = 20.0, duration_s = 3.0 } }, { release = { duration_s = 30.0 } } ]",
    );
    // 43 m less 1.981^2/0.5 m of speeding up and braking, from 2 + 1.981/0.5 s on.
    let speed: f64 = 0.4 * (9.81 * 2.5_f64).sqrt();
    let brake_s = 2.0 + speed / 0.5 + (43.0 - speed * speed / 0.5) / speed;
    let run = &pass.truth.runs[0];
    assert!((run.end_s - brake_s).abs() < 1e-9, "{} against {brake_s}", run.end_s);
    assert!((run.b1_per_s - 0.4 * 2.6).abs() < 1e-12, "damping of the steady speed");
    let speeds = values(&pass, Quantity::Speed);
    assert!((speeds[1500].value - speed).abs() < 1e-12);
    assert!(speeds.last().unwrap().value < 1e-12, "at a standstill in the end");
    assert_eq!(kinds(&pass.truth), [RejectedKind::Held, RejectedKind::Braking]);
}

#[test]
fn a_decay_released_while_speeding_up_counts_from_the_steady_stretch_on() {
    let pass = scene(
        "froude = 0.3\ncarriage = { start_s = 4.0 }\naction = [ \
         { hold = { heel_deg = 15.0, duration_s = 5.0 } }, { release = { duration_s = 15.0 } } ]",
    );
    let steady_s = 4.0 + 0.3 * (9.81 * 2.5_f64).sqrt() / 0.5;
    assert!((pass.truth.runs[0].start_s - steady_s).abs() < 1e-9);
    assert!(kinds(&pass.truth).contains(&RejectedKind::SpeedUp));
}

#[test]
fn missing_samples_end_a_decay_and_split_a_forced_run() {
    let pass = scene(
        "froude = 0.0\ngap = [ { start_s = 8.0, duration_s = 0.5 }, \
         { start_s = 40.0, duration_s = 1.0 } ]\naction = [ \
         { hold = { heel_deg = 10.0, duration_s = 2.0 } }, { release = { duration_s = 18.0 } }, \
         { catch = { duration_s = 5.0 } }, \
         { forced = { amplitude_deg = 5.0, frequency_rad_s = 6.0, duration_s = 30.0 } } ]",
    );
    let spans: Vec<_> = pass.truth.runs.iter().map(|r| (r.start_s, r.end_s)).collect();
    assert_eq!(spans, [(2.0, 8.0), (27.0, 40.0), (41.0, 55.0)]);
    let missing = |t: f64| (8.0..8.5).contains(&t) || (40.0..41.0).contains(&t);
    assert!(pass.samples.iter().all(|s| !missing(s.time_s)));
}

#[test]
fn hands_waves_and_zeros_leave_their_mark_on_the_right_channel() {
    let pass = scene(
        "froude = 0.0\nstatic_heel_deg = 0.5\nzero = { roll_deg = 0.2, moment_n_m = 0.3, \
         roll_drift_deg_per_s = 0.01 }\nwaves = { moment_n_m = 0.05, frequency_rad_s = 6.9, \
         decay_s = 100.0 }\naction = [ { rest = { duration_s = 10.0 } }, { rock = { \
         amplitude_deg = 6.0, frequency_rad_s = 6.9, duration_s = 5.0 } }, \
         { release = { duration_s = 20.0, fade_s = 0.3 } } ]",
    );
    assert!((roll_at(&pass, 0.0).to_degrees() - 0.7).abs() < 1e-9, "heel and zero at the start");
    let stirred = (0..1000).map(|k| roll_at(&pass, f64::from(k) * 0.01)).fold(0.0, f64::max);
    assert!(stirred.to_degrees() > 0.85, "waves near resonance roll the resting model");
    let moments = values(&pass, Quantity::Moment);
    assert!(moments.iter().all(|s| (s.value - 0.3).abs() < 1e-12), "a hand is not the rod");
    assert!((pass.truth.runs[0].start_s - 15.3).abs() < 1e-9);
    assert_eq!(kinds(&pass.truth), [RejectedKind::Rocked, RejectedKind::Held]);
}

#[test]
fn a_driven_model_settles_to_the_amplitude_that_its_damping_allows() {
    let pass = scene(
        "froude = 0.0\naction = [ { driven = { moment_n_m = 1.0, frequency_rad_s = 6.905, \
         duration_s = 60.0 } } ]",
    );
    let run = &pass.truth.runs[0];
    // At resonance M = I w A (b1 + 3/4 b3 w^2 A^2), CONVENTIONS section 2.
    let amplitude = (5000..6000).map(|k| roll_at(&pass, f64::from(k) * 0.01)).fold(0.0, f64::max);
    let w = 6.905_f64;
    let needed = run.inertia_kg_m2 * w * amplitude * (0.4 + 0.75 * 0.15 * (w * amplitude).powi(2));
    // Harmonic balance leaves out third harmonics of relative size b3 w A^2 / 32, under 0.1 %.
    assert!((needed - 1.0).abs() < 0.003, "{needed} N m");
    assert!(run.start_s > 20.0 && run.start_s < 30.0, "the start-up is not part of the run");
}
