//! Every effect by its Bayes factor against the simulation as it was.

use maud::{Markup, html};

use super::DiagnosisPage;
use crate::report::diagnosis_json::log10;
use crate::report::document::{number_cell, section, table};
use crate::report::number::fixed;

pub(super) fn part(page: &DiagnosisPage) -> Option<Markup> {
    let row = |(effect, log): &(&str, f64)| {
        html! { td { (effect) } (number_cell(&fixed(log10(*log), 1))) }
    };
    let rows: Vec<Markup> = page.diagnosis.ranking.iter().map(row).collect();
    let caption = "log₁₀ of the Bayes factor for adding the one effect to the simulation as it \
                   was: by a full fit for the best, by one pass of sensitivities for the others.";
    (!rows.is_empty()).then(|| {
        let columns = [("Effect", ""), ("log₁₀ BF", "")];
        section("ranking", "Every effect", &table("ranking-table", caption, &columns, &rows))
    })
}
