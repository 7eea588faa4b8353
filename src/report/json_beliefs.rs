//! What the evidence says of a decay's law, as the JSON contract writes it.

use serde::Serialize;

use crate::inverse::estimate::Estimate;
use crate::inverse::identification::{Beliefs, CurvePoint, FormBelief};

#[derive(Serialize)]
pub(super) struct CurvePointJson {
    rate_rad_per_s: f64,
    value: Estimate,
}

impl CurvePointJson {
    pub(super) fn new(point: &CurvePoint) -> Self {
        Self { rate_rad_per_s: point.rate_rad_per_s, value: point.damping_per_s2 }
    }
}

#[derive(Serialize)]
pub(super) struct BeliefsJson {
    forms: Vec<FormJson>,
    cubic_restoring: f64,
    k3_per_rad2: Estimate,
    misfit_orders: [f64; 3],
    coloured_noise: f64,
    quantum_rad: Option<f64>,
    n_effective: f64,
}

impl BeliefsJson {
    pub(super) fn new(beliefs: &Beliefs) -> Self {
        Self {
            forms: beliefs.forms.iter().map(FormJson::new).collect(),
            cubic_restoring: beliefs.cubic_restoring,
            k3_per_rad2: beliefs.k3_per_rad2,
            misfit_orders: beliefs.misfit_orders,
            coloured_noise: beliefs.coloured_noise,
            quantum_rad: beliefs.quantum_rad,
            n_effective: beliefs.n_effective,
        }
    }
}

#[derive(Serialize)]
struct FormJson {
    equation: &'static str,
    probability: f64,
    coefficients: Vec<CoefficientJson>,
}

impl FormJson {
    fn new(form: &FormBelief) -> Self {
        let coefficient = |&(symbol, unit, value): &(&'static str, &'static str, Estimate)| {
            CoefficientJson { symbol, unit, value }
        };
        Self {
            equation: form.equation,
            probability: form.probability,
            coefficients: form.coefficients.iter().map(coefficient).collect(),
        }
    }
}

#[derive(Serialize)]
struct CoefficientJson {
    symbol: &'static str,
    unit: &'static str,
    value: Estimate,
}
