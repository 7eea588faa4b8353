//! `diagnose --json`: the versioned document that other programs read.

use serde_json::{Map, Value, json};

use crate::diagnosis::{
    Bias, Cause, Change, Diagnosis, Gain, Leftover, NextRun, PlannedRun, Unexplained, Verdict,
};
use crate::inverse::estimate::Estimate;
use crate::model::effects::UNTESTABLE;

/// Name and version of the contract.
const SCHEMA_NAME: &str = "rolltank.diagnosis/1";

/// The JSON Schema that every [`diagnosis_json`] keeps.
pub const DIAGNOSIS_SCHEMA: &str = include_str!("diagnosis.schema.json");

/// What is told of a search that ended early.
pub(super) const CUT_SHORT: &str =
    "The search for causes ended at what it may cost; fewer runs are searched to the end";

/// The document; a campaign without runs has neither verdict nor causes.
pub fn diagnosis_json(diagnosis: Option<&Diagnosis>) -> String {
    let untestable: Vec<Value> =
        UNTESTABLE.iter().map(|(effect, why)| json!({"effect": effect, "why": why})).collect();
    let document = match diagnosis {
        None => json!({
            "schema": SCHEMA_NAME, "verdict": null, "causes": [], "suspects": [],
            "implausible": [], "cut_short": false, "ranking": [], "gain": null, "bias": null,
            "next_run": null,
            "residual": null, "untestable": untestable,
        }),
        Some(diagnosis) => json!({
            "schema": SCHEMA_NAME,
            "verdict": word(diagnosis.verdict),
            "causes": diagnosis.causes.iter().map(cause).collect::<Vec<_>>(),
            "suspects": diagnosis.suspects,
            "implausible": diagnosis.implausible,
            "cut_short": diagnosis.cut_short,
            "ranking": ranking(diagnosis),
            "gain": diagnosis.gain.as_ref().map(gain),
            "bias": bias(&diagnosis.bias),
            "next_run": diagnosis.next_run.as_ref().map(next_run),
            "residual": residual(diagnosis),
            "untestable": untestable,
        }),
    };
    format!("{document:#}\n")
}

fn quantity(estimate: &Estimate) -> Value {
    let Estimate { mean, sd, lo95, hi95 } = estimate;
    json!({"mean": mean, "sd": sd, "lo95": lo95, "hi95": hi95})
}

fn cause(cause: &Cause) -> Value {
    let parameters: Vec<Value> = cause
        .parameters
        .iter()
        .map(|(symbol, unit, estimate)| {
            let mut object = quantity(estimate);
            object["symbol"] = json!(symbol);
            object["unit"] = json!(unit);
            object
        })
        .collect();
    json!({
        "effect": cause.effect,
        "equation": cause.equation,
        "log10_bayes_factor": log10(cause.log_bayes_factor),
        "parameters": parameters,
        "equivalent_to": cause.equivalent_to,
    })
}

fn ranking(diagnosis: &Diagnosis) -> Vec<Value> {
    let line =
        |(effect, log): &(&str, f64)| json!({"effect": effect, "log10_bayes_factor": log10(*log)});
    diagnosis.ranking.iter().map(line).collect()
}

/// A figure before and after: means over runs with their 95 % intervals.
fn means(change: &Change) -> Value {
    json!({
        "before": change.before.mean,
        "after": change.after.mean,
        "before_95": [change.before.lo95, change.before.hi95],
        "after_95": [change.after.lo95, change.after.hi95],
    })
}

fn gain(gain: &Gain) -> Value {
    json!({
        "held_out_rmse_deg": means(&gain.rmse_deg),
        "held_out_log_predictive_density": means(&gain.log_density),
        "log_predictive_density_gain": quantity(&gain.log_density_gain),
        "unexplained_moment_share": means(&gain.unexplained_share),
    })
}

fn quantities(change: &Change) -> Value {
    json!({"before": quantity(&change.before), "after": quantity(&change.after)})
}

