//! The fitted law of each condition (4.3).

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{estimate_cell, section, table};

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let laws = &page.results.froude_laws;
    if laws.is_empty() {
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
                   standard deviation of b₁.";
    Some(section(
        "froude-law",
        "Law of damping against Froude number",
        &table("froude-law-table", caption, &columns, &rows),
    ))
}
