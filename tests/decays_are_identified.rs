//! Decays of every kind through the identifier: what it finds, and what it says when it cannot.

use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rolltank::inverse::identification::{Identification, Method};
use rolltank::inverse::{Setting, identify};
use rolltank::run::{Run, RunEnd, RunKind, Series, Timing};

/// A decay `phi'' + b1 phi' + b2 phi'|phi'| + b3 phi'^3 + w^2 (phi + k3 phi^3) = 0`.
#[derive(Clone, Copy)]
struct Hull {
    w: f64,
    b1: f64,
    b2: f64,
    b3: f64,
    k3: f64,
}

const BARE: Hull = Hull { w: 6.905, b1: 0.4203, b2: 0.0, b3: 0.1219, k3: 0.0 };

impl Hull {
    /// Roll [rad] at `times_s` after a release from `heel_rad`, by Heun's method in small steps.
    fn roll(&self, heel_rad: f64, times_s: &[f64]) -> Vec<f64> {
        const STEP_S: f64 = 2e-4;
        let slope = |phi: f64, rate: f64| {
            let damping = self.b1 * rate + self.b2 * rate * rate.abs() + self.b3 * rate.powi(3);
            -damping - self.w * self.w * (phi + self.k3 * phi.powi(3))
        };
        let (mut now, mut phi, mut rate) = (0.0, heel_rad, 0.0);
        times_s
            .iter()
            .map(|&until| {
                while now < until {
                    let h = STEP_S.min(until - now);
                    let first = slope(phi, rate);
                    let (guess, guess_rate) = (phi + h * rate, rate + h * first);
                    let second = slope(guess, guess_rate);
                    phi += 0.5 * h * (rate + guess_rate);
                    rate += 0.5 * h * (first + second);
                    now += h;
                }
                phi
            })
            .collect()
    }
}

fn noisy(roll: &[f64], sd_rad: f64, seed: u64) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    roll.iter().map(|phi| phi + sd_rad * rng.sample::<f64, _>(StandardNormal)).collect()
}

fn decay(time_s: Vec<f64>, value: Vec<f64>) -> Run {
    Run {
        kind: RunKind::Decay,
        start_s: time_s[0],
        end_s: time_s[time_s.len() - 1],
        end: RunEnd::RecordingEnded,
        speed_m_s: None,
        roll: Series { time_s, value },
        drive: Series::default(),
        speed: Series::default(),
        lead: Series::default(),
        still: None,
        excitation_rad_s: None,
        timing: Timing::default(),
    }
}

const SETTING: Setting =
    Setting { restoring_n_m_per_rad: 79.85, exciter: None, method: Method::Exact, seed: 1 };

fn even(rate_hz: f64, span_s: f64) -> Vec<f64> {
    (0..=(rate_hz * span_s) as usize).map(|i| i as f64 / rate_hz).collect()
}

fn identified(hull: &Hull, time_s: &[f64], noise_rad: f64, seed: u64) -> Identification {
    let roll = noisy(&hull.roll(0.17, time_s), noise_rad, seed);
    identify(&decay(time_s.to_vec(), roll), &SETTING).expect("a plain decay")
}

/// 0.05 deg.
const NOISE_RAD: f64 = 8.7e-4;

#[test]
fn uneven_stamps_and_a_hole_change_no_answer_beyond_its_interval() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let times: Vec<f64> = even(100.0, 18.0)
        .into_iter()
        .map(|t| t + 0.003 * rng.random::<f64>())
        .filter(|t| !(4.0..5.3).contains(t))
        .collect();
    let found = identified(&BARE, &times, NOISE_RAD, 3);
    // Three standard deviations: a fixed seed that is no outlier.
    let near = |e: rolltank::inverse::estimate::Estimate, truth: f64| {
        assert!((e.mean - truth).abs() < 3.0 * e.sd, "{e:?} for {truth}");
    };
    near(found.damping.b1_per_s, BARE.b1);
    near(found.damping.b3_s, BARE.b3);
    near(found.natural_frequency_rad_s, BARE.w);
    assert!(found.damping.b1_per_s.sd < 0.01 * BARE.b1, "the hole costs little");
}

