//! The band of the equivalent damping beside that of a parametric fit which knows the law.

use faer::Mat;
use faer::linalg::solvers::Solve;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rolltank::inverse::identification::Method;
use rolltank::inverse::{Setting, identify};
use rolltank::run::{Run, RunEnd, RunKind, Series, Timing};

const SETTING: Setting =
    Setting { restoring_n_m_per_rad: 79.85, exciter: None, method: Method::Exact, seed: 1 };
const RATE_HZ: f64 = 100.0;
const NOISE_RAD: f64 = 8.7e-4;
const AMPLITUDE_RAD: f64 = 5.0 / 180.0 * std::f64::consts::PI;

/// Natural frequency [rad/s], `b1` [1/s], `b3` [s], initial roll [rad], initial rate [rad/s], zero
/// [rad].
type Unknowns = [f64; 6];

/// Decays of Table 2 at Fr 0 and 0.2: bare hull, then bilge keels; 15 deg at the start.
const ROWS: [(Unknowns, f64); 4] = [
    ([6.905, 0.3796, 0.1436, 0.26, 0.0, 0.004], 16.0),
    ([6.905, 0.420, 0.122, 0.26, 0.0, -0.002], 14.0),
    ([6.136, 1.2408, 0.6682, 0.26, 0.0, 0.001], 7.0),
    ([6.136, 1.326, 0.673, 0.26, 0.0, 0.0], 7.0),
];

/// Runs of each row.
const N_RUNS: usize = 25;

/// The roll [rad] of a decay, by the classical rule of Runge and Kutta.
fn roll(unknowns: &Unknowns, span_s: f64) -> Vec<f64> {
    let [w, b1, b3, mut x, mut v, zero] = *unknowns;
    let acceleration = |x: f64, v: f64| -w * w * x - b1 * v - b3 * v * v * v;
    let h = 1.0 / RATE_HZ;
    let mut rolls = Vec::new();
    for _ in 0..(span_s * RATE_HZ) as usize {
        rolls.push(x + zero);
        let (k1, l1) = (v, acceleration(x, v));
        let (k2, l2) = (v + 0.5 * h * l1, acceleration(x + 0.5 * h * k1, v + 0.5 * h * l1));
        let (k3, l3) = (v + 0.5 * h * l2, acceleration(x + 0.5 * h * k2, v + 0.5 * h * l2));
        let (k4, l4) = (v + h * l3, acceleration(x + h * k3, v + h * l3));
        x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        v += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
    }
    rolls
}

/// Standard deviation [1/s] of the equivalent damping from a least-squares fit that knows the law
/// and the noise: no unbiased fit can have a smaller one.
fn parametric_sd(unknowns: &Unknowns, span_s: f64) -> f64 {
    let derivatives: Vec<Vec<f64>> = (0..6)
        .map(|i| {
            let step = 1e-5;
            let moved = |by: f64| {
                let mut there = *unknowns;
                there[i] += by;
                roll(&there, span_s)
            };
            moved(step).iter().zip(moved(-step)).map(|(a, b)| (a - b) / (2.0 * step)).collect()
        })
        .collect();
    let dot = |i: usize, j: usize| {
        derivatives[i].iter().zip(&derivatives[j]).map(|(a, b)| a * b).sum::<f64>()
    };
    let information = Mat::from_fn(6, 6, dot);
    let weight = 0.75 * (unknowns[0] * AMPLITUDE_RAD).powi(2);
    let direction = Mat::from_fn(6, 1, |i, _| [0.0, 1.0, weight, 0.0, 0.0, 0.0][i]);
    let solved = information.full_piv_lu().solve(&direction);
    NOISE_RAD * (direction.transpose() * solved)[(0, 0)].sqrt()
}

#[test]
fn the_band_at_five_degrees_is_hardly_wider_than_that_of_a_fit_that_knows_the_law() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for (unknowns, span_s) in ROWS {
        let best_sd = parametric_sd(&unknowns, span_s);
        let mut ratios = Vec::new();
        for _ in 0..N_RUNS {
            let noise =
                |r: f64, rng: &mut ChaCha8Rng| r + NOISE_RAD * rng.sample::<f64, _>(StandardNormal);
            let value: Vec<f64> =
                roll(&unknowns, span_s).iter().map(|r| noise(*r, &mut rng)).collect();
            let time_s: Vec<f64> = (0..value.len()).map(|i| i as f64 / RATE_HZ).collect();
            let run = Run {
                kind: RunKind::Decay,
                start_s: 0.0,
                end_s: time_s[time_s.len() - 1],
                end: RunEnd::LostInNoise,
                speed_m_s: None,
                roll: Series { time_s, value },
                drive: Series::default(),
                speed: Series::default(),
                lead: Series::default(),
                still: None,
                excitation_rad_s: None,
                timing: Timing::default(),
            };
            let found = identify(&run, &SETTING).expect("a plain decay");
            let five = found
                .equivalent_damping
                .iter()
                .find(|e| (e.amplitude_deg - 5.0).abs() < 1e-9)
                .expect("five degrees are always reported")
                .fitted_per_s;
            let half_width = 0.5 * (five.hi95 - five.lo95) / 1.96;
            ratios.push(half_width / best_sd);
        }
        ratios.sort_by(f64::total_cmp);
        let (median, largest) = (ratios[N_RUNS / 2], ratios[N_RUNS - 1]);
        println!("half width over that of the fit: median {median:.3}, largest {largest:.3}");
        assert!(median < 1.3, "{ratios:?}");
    }
}
