//! Tows the runs that the program asks for, to see whether they decide what was undecided.

use std::path::Path;

use serde_json::Value;

use super::campaign::Campaign;
use super::folder::play;
use super::plan::Action;
use super::score::{Outcome, score};
use super::verdict::{Verdict, diagnose};

/// The campaign with the runs that an ambiguous answer asks for together; none where it asks for
/// none that would part its class, or where only a static test would do.
pub(crate) fn towed(campaign: &Campaign, verdict: &Verdict) -> Option<Campaign> {
    if verdict.word != "ambiguous" {
        return None;
    }
    let next = &verdict.json["next_run"];
    if next["parts"].as_array().is_none_or(Vec::is_empty) {
        return None;
    }
    let longer = with_run(campaign, next)?;
    if next["with"].is_object() { with_run(&longer, &next["with"]) } else { Some(longer) }
}

/// Whether the runs that an ambiguous answer asks for part what hides from the rest of its class;
/// none where it asks for none. Another class, which no roll test may part, may be left.
pub(crate) fn decides(campaign: &Campaign, verdict: &Verdict, program: &Path) -> Option<bool> {
    let longer = towed(campaign, verdict)?;
    let place = tempfile::tempdir().expect("a place for a campaign");
    let Ok(answer) = diagnose(program, &play(&longer, place.path()).folder) else {
        return Some(false);
    };
    let asked = &campaign.asked;
    let parts = verdict.json["next_run"]["parts"].as_array()?;
    let is_part = |id: &String| parts.iter().any(|part| part.as_str() == Some(id));
    let is_parted = |hidden: &String| {
        let cause = answer.causes.iter().find(|cause| cause.effect == *hidden);
        cause.is_some_and(|cause| !cause.equivalent_to.iter().any(is_part))
    };
    let mut meant = asked.hidden.iter().filter(|id| is_part(id)).peekable();
    // No help for an answer that only happens to fit: the runs were to part the names.
    let outcome = score(&answer, &asked.hidden, asked.set, |_, _| false);
    let is_right = matches!(outcome, Outcome::Named | Outcome::InClass);
    Some(is_right && meant.peek().is_some() && meant.all(is_parted))
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
