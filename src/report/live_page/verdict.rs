//! What the simulation gets wrong, in a line.

use maud::{Markup, html};

use crate::report::campaign_page::CampaignPage;
use crate::report::diagnosis_json::word;
use crate::report::diagnosis_text::meaning;

pub(super) fn part(page: &CampaignPage) -> Markup {
    let Some(diagnosis) = page.diagnosis else {
        return html! { p.note { "No run has been diagnosed yet." } };
    };
    let causes: Vec<&str> = diagnosis.causes.iter().map(|cause| cause.effect).collect();
    html! {
        p {
            b { (word(diagnosis.verdict)) } ": " (meaning(diagnosis.verdict))
            @if !causes.is_empty() { ": " (causes.join(", ")) }
        }
    }
}