#[test]
fn the_same_run_at_100_hz_1_khz_and_5_khz_gives_the_same_damping() {
    let times = even(5000.0, 15.0);
    let roll = noisy(&BARE.roll(0.17, &times), NOISE_RAD * 50_f64.sqrt(), 11);
    // What an honest anti-aliasing filter and a slower clock make of it.
    let slowed = |width: usize| {
        let mean = |block: &[f64]| block.iter().sum::<f64>() / block.len() as f64;
        let blocks = |values: &[f64]| values.chunks_exact(width).map(mean).collect::<Vec<f64>>();
        let run = decay(blocks(&times), blocks(&roll));
        identify(&run, &SETTING).expect("a plain decay").equivalent_damping
    };
    let fast = slowed(1);
    for width in [5, 50] {
        for (slow, fast) in slowed(width).iter().zip(&fast).filter(|(_, fast)| !fast.extrapolated) {
            let apart = slow.fitted_per_s.mean - fast.fitted_per_s.mean;
            let at = slow.amplitude_deg;
            println!("{width}: {at} deg: {:.3} sd", apart / fast.fitted_per_s.sd);
            assert!(apart.abs() < 0.1 * fast.fitted_per_s.sd, "{at} deg: {apart} {fast:?}");
        }
    }
}

#[test]
fn a_hardening_restoring_is_noticed_and_the_small_angle_frequency_kept() {
    let hard = Hull { k3: 0.6, ..BARE };
    let found = identified(&hard, &even(100.0, 18.0), NOISE_RAD, 5);
    let frequency = found.natural_frequency_rad_s;
    assert!((frequency.mean - hard.w).abs() < 3.0 * frequency.sd, "{frequency:?}");
    let said = found.remarks.iter().any(|r| r.contains("frequency changes with amplitude"));
    assert!(said, "{:?}", found.remarks);
    let plain = identified(&BARE, &even(100.0, 18.0), NOISE_RAD, 5);
    assert!(!plain.remarks.iter().any(|r| r.contains("frequency changes")), "{:?}", plain.remarks);
}

#[test]
fn a_quadratic_law_is_named_and_the_equivalent_damping_holds_whatever_the_form() {
    let quadratic = Hull { b1: 0.1, b2: 0.6, b3: 0.0, ..BARE };
    let five_rad = 5_f64.to_radians();
    let truth = quadratic.b1 + 8.0 / (3.0 * std::f64::consts::PI) * quadratic.w * five_rad * 0.6;
    let times = even(100.0, 25.0);
    let (mut held, mut told) = (0, 0);
    for seed in 0..12 {
        let found = identified(&quadratic, &times, 0.2 * NOISE_RAD, seed);
        let five = found
            .equivalent_damping
            .iter()
            .find(|e| (e.amplitude_deg - 5.0).abs() < 1e-9)
            .expect("five degrees are always reported");
        held += usize::from(five.fitted_per_s.covers(truth));
        let named = "the evidence favours b1 phi' + b2 phi'|phi'| over";
        told += usize::from(found.remarks.iter().any(|r| r.contains(named)));
        let excused = found.remarks.iter().any(|r| r.contains("leaves more than noise"));
        assert!(!excused, "the law holds: {:?}", found.remarks);
    }
    assert_eq!(told, 12, "the quadratic part is far above this noise");
    // Of twelve, one may miss by chance.
    assert!(held >= 11, "{held} of 12");
}

#[test]
fn the_answer_does_not_depend_on_the_units_of_time() {
    let times = even(100.0, 12.0);
    let roll = noisy(&BARE.roll(0.17, &times), NOISE_RAD, 2);
    let slow: Vec<f64> = times.iter().map(|t| t * 8.0).collect();
    let fast = identify(&decay(times, roll.clone()), &SETTING).expect("a decay");
    let slow = identify(&decay(slow, roll), &SETTING).expect("the same decay, eight times slower");
    let ratio = fast.damping.b1_per_s.mean / slow.damping.b1_per_s.mean;
    assert!((ratio - 8.0).abs() < 1e-6, "{ratio}");
    let band = fast.moment.sd_per_s2[100] / slow.moment.sd_per_s2[100];
    assert!((band - 64.0).abs() < 1e-3, "{band}");
}

