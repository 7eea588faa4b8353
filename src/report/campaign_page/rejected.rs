//! Stretches that were not used, with their reasons: refusals first, changeovers folded.

use std::f64::consts::TAU;

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{number_cell, section, table};
use crate::report::number::fixed;
use crate::results::{IdentifiedRun, RejectedStretch};

/// Periods that a rod may take from one steady excitation to the next, or to rest.
const CHANGEOVER_PERIODS: f64 = 5.0;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let (refused, changeovers) = parted(page);
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

/// Refusals to be judged, then the short changeovers beside forced runs, each in order.
pub(super) fn parted<'a>(
    page: &CampaignPage<'a>,
) -> (Vec<&'a RejectedStretch>, Vec<&'a RejectedStretch>) {
    let runs = &page.results.runs;
    page.results.rejected.iter().partition(|stretch| {
        runs.iter()
            .filter(|run| run.recording == stretch.recording)
            .all(|run| !is_changeover(stretch, run))
    })
}

/// Whether the stretch is short and touches this forced run.
fn is_changeover(stretch: &RejectedStretch, run: &IdentifiedRun) -> bool {
    let Some(forced) = &run.identification.forced else { return false };
    let limit_s = CHANGEOVER_PERIODS * TAU / forced.frequency_rad_s.mean;
    let before = (run.run.start_s - stretch.end_s).abs();
    let after = (stretch.start_s - run.run.end_s).abs();
    stretch.end_s - stretch.start_s <= limit_s && before.min(after) <= limit_s
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
