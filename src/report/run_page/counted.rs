//! What each instrument brought during the run, and what it did not.

use devices::channel::{Brought, Counts};
use maud::{Markup, html};

use super::RunPage;
use crate::report::document::{number_cell, section, table, text_cell};
use crate::report::number::{UNKNOWN, significant};

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let brought = &page.run.brought;
    let columns = [
        ("Channel", ""),
        ("Samples", ""),
        ("Lost", ""),
        ("Repeated", ""),
        ("Over range", ""),
        ("Damaged", ""),
        ("Clock", "± ms"),
    ];
    let rows: Vec<Markup> = brought
        .iter()
        .map(|Brought { quantity, counts, bound_s }| {
            let Counts { received, lost, repeated, over_range, damaged } = counts;
            html! {
                (text_cell(quantity.name()))
                @for count in [received, lost, repeated, over_range, damaged] {
                    (number_cell(&count.to_string()))
                }
                @let bound = bound_s.map(|bound_s| significant(1e3 * bound_s, 2));
                (number_cell(bound.as_deref().unwrap_or(UNKNOWN)))
            }
        })
        .collect();
    let caption = "Counted by the drivers from start to end of the run. What is over range is \
                   among the samples, but not used; what was repeated or damaged is not. Clock: \
                   its times are at most so far off, where it is known how late a filter makes \
                   them.";
    let is_whole = brought.iter().all(|channel| channel.counts.is_whole());
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
