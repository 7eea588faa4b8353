//! The run that ended last: its coefficients with bands, its damping against amplitude.

use maud::{Markup, html};

use crate::report::campaign_page::CampaignPage;
use crate::report::document::{run_link, typeset};
use crate::report::number::fixed;
use crate::report::run_page::{RunPage, kind_name, live_parts};

pub(super) fn part(page: &CampaignPage) -> Markup {
    let Some(run) = page.results.runs.last() else {
        return html! { p.note { "No run has been identified yet." } };
    };
    let rejected = &page.results.rejected;
    let run_page = RunPage { campaign: page.campaign, run, overview: None, rejected };
    html! {
        p.lead {
            b { (run.id) } ": " (kind_name(run.run.kind)) ", " (run.condition) ", Fr "
            (typeset(&fixed(run.froude, 3))) " · "
            a href={ "/results/" (run_link(&run.id)) } { "whole page of this run" }
        }
        (live_parts(&run_page))
    }
}