#[test]
fn what_is_no_decay_is_refused_with_its_reason() {
    let times = even(100.0, 10.0);
    let constant = decay(times.clone(), vec![0.1; times.len()]);
    let short = decay(times[..20].to_vec(), vec![0.1; 20]);
    let noise = decay(times.clone(), noisy(&vec![0.0; times.len()], NOISE_RAD, 4));
    let ramp = decay(times.clone(), times.iter().map(|t| 0.01 * t).collect());
    let coarse = BARE.roll(0.17, &times).iter().map(|r| (r / 0.06).round() * 0.06).collect();
    let coarse = decay(times.clone(), coarse);
    let half = BARE.roll(0.17, &even(100.0, 0.9));
    let half = decay(even(100.0, 0.9), noisy(&half, NOISE_RAD, 6));
    let cases = [
        (constant, "constant"),
        (short, "too few"),
        (ramp, "half cycles"),
        (coarse, "steps of 3.438 deg"),
        (half, "half cycles"),
    ];
    for (run, part) in cases {
        let reason = identify(&run, &SETTING).expect_err("nothing can be identified");
        assert!(reason.contains(part), "{reason}");
    }
    if let Ok(found) = identify(&noise, &SETTING) {
        assert!(found.damping.b1_per_s.mean.is_finite());
    }
}

/// Whether every number of an identification is one.
fn is_finite(found: &Identification) -> bool {
    let estimates = [
        found.damping.b1_per_s,
        found.damping.b3_s,
        found.natural_frequency_rad_s,
        found.roll_offset_rad,
        found.roll_noise_rad,
        found.initial_roll_rad,
    ];
    let curve = found.damping_curve.iter().map(|point| point.damping_per_s2);
    let equivalent = found.equivalent_damping.iter().map(|at| at.fitted_per_s);
    estimates
        .into_iter()
        .chain(curve)
        .chain(equivalent)
        .chain(found.inertia_kg_m2)
        .all(|e| e.mean.is_finite() && e.sd.is_finite() && e.lo95 <= e.hi95)
        && found.moment.mean_per_s2.iter().all(|u| u.is_finite())
        && found.moment.sd_per_s2.iter().all(|u| u.is_finite())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_finite_forced_record_gives_finite_numbers_or_a_reason(
        value in prop::collection::vec(-1.0..1.0_f64, 60..200),
        drive in prop::collection::vec(-1e4..1e4_f64, 200),
        swing in 0.0..0.3_f64,
        repeats in any::<bool>(),
    ) {
        let time_s: Vec<f64> = (0..value.len()).map(|i| 0.05 * i as f64).collect();
        let roll = value.iter().zip(&time_s).map(|(v, t)| 0.01 * v + swing * (5.0 * t).sin());
        let moment = drive.iter().zip(&time_s).map(|(v, t)| 1e-3 * v + 20.0 * (5.1 * t).sin());
        let run = Run {
            kind: RunKind::Forced,
            drive: Series { time_s: time_s.clone(), value: moment.collect() },
            speed: Series::default(),
            excitation_rad_s: repeats.then_some(5.0),
            timing: Timing::default(),
            ..decay(time_s.clone(), roll.collect())
        };
        match identify(&run, &SETTING) {
            Err(reason) => prop_assert!(!reason.is_empty()),
            Ok(found) => prop_assert!(is_finite(&found), "{found:?}"),
        }
    }

    #[test]
    fn any_finite_record_gives_finite_numbers_or_a_reason(
        value in prop::collection::vec(-1e3..1e3_f64, 30..120),
        steps in prop::collection::vec(1e-4..1.0_f64, 120),
    ) {
        let mut now = 0.0;
        let time_s: Vec<f64> = steps.iter().take(value.len()).map(|s| { now += s; now }).collect();
        match identify(&decay(time_s, value), &SETTING) {
            Err(reason) => prop_assert!(!reason.is_empty()),
            Ok(found) => prop_assert!(is_finite(&found), "{found:?}"),
        }
    }
}
