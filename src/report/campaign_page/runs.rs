//! The table of all runs, each leading to its own page.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{estimate_cell, number_cell, run_link, section, table};
use crate::report::number::{fixed, significant};

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    if page.results.runs.is_empty() {
        return None;
    }
    let rows: Vec<_> = page
        .results
        .runs
        .iter()
        .map(|run| {
            let identification = &run.identification;
            let at = page.field_units(run).at_comparison();
            let rmse = identification.resimulation.rmse_rad.to_degrees();
            html! {
                td.name { a href=(run_link(&run.id)) { (run.id) } }
                td.number { (run.run.kind.name()) }
                td { (run.condition) }
                (number_cell(&fixed(run.froude, 3)))
                (estimate_cell(Some(&identification.natural_frequency_rad_s)))
                (estimate_cell(Some(&identification.damping.b1_per_s)))
                (estimate_cell(Some(&identification.damping.b3_s)))
                (estimate_cell(at.map(|at| &at.fitted_per_s)))
                (number_cell(&significant(rmse, 2)))
            }
        })
        .collect();
    let columns = [
        ("Run", ""),
        ("Kind", ""),
        ("Condition", ""),
        ("Fr", "–"),
        ("ω_{n}", "rad/s"),
        ("b₁", "1/s"),
        ("b₃", "s"),
        ("b_{eq}(5°)", "1/s"),
        ("rmse", "deg"),
    ];
    let caption = "All runs, in the order in which they ended. One forced run hardly parts b₁ \
                   from b₃; its b_{eq} at its own amplitude is in the table of forced runs.";
    Some(section("runs", "Runs", &table("runs-table", caption, &columns, &rows)))
}
