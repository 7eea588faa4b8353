//! Forced runs that do not repeat: swept, irregular, imposed by the rod or answered freely.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rolltank::inverse::identification::{Identification, Method};
use rolltank::inverse::{Setting, identify};
use rolltank::run::{Run, RunEnd, RunKind, Series, Timing};

const INERTIA_KG_M2: f64 = 1.675;
const RESTORING_N_M: f64 = 79.85;
const ROLL_NOISE_RAD: f64 = 5e-4;
const MOMENT_NOISE_N_M: f64 = 0.05;
const RATE_HZ: f64 = 100.0;
const SPAN_S: f64 = 40.0;

const SETTING: Setting =
    Setting { restoring_n_m_per_rad: RESTORING_N_M, exciter: None, method: Method::Exact, seed: 1 };

/// A sum of sines, each with amplitude, frequency [rad/s], its rate of change [rad/s2] and phase.
type Sines = Vec<[f64; 4]>;

#[derive(Debug, Clone, Copy)]
enum Course {
    Steady,
    Swept,
    Irregular,
}

fn sines(course: Course, size: f64, rng: &mut ChaCha8Rng) -> Sines {
    let phase = |rng: &mut ChaCha8Rng| std::f64::consts::TAU * rng.random::<f64>();
    match course {
        Course::Steady => vec![[size, 6.2, 0.0, phase(rng)]],
        Course::Swept => vec![[size, 4.5, 5.0 / SPAN_S, phase(rng)]],
        Course::Irregular => {
            (0..12).map(|i| [0.4 * size, 4.5 + 0.37 * f64::from(i), 0.0, phase(rng)]).collect()
        }
    }
}

/// Value, rate and acceleration of the sines.
fn at(sines: &Sines, t: f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for [a, w, sweep, phase] in sines {
        let (sin, cos) = ((w + 0.5 * sweep * t) * t + phase).sin_cos();
        let now = w + sweep * t;
        sum[0] += a * sin;
        sum[1] += a * now * cos;
        sum[2] += a * (sweep * cos - now * now * sin);
    }
    sum
}

#[derive(Debug, Clone, Copy)]
struct Damping {
    b1: f64,
    b3: f64,
}

/// Roll and moment at the samples, before any noise.
fn imposed(sines: &Sines, law: Damping, time_s: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let moment = |t: &f64| {
        let [roll, rate, acceleration] = at(sines, *t);
        let damping = law.b1 * rate + law.b3 * rate.powi(3);
        INERTIA_KG_M2 * (acceleration + damping) + RESTORING_N_M * roll
    };
    (time_s.iter().map(|t| at(sines, *t)[0]).collect(), time_s.iter().map(moment).collect())
}

/// The same where the sines are a moment [N m] and the model answers; trapezoidal steps.
fn answered(sines: &Sines, law: Damping, time_s: &[f64]) -> (Vec<f64>, Vec<f64>) {
    const N_STEPS: u32 = 40;
    let w2 = RESTORING_N_M / INERTIA_KG_M2;
    let force = |t: f64, roll: f64, rate: f64| {
        at(sines, t)[0] / INERTIA_KG_M2 - law.b1 * rate - law.b3 * rate.powi(3) - w2 * roll
    };
    let h = 1.0 / RATE_HZ / f64::from(N_STEPS);
    let (mut roll, mut rate) = (0.02, 0.0);
    let mut rolls = Vec::new();
    for &t in time_s {
        rolls.push(roll);
        for i in 0..N_STEPS {
            let now = t + h * f64::from(i);
            let (mut next_roll, mut next_rate) = (roll + h * rate, rate);
            for _ in 0..4 {
                let mean = force(now, roll, rate) + force(now + h, next_roll, next_rate);
                next_rate = rate + 0.5 * h * mean;
                next_roll = roll + 0.5 * h * (rate + next_rate);
            }
            (roll, rate) = (next_roll, next_rate);
        }
    }
    (rolls, time_s.iter().map(|t| at(sines, *t)[0]).collect())
}

fn run(roll: &[f64], moment: &[f64], time_s: &[f64], rng: &mut ChaCha8Rng) -> Run {
    let mut noisy = |values: &[f64], sd: f64| -> Vec<f64> {
        values.iter().map(|v| v + sd * rng.sample::<f64, _>(StandardNormal)).collect()
    };
    let series = |value: Vec<f64>| Series { time_s: time_s.to_vec(), value };
    Run {
        kind: RunKind::Forced,
        start_s: 0.0,
        end_s: SPAN_S,
        end: RunEnd::ExcitationChanged,
        speed_m_s: None,
        roll: series(noisy(roll, ROLL_NOISE_RAD).iter().map(|r| r + 0.004).collect()),
        drive: series(noisy(moment, MOMENT_NOISE_N_M)),
        speed: Series::default(),
        lead: Series::default(),
        still: None,
        excitation_rad_s: None,
        timing: Timing::default(),
    }
}

const CASES: [(Course, bool); 5] = [
    (Course::Swept, true),
    (Course::Irregular, true),
    (Course::Steady, false),
    (Course::Swept, false),
    (Course::Irregular, false),
];

