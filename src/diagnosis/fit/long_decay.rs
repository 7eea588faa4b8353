//! A tanker that rolls at rest for a long time, for tests of what is fitted to it.

use super::run_fit::{RunState, predict};
use crate::diagnosis::record::observation::Observation;
use crate::model::lead::Lead;
use crate::model::{Base, Circumstances, Facts, Term};
use crate::run::RunKind;

pub(in crate::diagnosis) const NOISE_RAD: f64 = 5e-4;
pub(in crate::diagnosis) const N_SAMPLES: usize = 1000;

/// A tanker that rolls for 40 periods at rest, under a model that is not yet its own.
pub(in crate::diagnosis) fn long_decay(state: &RunState, terms: &[Term]) -> Observation {
    let at = Circumstances {
        kind: RunKind::Decay,
        froude: 0.0,
        speed_m_s: 0.0,
        natural_rad_s: 2.45,
        b1_per_s: 0.02,
        inertia_kg_m2: 135.6,
        amplitude_rad: state.own[0],
        rolling_rad_s: state.base.natural_rad_s,
        span_s: 100.0,
        gravity_m_s2: 9.81,
        clear_width_m: None,
        section: None,
        sample_rate_hz: 10.0,
        order: 0,
        has_moment: false,
        n_runs: 1,
        initial_roll_rad: state.own[0],
        rolled_for_s: f64::INFINITY,
        since_rest_s: 10.0,
    };
    let facts = Facts {
        quantum_rad: None,
        line: None,
        line_band_hz: [3.0, 5.0],
        n_samples: N_SAMPLES,
        sample_rate_hz: 10.0,
        froude: 0.0,
        clip: None,
    };
    let mut run = Observation {
        id: "long".to_owned(),
        condition: "bare hull".to_owned(),
        at,
        facts,
        origin_s: 0.0,
        roll_time_s: (0..N_SAMPLES).map(|k| 0.1 * k as f64).collect(),
        roll_rad: Vec::new(),
        moment_time_s: Vec::new(),
        moment_n_m: Vec::new(),
        lead: Lead::default(),
        wavering: None,
        rough_noise: [NOISE_RAD, 1.0],
        clock_bounds_s: [None; 2],
        start: state.own.clone(),
        base: Base { natural_rad_s: 2.45, b1_per_s: 0.02, b3_s: 0.1, log_scale: 0.0 },
    };
    let ripple = |k: usize| NOISE_RAD * std::f64::consts::SQRT_2 * (1.9 * k as f64).sin();
    let rolls = predict(&run, state, terms);
    run.roll_rad = rolls.into_iter().enumerate().map(|(k, roll)| roll + ripple(k)).collect();
    run
}
