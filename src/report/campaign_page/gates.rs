//! What the procedure of the field asks of the campaign, with the answers run by run summed up.

use maud::{Markup, html};

use super::CampaignPage;
use crate::procedure::{self, Answer, CampaignAnswer};
use crate::report::document::{number_cell, run_link, section, table};
use crate::report::gates::{COLUMNS, cells};
use crate::report::number::fixed;
use crate::results::IdentifiedRun;

/// Caption of what the runs of one speed are asked together.
const TOGETHER: &str = "What is asked of the runs of one condition at one speed together.";

/// Runs that miss a gate, named up to this many.
const N_NAMED: usize = 6;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let answered = |run| (run, procedure::of_run(page.campaign, run));
    let runs: Vec<(&IdentifiedRun, Vec<Answer>)> = page.results.runs.iter().map(answered).collect();
    let together = procedure::of_campaign(page.results);
    if runs.is_empty() {
        return None;
    }
    let summed = "Gates of ITTC 7.5-02-07-04.5 over all runs; the page of each run has its own \
                  numbers. They are advice: no run is refused for them.";
    let columns = [("Asked of a run", ""), ("Met", ""), ("Not met", ""), ("Can't tell", "")];
    let columns = [&columns[..], &[("Not met by", "")]].concat();
    let mut by_place = vec![("Condition", ""), ("Fr", "–")];
    by_place.extend(COLUMNS);
    let places: Vec<Markup> = together.iter().map(place).collect();
    Some(section(
        "gates",
        "Good practice",
        &html! {
            (table("gates-table", summed, &columns, &sums(&runs)))
            @if !places.is_empty() {
                (table("gates-together", TOGETHER, &by_place, &places))
            }
        },
    ))
}

fn place(at: &CampaignAnswer) -> Markup {
    html! { td { (at.condition) } (number_cell(&fixed(at.froude, 3))) (cells(&at.answer)) }
}

/// One row per gate, in the order in which runs meet them.
fn sums(runs: &[(&IdentifiedRun, Vec<Answer>)]) -> Vec<Markup> {
    let mut asked: Vec<&Answer> = Vec::new();
    for answer in runs.iter().flat_map(|(_, answers)| answers) {
        if !asked.iter().any(|known| known.gate.id == answer.gate.id) {
            asked.push(answer);
        }
    }
    let sum = |asked: &&Answer| {
        let with = |met: Option<bool>| -> Vec<&str> {
            let of = |answers: &[Answer]| {
                answers.iter().any(|answer| answer.gate.id == asked.gate.id && answer.met == met)
            };
            runs.iter().filter(|(_, answers)| of(answers)).map(|(run, _)| run.id.as_str()).collect()
        };
        let missed = with(Some(false));
        html! {
            td { (asked.gate.asks) }
            (number_cell(&with(Some(true)).len().to_string()))
            (number_cell(&missed.len().to_string()))
            (number_cell(&with(None).len().to_string()))
            td {
                @for (index, id) in missed.iter().take(N_NAMED).enumerate() {
                    @if index > 0 { ", " }
                    a href=(run_link(id)) { (id) }
                }
                @if missed.len() > N_NAMED { ", " (missed.len() - N_NAMED) " more" }
            }
        }
    };
    asked.iter().map(sum).collect()
}
