//! Stretches that were not used, with their reasons: refusals first, changeovers folded.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{number_cell, section, table};
use crate::report::number::fixed;
use crate::results::RejectedStretch;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let (refused, changeovers) = page.results.refusals_and_changeovers();
    if refused.is_empty() && changeovers.is_empty() {
        return None;
    }
    Some(section(
        "rejected",
        "Stretches not used",
        &html! {
            @if refused.is_empty() {
                p { "Nothing was refused but changeovers between excitations." }
            } @else {
                (stretches("rejected-table", "Refused stretches.", &refused))
            }
            @if !changeovers.is_empty() {
                details {
                    summary {
                        (changeovers.len()) " changeovers: the rod starts, stops or goes over to "
                        "another excitation beside a run that was used; rejected.csv lists them too"
                    }
                    (stretches("changeover-table", "Changeovers.", &changeovers))
                }
            }
        },
    ))
}

fn stretches(id: &str, caption: &str, stretches: &[&RejectedStretch]) -> Markup {
    let rows: Vec<_> = stretches
        .iter()
        .map(|stretch| {
            html! {
                td { (stretch.recording) }
                (number_cell(&fixed(stretch.start_s, 2)))
                (number_cell(&fixed(stretch.end_s, 2)))
                td { (stretch.reason) }
            }
        })
        .collect();
    let columns = [("Recording", ""), ("From", "s"), ("To", "s"), ("Reason", "")];
    table(id, caption, &columns, &rows)
}
