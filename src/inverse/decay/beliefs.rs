//! What the evidence of a decay says of its law, its restoring and its noise.

use super::disturbance::Noise;
use super::fit::{CURVE, N_UNKNOWNS};
use super::form::{FORMS, Shape, power_unit};
use super::posterior::{DecayPosterior, Weighed};
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::{Beliefs, CurvePoint, FormBelief};
use crate::inverse::mixture::{self, Component};
use crate::inverse::record::Record;

/// Points of the damping curve, from nil to the largest rate of the run.
const N_POINTS: u32 = 16;

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

/// Symbol, unit and estimate of each coefficient of a form.
fn coefficients(
    posterior: &DecayPosterior,
    form: usize,
) -> Vec<(&'static str, &'static str, Estimate)> {
    let powers = match FORMS[form].shape {
        Shape::Powers(powers) => powers,
        Shape::PowerNear(_) => return power_law(posterior),
        Shape::Curve(_) => return Vec::new(),
    };
    let of = |(direction, power): (usize, &u8)| {
        let mut weights = vec![0.0; powers.len()];
        weights[direction] = power_unit(f64::from(*power), &posterior.linearised.scale);
        let components = posterior.coefficients(form, &weights);
        let (symbol, unit) = COEFFICIENTS[usize::from(*power) - 1];
        (!components.is_empty()).then(|| (symbol, unit, mixture::estimate(&components)))
    };
    powers.iter().enumerate().filter_map(of).collect()
}

/// Power and size of the power law, over all its nodes.
fn power_law(posterior: &DecayPosterior) -> Vec<(&'static str, &'static str, Estimate)> {
    let (mut powers, mut sizes) = (Vec::new(), Vec::new());
    for weighed in &posterior.solutions {
        let Shape::PowerNear(near) = FORMS[weighed.form].shape else { continue };
        let solution = &weighed.solution;
        let [size, bend] = [solution.coefficients[0], solution.coefficients[1]];
        // The power is a ratio of two coefficients; its spread is that of its tangent.
        let power = near + bend / size;
        let tangent = |f: &Vec<f64>| (f[1] - (bend / size) * f[0]) / size;
        let unit = power_unit(power, &posterior.linearised.scale);
        let sd_of = |part: &dyn Fn(&Vec<f64>) -> f64| {
            let square: f64 = solution.coefficient_factor.iter().map(|f| part(f).powi(2)).sum();
            (square * solution.noise_variance_rad2()).sqrt()
        };
        let slope = posterior.linearised.scale.rate_rad_per_s.ln();
        let weight = weighed.weight();
        powers.push(Component { weight, mean: power, sd: sd_of(&tangent) });
        let relative = |f: &Vec<f64>| f[0] / size - slope * tangent(f);
        sizes.push(Component { weight, mean: unit * size, sd: unit * size * sd_of(&relative) });
    }
    if powers.is_empty() {
        return Vec::new();
    }
    vec![("b", "s^(p-2)", mixture::estimate(&sizes)), ("p", "-", mixture::estimate(&powers))]
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
