//! What the simulation gets wrong: verdict, causes, next run, what is left.

use maud::{Markup, html};

use super::{next, verdict};
use crate::report::campaign_page::CampaignPage;
use crate::report::diagnosis_page::live_parts;

pub(super) fn part(page: &CampaignPage) -> Markup {
    html! {
        (verdict::part(page))
        (next::part(page))
        @if let Some(diagnosis) = page.diagnosis {
            p.lead { a href="/results/diagnosis.html" { "whole diagnosis" } }
            (live_parts(diagnosis))
        }
    }
}
