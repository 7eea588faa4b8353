//! The run to make next: the plan's, and the one from which the diagnosis would learn most.

use maud::{Markup, html};

use crate::progress::progress;
use crate::report::campaign_page::CampaignPage;

pub(super) fn part(page: &CampaignPage) -> Markup {
    let progress = progress(page.campaign, &page.results.runs);
    let suggested = page.diagnosis.and_then(|diagnosis| diagnosis.next_run.as_ref());
    html! {
        @match progress.next.map(|index| &progress.rows[index]) {
            Some(row) => {
                p { b { "Plan: " } (row.words()) }
                p.note { (progress.n_done) " of " (progress.n_asked) " planned runs are done." }
            }
            None if progress.n_asked > 0 => {
                p { b { "The plan is done: " } (progress.n_done) " runs." }
            }
            None => p.note { "No test plan." },
        }
        @if let Some(suggested) = suggested {
            p { b { "The diagnosis suggests: " } (suggested.why) }
        }
    }
}
