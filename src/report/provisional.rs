//! What is told of a run before its end is known, and how it is marked.

use maud::{Markup, html};
use serde_json::{Value, json};

use super::json::identification_json;
use super::number::{estimate_within, fixed};
use super::run_page::kind_name;
use crate::campaign::Campaign;
use crate::results::{IdentifiedRun, Results};
use crate::run::RunEnd;

/// Id of the run under way; no run that has ended has it.
pub const PROVISIONAL_ID: &str = "provisional";

/// The file of its numbers.
pub const PROVISIONAL_FILE: &str = "provisional.json";

/// Name and version of the form of that file.
const PROVISIONAL_NAME: &str = "rolltank.provisional/1";

/// How sure it is that the run is over.
fn state(run: &IdentifiedRun) -> &'static str {
    match run.run.end {
        RunEnd::RecordingEnded => "still under way",
        _ => "waiting to be sure that it is over",
    }
}

/// The run under way in one line.
pub fn provisional_words(run: &IdentifiedRun) -> String {
    let kind = kind_name(run.run.kind);
    let length_s = fixed(run.run.end_s - run.run.start_s, 1);
    let damping = run.at_comparison().map_or_else(String::new, |at| {
        format!(", b_eq at 5 deg = {} 1/s", estimate_within(&at.fitted_per_s, 3))
    });
    let froude = fixed(run.froude, 3);
    format!("{kind}, Fr {froude}, {length_s} s so far{damping}; {}", state(run))
}

/// The numbers of the run under way: its state, and its identification by the JSON contract.
pub fn provisional_json(campaign: &Campaign, run: &IdentifiedRun) -> String {
    let alone = Results { runs: vec![run.clone()], ..Results::default() };
    let identification = identification_json(campaign, &alone);
    let identification: Value = serde_json::from_str(&identification).unwrap_or_default();
    let document = json!({
        "schema": PROVISIONAL_NAME,
        "state": state(run),
        "identification": identification,
    });
    document.to_string()
}

/// What stands at the head of its page.
pub(super) fn banner(run: &IdentifiedRun) -> Option<Markup> {
    (run.id == PROVISIONAL_ID).then(|| {
        html! {
            p.warning {
                "Provisional: the run is " (state(run)) ". This page holds it up to "
                (fixed(run.run.end_s, 1)) " s, is in no table and no law of the campaign, and "
                "gives way to the run's own when its end is known."
            }
        }
    })
}
