//! Damping at each Froude number and against it, growing run by run.

use maud::{Markup, html};

use crate::report::campaign_page::{CampaignPage, live_parts};

pub(super) fn part(page: &CampaignPage) -> Markup {
    if page.results.runs.is_empty() {
        return html! { p.note { "No run has been identified yet." } };
    }
    html! {
        p.lead { a href="/results/index.html" { "whole report" } }
        (live_parts(page))
    }
}
