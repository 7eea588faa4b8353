//! Tows the run that the program asks for, to see whether it decides what was undecided.

use std::path::Path;

use super::campaign::Campaign;
use super::folder::play;
use super::plan::Action;
use super::score::{Outcome, score};
use super::verdict::{Verdict, diagnose};

/// The outcome with the run that an ambiguous answer asks for; none where it asks for none, or
/// where only a static test would do.
pub(crate) fn towed(campaign: &Campaign, verdict: &Verdict, program: &Path) -> Option<Outcome> {
    let next = &verdict.json["next_run"];
    let number = |key: &str| next[key].as_f64();
    let amplitude_rad = number("amplitude_deg")?.to_radians();
    let action = match next["kind"].as_str()? {
        "decay" => Action::Decay { heel_rad: amplitude_rad },
        "forced" => {
            let frequency_rad_s = number("frequency_rad_s")?;
            Action::Forced { amplitude_rad, frequency_rad_s }
        }
        _ => return None,
    };
    if verdict.word != "ambiguous" {
        return None;
    }
    let longer = campaign.with_run(number("froude")?, action);
    let place = tempfile::tempdir().expect("a place for a campaign");
    let answer = diagnose(program, &play(&longer, place.path()).folder).ok()?;
    // No help for an answer that only happens to fit: the run was to part the names.
    Some(score(&answer, &campaign.asked.hidden, campaign.asked.set, |_, _| false))
}
