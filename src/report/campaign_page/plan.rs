//! The test plan with what is done of it.

use maud::{Markup, html};

use super::CampaignPage;
use crate::progress::{Progress, RowProgress, progress};
use crate::report::document::{number_cell, run_link, section, table};
use crate::report::number::{UNKNOWN, fixed, significant};

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let progress = progress(page.campaign, &page.results.runs);
    if progress.rows.is_empty() {
        return None;
    }
    let rows: Vec<Markup> = progress.rows.iter().map(row).collect();
    let columns = [
        ("Condition", ""),
        ("Kind", ""),
        ("Fr", "–"),
        ("A", "deg"),
        ("ω", "rad/s"),
        ("Asked", ""),
        ("Done", ""),
        ("Runs", ""),
    ];
    let caption = "The plan row by row. A run counts for the row it fits best: Fr within 0.01, \
                   amplitude within 20 % or 1 deg, frequency within 2 %.";
    Some(section(
        "plan",
        "Test plan",
        &html! {
            p { (sentence(&progress)) }
            (table("plan-table", caption, &columns, &rows))
            @if !progress.unplanned.is_empty() {
                p.note { "Not in the plan: " (links(&progress.unplanned)) "." }
            }
        },
    ))
}

fn sentence(progress: &Progress) -> String {
    let Progress { n_done, n_asked, .. } = progress;
    let done = format!("{n_done} of {n_asked} runs asked for are done");
    match progress.next.map(|index| &progress.rows[index]) {
        None => format!("{done}."),
        Some(row) => format!("{done}; next: {}.", row.words()),
    }
}

fn row(row: &RowProgress) -> Markup {
    let known = |value: Option<f64>| {
        value.map_or_else(|| UNKNOWN.to_owned(), |value| significant(value, 4))
    };
    html! {
        td { (row.condition) }
        td { (row.kind) }
        (number_cell(&fixed(row.froude, 3)))
        (number_cell(&known(row.amplitude_deg)))
        (number_cell(&known(row.frequency_rad_s)))
        (number_cell(&row.asked.to_string()))
        (number_cell(&row.done.len().to_string()))
        td { (links(&row.done)) }
    }
}

fn links(ids: &[String]) -> Markup {
    html! {
        @for (index, id) in ids.iter().enumerate() {
            @if index > 0 { ", " }
            a href=(run_link(id)) { (id) }
        }
    }
}
