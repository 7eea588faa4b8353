//! What the procedure of the field asks of the run, with the answers.

use maud::{Markup, html};

use super::RunPage;
use crate::procedure;
use crate::report::document::{section, table};
use crate::report::gates::{COLUMNS, cells};

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let answers = procedure::of_run(page.campaign, page.run);
    let rows: Vec<Markup> = answers.iter().map(cells).collect();
    let caption = "Gates of ITTC 7.5-02-07-04.5 for this run. They are advice: a run that misses \
                   one is used like any other.";
    let ours: Vec<&str> = answers
        .iter()
        .filter(|answer| answer.gate.source.contains("ours"))
        .map(|answer| answer.gate.asks)
        .collect();
    (!rows.is_empty()).then(|| {
        section(
            "gates",
            "Good practice",
            &html! {
                (table("gates-table", caption, &COLUMNS, &rows))
                @if !ours.is_empty() {
                    p.note {
                        "The procedure asks for these without a number, and the limit is ours: "
                        (ours.join("; ")) "."
                    }
                }
            },
        )
    })
}