/// The first condition under the contract's keys, and every condition under its name.
fn bias(all: &[Bias]) -> Value {
    let one = |bias: &Bias| {
        let mut object = Map::new();
        object.insert("b1_per_s".to_owned(), quantities(&bias.b1_per_s));
        object.insert("b3_s".to_owned(), quantities(&bias.b3_s));
        let kappa = bias.kappa.as_ref().map_or(Value::Null, quantities);
        object.insert("kappa".to_owned(), kappa);
        Value::Object(object)
    };
    let Some(first) = all.first() else { return Value::Null };
    let mut whole = one(first);
    let by_condition: Map<String, Value> =
        all.iter().map(|bias| (bias.condition.clone(), one(bias))).collect();
    whole["by_condition"] = Value::Object(by_condition);
    whole
}

/// The contract's keys of the run beside those of the choice.
fn next_run(next: &NextRun) -> Value {
    let mut object = planned_run(&next.run);
    object.insert("with".to_owned(), next.with.as_ref().map(planned_run).into());
    object.insert("parts".to_owned(), json!(next.parts));
    let log = log10(next.expected_log_bayes_factor);
    object.insert("expected_log10_bayes_factor".to_owned(), json!(log));
    object.insert("decides".to_owned(), json!(next.decides));
    object.insert("why".to_owned(), json!(next.why));
    Value::Object(object)
}

fn planned_run(run: &PlannedRun) -> Map<String, Value> {
    let mut object = Map::new();
    object.insert("kind".to_owned(), json!(run.kind));
    object.insert("froude".to_owned(), json!(run.froude));
    object.insert("frequency_rad_s".to_owned(), json!(run.frequency_rad_s));
    object.insert("amplitude_deg".to_owned(), json!(run.amplitude_deg));
    object
}

fn residual(diagnosis: &Diagnosis) -> Value {
    let line = |left: &Leftover| {
        json!({
            "run": left.run,
            "channel": left.channel,
            "rms": left.rms,
            "share": left.share,
            "is_sure": left.is_sure(),
            "band_z": left.band_z,
            "line_log_odds": left.line_log_odds,
            "whiteness_z": left.whiteness_z,
            "frequency_rad_s": left.frequency_rad_s,
            "time_s": left.time_s,
            "amplitude_rad": left.amplitude_rad,
        })
    };
    json!({
        "summary": where_it_lives(&diagnosis.left_after),
        "before": diagnosis.left_before.iter().map(line).collect::<Vec<_>>(),
        "after": diagnosis.left_after.iter().map(line).collect::<Vec<_>>(),
        "moment_before": moments(&diagnosis.unexplained_before),
        "moment_after": moments(&diagnosis.unexplained_after),
    })
}

/// The moment that each run leaves, with its band.
fn moments(left: &[Unexplained]) -> Vec<Value> {
    let one = |left: &Unexplained| {
        json!({
            "run": left.run,
            "share": left.share,
            "share_of_damping": left.share_of_damping,
            "share_of_instants_outside": left.outside,
            "time_s": left.time_s.iter().map(|t| (t * 1e4).round() / 1e4).collect::<Vec<_>>(),
            "roll_rad": brief(&left.roll_rad),
            "roll_rate_rad_per_s": brief(&left.rate_rad_per_s),
            "roll_acceleration_rad_per_s2": brief(&left.acceleration_rad_per_s2),
            "mean_n_m": brief(&left.mean_n_m),
            "sd_n_m": brief(&left.sd_n_m),
        })
    };
    left.iter().map(one).collect()
}

/// The same to five figures: histories are most of the file, and nobody knows them any better.
fn brief(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| format!("{value:.4e}").parse().unwrap_or(*value)).collect()
}

/// Where most is left, in words.
pub(super) fn where_it_lives(left: &[Leftover]) -> String {
    let most =
        left.iter().filter(|left| left.is_sure()).max_by(|a, b| a.excess.total_cmp(&b.excess));
    most.map_or_else(
        || "nothing but noise is left".to_owned(),
        |most| {
            let n_sure = left.iter().filter(|left| left.is_sure()).count();
            format!(
                "structure is left in {n_sure} of {} channels; most in the {} of run {}: about \
                 {:.1} s of its recording, strongest at {:.2} rad/s, at roll amplitudes near \
                 {:.1} deg",
                left.len(),
                most.channel,
                most.run,
                most.time_s,
                most.frequency_rad_s,
                most.amplitude_rad.to_degrees()
            )
        },
    )
}

pub(super) fn log10(natural: f64) -> f64 {
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
