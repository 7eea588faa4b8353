//! `diagnose --json`: the versioned document that other programs read.

use serde_json::{Value, json};

use crate::diagnosis::{Diagnosis, Verdict};
use crate::inverse::estimate::Estimate;

/// The document; a campaign without runs has no causes and the verdict `unexplained`.
pub fn diagnosis_json(diagnosis: Option<&Diagnosis>) -> String {
    let document = diagnosis.map_or_else(
        || json!({"schema": SCHEMA, "verdict": "unexplained", "causes": [], "ranking": []}),
        document,
    );
    format!("{document:#}\n")
}

const SCHEMA: &str = "rolltank.diagnosis/1";

fn document(diagnosis: &Diagnosis) -> Value {
    let causes: Vec<Value> = diagnosis
        .causes
        .iter()
        .map(|cause| {
            let parameters: Vec<Value> = cause
                .parameters
                .iter()
                .map(|(symbol, unit, estimate)| {
                    let Estimate { mean, sd, lo95, hi95 } = estimate;
                    json!({"symbol": symbol, "unit": unit, "mean": mean, "sd": sd, "lo95": lo95, "hi95": hi95})
                })
                .collect();
            json!({
                "effect": cause.effect,
                "equation": cause.equation,
                "log10_bayes_factor": log10(cause.log_bayes_factor),
                "parameters": parameters,
                "equivalent_to": cause.equivalent_to,
            })
        })
        .collect();
    let ranking: Vec<Value> = diagnosis
        .ranking
        .iter()
        .map(|(effect, log)| json!({"effect": effect, "log10_bayes_factor": log10(*log)}))
        .collect();
    json!({"schema": SCHEMA, "verdict": word(diagnosis.verdict), "causes": causes, "ranking": ranking})
}

fn log10(natural: f64) -> f64 {
    natural / std::f64::consts::LN_10
}

/// The verdict in the contract's word.
pub(super) fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Adequate => "adequate",
        Verdict::Named => "named",
        Verdict::Ambiguous => "ambiguous",
        Verdict::Unexplained => "unexplained",
    }
}
