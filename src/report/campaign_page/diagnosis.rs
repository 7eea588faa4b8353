//! What the simulation gets wrong, in a line that leads to the page of the diagnosis.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::DIAGNOSIS_PAGE;
use crate::report::diagnosis_json::word;
use crate::report::diagnosis_text::meaning;
use crate::report::document::section;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let diagnosis = page.diagnosis?;
    let causes: Vec<&str> = diagnosis.causes.iter().map(|cause| cause.effect).collect();
    Some(section(
        "diagnosis",
        "What the simulation gets wrong",
        &html! {
            p {
                b { (word(diagnosis.verdict)) } ": " (meaning(diagnosis.verdict))
                @if !causes.is_empty() { ": " (causes.join(", ")) }
                ". " a href=(DIAGNOSIS_PAGE) { "Diagnosis with evidence, gain and next run" } "."
            }
        },
    ))
}
