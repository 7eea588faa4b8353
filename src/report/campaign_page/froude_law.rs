//! The fitted law of each condition (4.3).

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{estimate_cell, section, table};

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let laws = &page.results.froude_laws;
    let without: Vec<_> = page
        .conditions()
        .into_iter()
        .filter(|condition| laws.iter().all(|law| law.condition != *condition))
        .collect();
    if laws.is_empty() && without.is_empty() {
        return None;
    }
    let rows: Vec<_> = laws
        .iter()
        .map(|law| {
            html! {
                td { (law.condition) }
                (estimate_cell(Some(&law.b0_per_s)))
                (estimate_cell(Some(&law.kappa)))
                (estimate_cell(Some(&law.b3_s)))
                (estimate_cell(Some(&law.scatter_per_s)))
            }
        })
        .collect();
    let columns = [("Condition", ""), ("b₀", "1/s"), ("κ", "–"), ("b₃", "s"), ("s_{run}", "1/s")];
    let caption = "b₁(Fr) = b₀ (1 + κ Fr²), b₃ common to all speeds, s_{run} the run-to-run \
                   standard deviation of b₁. From the free decays; from forced runs where a \
                   condition has no decay.";
    Some(section(
        "froude-law",
        "Law of damping against Froude number",
        &html! {
            @if !rows.is_empty() { (table("froude-law-table", caption, &columns, &rows)) }
            @if !without.is_empty() {
                p.note {
                    "No law for " (without.join(", "))
                    ": it takes three runs or more at two Froude numbers or more."
                }
            }
        },
    ))
}
