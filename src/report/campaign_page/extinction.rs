//! Coefficients of extinction of all decays, for those who write damping so.

use maud::{Markup, html};

use super::CampaignPage;
use crate::inverse::extinction::extinction;
use crate::report::document::{number_cell, run_link, section, short_estimate_cell, table};
use crate::report::number::fixed;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let rows: Vec<Markup> = page
        .results
        .runs
        .iter()
        .filter_map(|run| Some((run, extinction(&run.identification)?)))
        .map(|(run, fitted)| {
            let units = page.field_units(run);
            let at = units.at_comparison();
            let n = at.map(|at| units.bertin_n_per_deg(at.fitted_per_s, at.amplitude_deg));
            html! {
                td.name { a href=(run_link(&run.id)) { (run.id) } }
                td { (run.condition) }
                (number_cell(&fixed(run.froude, 3)))
                (short_estimate_cell(Some(&fitted.p)))
                (short_estimate_cell(Some(&fitted.q_per_deg)))
                (short_estimate_cell(n.as_ref()))
                (number_cell(&fitted.n_half_cycles.to_string()))
            }
        })
        .collect();
    let columns = [
        ("Run", ""),
        ("Condition", ""),
        ("Fr", "–"),
        ("p", "–"),
        ("q", "1/deg"),
        ("N(5°)", "1/deg"),
        ("Half cycles", ""),
    ];
    let caption = "Free decays: loss of amplitude over FULL cycles, Δφ/φ_{m} = p + q φ_{m}; \
                   Bertin's N of HALF cycles, Δφ = N φ_{m}², at 5 deg.";
    (!rows.is_empty()).then(|| {
        section(
            "extinctions",
            "Coefficients of extinction",
            &table("extinctions-table", caption, &columns, &rows),
        )
    })
}
