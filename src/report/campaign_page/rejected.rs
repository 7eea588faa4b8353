//! Stretches that were not used, with their reasons.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{number_cell, section, table};
use crate::report::number::fixed;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    if page.results.rejected.is_empty() {
        return None;
    }
    let rows: Vec<_> = page
        .results
        .rejected
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
    Some(section(
        "rejected",
        "Stretches not used",
        &table("rejected-table", "Rejected stretches.", &columns, &rows),
    ))
}
