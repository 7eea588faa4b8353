//! What the extension gains on runs that took no part in its fit.

use maud::{Markup, html};

use super::DiagnosisPage;
use crate::report::document::{estimate_cell, section, table};

pub(super) fn part(page: &DiagnosisPage) -> Option<Markup> {
    if !page.is_extended() {
        return None;
    }
    let Some(gain) = &page.diagnosis.gain else {
        let told = html! { p { "With a single run nothing can be held out to measure a gain." } };
        return Some(section("gain", "Gain", &told));
    };
    let lines = [
        ("Roll error [deg]", &gain.rmse_deg),
        ("Log predictive density of a sample", &gain.log_density),
        ("Unexplained share of the moment", &gain.unexplained_share),
    ];
    let row = |(what, change): (&str, &crate::diagnosis::Change)| {
        html! {
            td { (what) }
            (estimate_cell(Some(&change.before)))
            (estimate_cell(Some(&change.after)))
        }
    };
    let caption = "Every run predicted by a fit to the others: mean over runs, with the 95 % \
                   interval that their differences show.";
    let columns = [("Held-out runs", ""), ("Before", ""), ("After", "")];
    Some(section("gain", "Gain", &table("gain-table", caption, &columns, &lines.map(row))))
}
