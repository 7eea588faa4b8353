//! What the evidence of a decay says of its law, its restoring and its noise.

use super::disturbance::Noise;
use super::fit::{CURVE, N_UNKNOWNS};
use super::form::FORMS;
use super::posterior::{DecayPosterior, Weighed};
use crate::inverse::identification::{Beliefs, CurvePoint, FormBelief};
use crate::inverse::mixture::{self, Component};
use crate::inverse::record::Record;

/// Points of the damping curve, from nil to the largest rate of the run.
const N_POINTS: u32 = 24;

/// Symbols and units of the coefficients of each power of the rate.
const COEFFICIENTS: [(&str, &str); 3] = [("b1", "1/s"), ("b2", "1"), ("b3", "s")];

/// The beliefs of a posterior of a record.
pub(super) fn beliefs(posterior: &DecayPosterior, record: &Record) -> Beliefs {
    let coloured_noise = posterior.probability(|_, d| d.noise != Noise::White);
    let likeliest = &posterior.solutions[0];
    let noise = posterior.disturbances[likeliest.disturbance].noise;
    let n_values = posterior.columns.n_effective(noise);
    Beliefs {
        forms: forms(posterior),
        cubic_restoring: posterior.probability(|w, _| w.cubic_restoring),
        k3_per_rad2: mixture::estimate(&posterior.cubic_restoring()),
        misfit_orders: [1, 2, 3]
            .map(|order| posterior.probability(|_, d| d.misfit.is_some_and(|m| m.order == order))),
        coloured_noise,
        quantum_rad: record.quantum_rad,
        n_effective: n_values * record.n_averaged as f64,
    }
}

fn forms(posterior: &DecayPosterior) -> Vec<FormBelief> {
    let mut beliefs: Vec<FormBelief> = Vec::new();
    for (position, form) in FORMS.iter().enumerate() {
        let probability = posterior.probability(|w, _| w.form == position);
        match beliefs.iter_mut().find(|b| b.equation == form.equation) {
            Some(known) => known.probability += probability,
            None => beliefs.push(FormBelief {
                equation: form.equation,
                probability,
                coefficients: coefficients(posterior, position),
            }),
        }
    }
    beliefs
}

fn coefficients(
    posterior: &DecayPosterior,
    form: usize,
) -> Vec<(&'static str, &'static str, crate::inverse::estimate::Estimate)> {
    let of = |(direction, power): (usize, &u8)| {
        let mut weights = vec![0.0; FORMS[form].powers.len()];
        weights[direction] = FORMS[form].unit(direction, &posterior.linearised.scale);
        let components = posterior.coefficients(form, &weights);
        let (symbol, unit) = COEFFICIENTS[usize::from(*power) - 1];
        (!components.is_empty()).then(|| (symbol, unit, mixture::estimate(&components)))
    };
    FORMS[form].powers.iter().enumerate().filter_map(of).collect()
}

/// The damping moment against the roll rate, over all forms.
pub(super) fn damping_curve(posterior: &DecayPosterior) -> Vec<CurvePoint> {
    let scale = &posterior.linearised.scale;
    let point = |i: u32| {
        let rate_rad_per_s = scale.rate_rad_per_s * f64::from(i) / f64::from(N_POINTS);
        let mut weights = [0.0; N_UNKNOWNS];
        weights[CURVE..].copy_from_slice(&scale.moments(rate_rad_per_s));
        let components: Vec<Component> = posterior.combination(&weights);
        CurvePoint { rate_rad_per_s, damping_per_s2: mixture::estimate(&components) }
    };
    (0..=N_POINTS).map(point).collect()
}

/// Probability that the law leaves more than noise.
pub(super) fn misfit(posterior: &DecayPosterior) -> f64 {
    posterior.probability(|_: &Weighed, d| d.misfit.is_some())
}
