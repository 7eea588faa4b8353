//! Roll under the rod that does not repeat, through the run finder.

use devices::{Quantity, Sample};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rolltank::inverse::identification::Method;
use rolltank::inverse::{Setting, identify};
use rolltank::run::{Event, Limits, RunFinder, RunKind};

const INERTIA_KG_M2: f64 = 1.675;
const RESTORING_N_M: f64 = 79.85;
const B1_PER_S: f64 = 0.6;
const B3_S: f64 = 0.2;

/// Rest, the rod's course for `span_s` that comes in over 2 s and is stopped within half a second,
/// rest.
fn scene(span_s: f64, seed: u64, course: impl Fn(f64) -> f64) -> Vec<Sample> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut noise = |sd: f64| sd * rng.sample::<f64, _>(StandardNormal);
    // Without a jump of the acceleration, which no sample rate would resolve.
    let smooth = |s: f64| s.clamp(0.0, 1.0).powi(3) * (10.0 - 15.0 * s + 6.0 * s * s).max(0.0);
    let ease = |s: f64| if s >= 1.0 { 1.0 } else { smooth(s) };
    let fade = |t: f64| ease(t / 2.0) * ease((span_s - t) / 0.5);
    let roll = |t: f64| {
        let t = t - 10.0;
        if (0.0..span_s).contains(&t) { fade(t) * course(t) } else { 0.0 }
    };
    let step = 1e-3;
    let mut samples = Vec::new();
    for i in 0..((span_s + 25.0) * 100.0) as usize {
        let t = 0.01 * i as f64;
        let rate = (roll(t + step) - roll(t - step)) / (2.0 * step);
        let bend = (roll(t + step) - 2.0 * roll(t) + roll(t - step)) / (step * step);
        let damping = B1_PER_S * rate + B3_S * rate.powi(3);
        let moment = INERTIA_KG_M2 * (bend + damping) + RESTORING_N_M * roll(t);
        for (quantity, value) in [
            (Quantity::Roll, roll(t) + noise(5e-4)),
            (Quantity::Moment, moment + noise(0.05)),
            (Quantity::Speed, 0.99 + noise(1e-3)),
        ] {
            samples.push(Sample { quantity, time_s: t, value });
        }
    }
    samples
}

fn found(samples: &[Sample]) -> Vec<Event> {
    let mut finder = RunFinder::new(Limits {
        carriage_max_speed_m_s: Some(2.0),
        declared_speed_m_s: None,
        length_pp_m: 2.5,
        gravity_m_s2: 9.81,
    });
    let mut events = Vec::new();
    for sample in samples {
        finder.push(sample, &mut events);
    }
    finder.finish(&mut events);
    events
}

fn assert_one_run(samples: &[Sample], span_s: f64) {
    let events = found(samples);
    let runs: Vec<_> = events
        .iter()
        .filter_map(|event| match event {
            Event::Run(run) => Some(run),
            Event::Rejected(_) => None,
        })
        .collect();
    let told: Vec<String> = events
        .iter()
        .map(|event| match event {
            Event::Run(run) => {
                format!("{:?} {:.1}-{:.1} {:?}", run.kind, run.start_s, run.end_s, run.end)
            }
            Event::Rejected(r) => format!("{:.1}-{:.1}: {}", r.start_s, r.end_s, r.reason),
        })
        .collect();
    assert_eq!(runs.len(), 1, "{told:?}");
    let run = runs[0];
    assert_eq!((run.kind, run.excitation_rad_s), (RunKind::Forced, None), "{told:?}");
    assert!(run.end_s - run.start_s > 0.75 * span_s, "{told:?}");
    let setting = Setting {
        restoring_n_m_per_rad: RESTORING_N_M,
        exciter: None,
        method: Method::Exact,
        seed: 1,
    };
    let identification = identify(run, &setting).expect("the run can be identified");
    let inertia = identification.inertia_kg_m2.expect("a forced run has one");
    assert!((inertia.mean / INERTIA_KG_M2 - 1.0).abs() < 0.005, "{inertia:?}");
    let five = identification.equivalent_damping.iter().find(|e| e.amplitude_deg > 4.9);
    let five = five.expect("five degrees are always reported").fitted_per_s;
    assert!((five.mean / 0.65 - 1.0).abs() < 0.15, "{five:?}");
}

#[test]
fn a_sweep_is_one_run_and_gives_inertia_and_damping() {
    for seed in 0..4 {
        let rate = 0.1 + 0.02 * f64::from(seed as u32);
        let samples = scene(40.0, seed, |t| 0.12 * ((4.0 + 0.5 * rate * t) * t).sin());
        assert_one_run(&samples, 40.0);
    }
}

#[test]
fn an_irregular_course_is_one_run_and_gives_inertia_and_damping() {
    for seed in 0..4 {
        let mut rng = ChaCha8Rng::seed_from_u64(50 + seed);
        let sines: Vec<(f64, f64)> = (0..9)
            .map(|i| (4.8 + 0.31 * f64::from(i), std::f64::consts::TAU * rng.random::<f64>()))
            .collect();
        let course = |t: f64| sines.iter().map(|(w, p)| 0.05 * (w * t + p).sin()).sum();
        assert_one_run(&scene(50.0, seed, course), 50.0);
    }
}

#[test]
fn a_hand_on_the_rod_for_five_periods_is_no_run() {
    let events = found(&scene(5.0, 3, |t| 0.1 * (6.0 * t + 0.2 * t * t).sin()));
    assert!(events.iter().all(|event| matches!(event, Event::Rejected(_))), "{events:?}");
}