fn drawn(course: Course, is_imposed: bool, seed: u64) -> (Run, Damping) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let law = Damping { b1: 0.3 + 0.8 * rng.random::<f64>(), b3: 0.6 * rng.random::<f64>() };
    let size = if is_imposed { 0.12 } else { 6.0 };
    let sines = sines(course, size, &mut rng);
    let n = (RATE_HZ * SPAN_S) as usize;
    let time_s: Vec<f64> = (0..n).map(|i| i as f64 / RATE_HZ).collect();
    let simulate = if is_imposed { imposed } else { answered };
    let (roll, moment) = simulate(&sines, law, &time_s);
    (run(&roll, &moment, &time_s, &mut rng), law)
}

/// By how much a moment is stamped late [s].
const LATE_S: f64 = 1e-4;

#[test]
fn a_moment_that_is_stamped_late_moves_the_damping_as_its_skew_says() {
    let courses = [(Course::Steady, Some(6.2)), (Course::Swept, None), (Course::Irregular, None)];
    for (course, excitation_rad_s) in courses {
        let (run, _) = drawn(course, true, 7);
        let run = Run { excitation_rad_s, ..run };
        let timing =
            Timing { roll_bound_s: Some(0.0), drive_bound_s: Some(3e-3), is_common: false };
        let untold = identify(&run, &SETTING).expect("the run can be identified");
        assert!(untold.skew.is_none() && untold.remarks.iter().any(|r| r.contains("no bound")));
        let told = identify(&Run { timing, ..run.clone() }, &SETTING).expect("it can");
        let skew = told.skew.expect("its bounds are stated");
        let mut late = run.clone();
        late.drive.time_s.iter_mut().for_each(|time_s| *time_s += LATE_S);
        let late = identify(&late, &SETTING).expect("it can still be identified");
        let five = |of: &Identification| {
            let all = &of.equivalent_damping;
            all.iter().find(|at| (at.amplitude_deg - 5.0).abs() < 0.1).unwrap().fitted_per_s
        };
        // Where the equivalent damping was taken, as the told numbers themselves say.
        let law = told.damping;
        let weight = (five(&told).mean - law.b1_per_s.mean) / law.b3_s.mean;
        let skewed = skew.damping_sd_per_s(weight);
        let (moved, promised) =
            (five(&late).mean - five(&untold).mean, skewed / skew.sd_s * LATE_S);
        println!("{course:?}: {moved:.6}, promised {promised:.6} 1/s");
        assert!((moved.abs() / promised - 1.0).abs() < 0.1, "{course:?}: {moved} {promised}");
        let wider = (five(&told).sd.powi(2) - five(&untold).sd.powi(2)).sqrt();
        assert!((wider - skewed).abs() < 0.05 * skewed, "{course:?}: {wider} and {skewed}");
        let width = |of: &Identification| of.moment.sd_per_s2.iter().sum::<f64>();
        assert!(width(&told) > 1.02 * width(&untold), "{course:?}: the band of the moment");
    }
}

#[test]
fn inertia_and_damping_are_covered_whatever_the_course() {
    let (mut held, mut n_runs) = ([0; 4], 0);
    for (course, is_imposed) in CASES {
        let mut here = [0; 4];
        for seed in 0..20 {
            let (run, law) = drawn(course, is_imposed, 100 + seed);
            let found = identify(&run, &SETTING).expect("the run can be identified");
            let inertia = found.inertia_kg_m2.expect("a forced run has one");
            let five =
                found.equivalent_damping.iter().find(|e| (e.amplitude_deg - 5.0).abs() < 0.1);
            let five = five.expect("five degrees are always reported").fitted_per_s;
            // Where the equivalent damping was taken: the difference of two of them tells.
            let three = found.equivalent_damping.iter().find(|e| e.amplitude_deg < 3.5).unwrap();
            let weight = |deg: f64| {
                let slope = (five.mean - three.fitted_per_s.mean) / found.damping.b3_s.mean;
                let square = |d: f64| d.to_radians().powi(2);
                slope * square(deg) / (square(5.0) - square(three.amplitude_deg))
            };
            let truth = law.b1 + weight(5.0) * law.b3;
            let told = [
                inertia.covers(INERTIA_KG_M2),
                found.damping.b1_per_s.covers(law.b1),
                found.damping.b3_s.covers(law.b3),
                five.covers(truth),
            ];
            for (here, told) in here.iter_mut().zip(told) {
                *here += usize::from(told);
            }
            n_runs += 1;
            assert!((inertia.mean / INERTIA_KG_M2 - 1.0).abs() < 0.01, "{inertia:?}");
            assert!(inertia.sd < 0.01 * INERTIA_KG_M2 && five.sd < 0.1 * five.mean, "{five:?}");
        }
        println!("{course:?}, imposed {is_imposed}: inertia, b1, b3, b_eq {here:?} of 20");
        for (held, here) in held.iter_mut().zip(here) {
            *held += here;
        }
    }
    println!("all: inertia, b1, b3, b_eq {held:?} of {n_runs}");
    for held in held {
        // 95 of a hundred, with a standard deviation of 2.2.
        assert!(held >= 88, "{held} of {n_runs}");
    }
}

#[test]
fn a_force_of_the_wrong_sign_or_a_thousand_times_too_large_is_refused() {
    for (course, is_imposed) in CASES {
        for factor in [-1.0, 1000.0] {
            let (mut run, _) = drawn(course, is_imposed, 7);
            for value in &mut run.drive.value {
                *value *= factor;
            }
            let reason = identify(&run, &SETTING).map(|found| found.inertia_kg_m2);
            let reason = reason.expect_err("no model has such a moment");
            assert!(reason.contains("hint") || reason.contains("cannot be fitted"), "{reason}");
        }
    }
}
