//! One campaign from its draw to its score, as a line of the file of outcomes.

use std::cell::Cell;
use std::path::Path;

use serde_json::{Value, json};

use crate::bias;
use crate::coverage::covered;
use crate::hidden_tank::campaign::{Asked, Campaign};
use crate::hidden_tank::effects::labels::MISLABELLED;
use crate::hidden_tank::fit::{INDISTINGUISHABLE, left_by, misfit, misfit_beside};
use crate::hidden_tank::folder::play;
use crate::hidden_tank::foretold;
use crate::hidden_tank::next_run::decides;
use crate::hidden_tank::plan::Pass;
use crate::hidden_tank::score::{Outcome, score};
use crate::hidden_tank::verdict::{Verdict, diagnose};

/// The outcomes written so far; a line that was cut short is left out, and its cell run again.
pub(crate) fn read(file: &Path) -> Vec<Value> {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
}

/// What the base cannot take up of each hidden effect alone.
pub(crate) fn lambdas(campaign: &Campaign) -> Vec<f64> {
    // A wrong label belongs to the passes, and is the effect of none but itself.
    let well_labelled = well_labelled(campaign);
    let alone = campaign.effects.iter().map(|effect| {
        let with = if effect.row.id == MISLABELLED.id { campaign } else { &well_labelled };
        misfit(with, std::slice::from_ref(effect), None)
    });
    alone.map(|lambda| (lambda * 10.0).round() / 10.0).collect()
}

/// The campaign with the labels that belong to its passes.
fn well_labelled(campaign: &Campaign) -> Campaign {
    let passes = campaign.passes.iter().map(Pass::well_labelled).collect();
    Campaign { passes, ..campaign.clone() }
}

/// What the base with one of two hidden effects cannot take up of the other; nothing of one alone.
fn lambdas_beside(campaign: &Campaign) -> Vec<f64> {
    let [one, other] = &campaign.effects[..] else { return Vec::new() };
    let well_labelled = well_labelled(campaign);
    let beside = [(one, other), (other, one)].map(|(effect, known)| {
        if known.row.id == MISLABELLED.id {
            misfit(&well_labelled, std::slice::from_ref(effect), None)
        } else {
            misfit_beside(campaign, known)
        }
    });
    beside.map(|lambda| (lambda * 10.0).round() / 10.0).to_vec()
}

/// Draws, plays, diagnoses and scores a campaign; by what is asked briefly alone on request.
pub(crate) fn of(asked: &Asked, program: &Path, is_brief: bool) -> Value {
    let campaign = Campaign::draw(asked);
    let lambda = lambdas(&campaign);
    let lambda_beside = lambdas_beside(&campaign);
    let place = tempfile::tempdir().expect("a place for a campaign");
    let played = play(&campaign, place.path());
    let (answer, seconds) = timed(|| diagnose(program, &played.folder));
    let mut line = json!({
        "name": asked.name(), "hidden": asked.hidden, "size": asked.size,
        "set": asked.set.name(), "seed": asked.seed, "scatter": asked.scatter,
        "keels": campaign.keels, "lambda": lambda, "truth": bias::truth(&campaign),
        "lambda_beside": lambda_beside, "seconds": seconds,
    });
    let verdict = match answer {
        Ok(verdict) => verdict,
        Err(complaint) => {
            line["outcome"] = json!("failed");
            line["complaint"] = json!(complaint);
            return line;
        }
    };
    let stood_for = Cell::new(Value::Null);
    let outcome = score(&verdict, &asked.hidden, asked.set, |cause, hidden| {
        let left = left_by(&campaign, cause, hidden);
        stood_for.set(json!({ "cause": cause, "hidden": hidden, "lambda_left": left }));
        left < INDISTINGUISHABLE
    });
    line["verdict"] = json!(verdict.word);
    line["causes"] =
        verdict.causes.iter().map(|cause| json!(cause.effect)).collect::<Vec<_>>().into();
    line["equivalent_to"] =
        verdict.causes.iter().map(|cause| json!(cause.equivalent_to)).collect::<Vec<_>>().into();
    line["outcome"] = json!(word(outcome));
    line["stands_for"] = stood_for.take();
    line["values"] =
        campaign.effects.iter().map(|effect| json!(effect.values)).collect::<Vec<_>>().into();
    line["covered"] = covered(&campaign, &verdict.json["causes"]);
    tell(&mut line, &verdict);
    if is_brief {
        return line;
    }
    if matches!(outcome, Outcome::Named | Outcome::InClass) {
        line["foretold_rmse_deg"] =
            json!(foretold::rmse_deg(&campaign, &foretold::stretches(&verdict.json)));
    }
    line["decided"] = json!(decides(&campaign, &verdict, program));
    line
}

/// What else of the answer the tables need.
fn tell(line: &mut Value, verdict: &Verdict) {
    let json = &verdict.json;
    line["parameters"] = json["causes"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|cause| cause["parameters"].clone())
        .collect::<Vec<_>>()
        .into();
    for part in ["gain", "bias", "next_run"] {
        line[part] = json[part].clone();
    }
}

/// The result with the seconds that it took.
#[expect(clippy::disallowed_methods, reason = "the speed is part of what is judged")]
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = std::time::Instant::now();
    let result = work();
    (result, (start.elapsed().as_secs_f64() * 1000.0).round() / 1000.0)
}

/// The word of an outcome in file and tables.
fn word(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Named => "named",
        Outcome::InClass => "in class",
        Outcome::Partly => "partly",
        Outcome::WithMore => "with more",
        Outcome::WrongName => "wrong name",
        Outcome::Adequate => "adequate",
        Outcome::Unexplained => "unexplained",
    }
}
