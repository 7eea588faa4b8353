//! Decays that were repeated: their mean, how much they differ, how much they should.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{estimate_cell, number_cell, section, table};
use crate::report::number::{UNKNOWN, fixed, significant};
use crate::uncertainty;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let all = uncertainty::repeats(page.results);
    let rows: Vec<Markup> = all
        .iter()
        .filter(|repeats| repeats.runs.len() > 1)
        .map(|repeats| {
            let between = repeats.run_to_run_per_s;
            html! {
                td { (repeats.condition) }
                (number_cell(&fixed(repeats.froude, 3)))
                (number_cell(&repeats.runs.len().to_string()))
                (estimate_cell(repeats.damping_per_s.as_ref()))
                (number_cell(&between.map_or_else(|| UNKNOWN.to_owned(), |s| significant(s, 2))))
                (number_cell(&significant(repeats.own_per_s, 2)))
            }
        })
        .collect();
    let columns = [
        ("Condition", ""),
        ("Fr", "–"),
        ("Decays", ""),
        ("b_{eq}(5°)", "1/s"),
        ("s from run to run", "1/s"),
        ("own sd", "1/s"),
    ];
    let caption = "Decays repeated at one condition and speed, at 5 deg: their mean with scatter \
                   and noise, the standard deviation between them, that which each gives itself.";
    (!rows.is_empty())
        .then(|| section("repeats", "Repeats", &table("repeats-table", caption, &columns, &rows)))
}
