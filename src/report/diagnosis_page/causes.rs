//! The causes with their equations and numbers, and what these runs cannot part from them.

use maud::{Markup, html};

use super::DiagnosisPage;
use crate::diagnosis::Cause;
use crate::report::diagnosis_json::{CUT_SHORT, log10, where_it_lives};
use crate::report::document::{estimate_cell, number_cell, section, table};
use crate::report::number::fixed;

/// Sets of parameters told of one effect; each run may have its own.
const SETS: usize = 12;

#[expect(clippy::unnecessary_wraps, reason = "every part of a page has one shape")]
pub(super) fn part(page: &DiagnosisPage) -> Option<Markup> {
    let told = page.diagnosis;
    let rows: Vec<Markup> = told.causes.iter().flat_map(rows).collect();
    let columns = [
        ("Effect", ""),
        ("Equation", ""),
        ("Not parted from", ""),
        ("log₁₀ BF", ""),
        ("Parameter", ""),
        ("Value", ""),
    ];
    let caption = "Effects in order of entry. BF: the Bayes factor for adding the effect; \
                   above 10³ it enters. Intervals are 95 %.";
    Some(section(
        "causes",
        "Cause",
        &html! {
            @if rows.is_empty() {
                p { "No effect was added to the simulation." }
            } @else {
                (table("causes-table", caption, &columns, &rows))
            }
            @if !told.suspects.is_empty() {
                p.warning {
                    "Explains a part, but not the whole, and is therefore not named: "
                    (told.suspects.join(", ")) "."
                }
            }
            @if !told.implausible.is_empty() {
                p.note {
                    "Would explain something, but only with impossible numbers: "
                    (told.implausible.join(", ")) "."
                }
            }
            @if told.cut_short {
                p.warning { (CUT_SHORT) "." }
            }
            p { "What remains: " (where_it_lives(&told.left_after)) "." }
        },
    ))
}

fn rows(cause: &Cause) -> Vec<Markup> {
    let n_told = cause.parameters.len().min(SETS);
    let row = |(i, (symbol, unit, estimate)): (usize, &(&str, &str, _))| {
        let first = i == 0;
        html! {
            td { @if first { b { (cause.effect) } } }
            td { @if first { (cause.equation) } }
            td { @if first { (cause.equivalent_to.join(", ")) } }
            @if first {
                (number_cell(&fixed(log10(cause.log_bayes_factor), 1)))
            } @else {
                td {}
            }
            td { (symbol) @if !unit.is_empty() { " [" (unit) "]" } }
            (estimate_cell(Some(estimate)))
        }
    };
    cause.parameters[..n_told].iter().enumerate().map(row).collect()
}
