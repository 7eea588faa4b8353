//! Tows the runs that the program asks for, to see whether they decide what was undecided.

use std::path::Path;

use serde_json::Value;

use super::campaign::Campaign;
use super::folder::play;
use super::plan::Action;
use super::score::{Outcome, score};
use super::verdict::{Verdict, diagnose};

/// The outcome with the runs that an ambiguous answer asks for together; none where it asks for
/// none, or where only a static test would do.
pub(crate) fn towed(campaign: &Campaign, verdict: &Verdict, program: &Path) -> Option<Outcome> {
    if verdict.word != "ambiguous" {
        return None;
    }
    let next = &verdict.json["next_run"];
    let mut longer = with_run(campaign, next)?;
    if next["with"].is_object() {
        longer = with_run(&longer, &next["with"])?;
    }
    let place = tempfile::tempdir().expect("a place for a campaign");
    let answer = diagnose(program, &play(&longer, place.path()).folder).ok()?;
    // No help for an answer that only happens to fit: the runs were to part the names.
    Some(score(&answer, &campaign.asked.hidden, campaign.asked.set, |_, _| false))
}

fn with_run(campaign: &Campaign, run: &Value) -> Option<Campaign> {
    let amplitude_rad = run["amplitude_deg"].as_f64()?.to_radians();
    let action = match run["kind"].as_str()? {
        "decay" => Action::Decay { heel_rad: amplitude_rad },
        "forced" => {
            Action::Forced { amplitude_rad, frequency_rad_s: run["frequency_rad_s"].as_f64()? }
        }
        _ => return None,
    };
    Some(campaign.with_run(run["froude"].as_f64()?, action))
}
