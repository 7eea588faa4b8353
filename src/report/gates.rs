//! Answers of the procedure's gates as cells of a table.

use maud::{Markup, html};

use super::document::number_cell;
use super::notation;
use super::number::{UNKNOWN, fixed, significant};
use crate::procedure::Answer;

/// Whether a gate is met, as a word with a mark that needs no colour.
pub(super) fn verdict(met: Option<bool>) -> &'static str {
    match met {
        Some(true) => "✓ met",
        Some(false) => "✗ not met",
        None => "? can't tell",
    }
}

/// Columns of [`cells`].
pub(super) const COLUMNS: [(&str, &str); 5] =
    [("Asked", ""), ("Limit", ""), ("Found", ""), ("", ""), ("In words", "")];

/// The cells of one answer.
pub(super) fn cells(answer: &Answer) -> Markup {
    let unit = match answer.gate.unit {
        "–" => "",
        unit => unit,
    };
    let number = |value: Option<f64>| match value {
        // A count, whole where it is one.
        Some(value) if unit.is_empty() => fixed(value, 1).trim_end_matches(".0").to_owned(),
        Some(value) => format!("{} {unit}", significant(value, 3)),
        None => UNKNOWN.to_owned(),
    };
    html! {
        td { (notation::html(answer.gate.asks)) }
        (number_cell(&number(answer.limit)))
        (number_cell(&number(answer.value)))
        td.name { (verdict(answer.met)) }
        td { (answer.words) }
    }
}
