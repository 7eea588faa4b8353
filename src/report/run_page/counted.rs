//! What each instrument brought during the run, and what it did not.

use devices::channel::Counts;
use maud::{Markup, html};

use super::RunPage;
use crate::report::document::{number_cell, section, table, text_cell};

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let counts = &page.run.counts;
    let columns = [
        ("Channel", ""),
        ("Samples", ""),
        ("Lost", ""),
        ("Repeated", ""),
        ("Over range", ""),
        ("Damaged", ""),
    ];
    let rows: Vec<Markup> = counts
        .iter()
        .map(|(quantity, counts)| {
            let Counts { received, lost, repeated, over_range, damaged } = counts;
            html! {
                (text_cell(quantity.name()))
                @for count in [received, lost, repeated, over_range, damaged] {
                    (number_cell(&count.to_string()))
                }
            }
        })
        .collect();
    let caption = "Counted by the drivers from start to end of the run. What is over range is \
                   among the samples, but not used; what was repeated or damaged is not.";
    let is_whole = counts.iter().all(|(_, counts)| counts.is_whole());
    (!rows.is_empty()).then(|| {
        section(
            "counted",
            "What the instruments brought",
            &html! {
                (table("counted-table", caption, &columns, &rows))
                @if is_whole { p.note { "Every sample came, and none was over range." } }
            },
        )
    })
}
