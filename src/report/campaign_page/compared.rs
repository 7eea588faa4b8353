//! Conditions against each other at each speed, with the probability that they differ.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{estimate_cell, number_cell, section, short_estimate_cell, table};
use crate::report::number::{UNKNOWN, fixed, significant};
use crate::uncertainty::{self, Basis, Comparison};

/// Probability from which on a sign is called known.
const KNOWN: f64 = 0.975;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let all = uncertainty::comparisons(page.results);
    let notes = notes(&all);
    if all.is_empty() {
        return None;
    }
    let rows: Vec<Markup> = all.iter().map(row).collect();
    let columns = [
        ("Second against first", ""),
        ("A", "deg"),
        ("Fr", "–"),
        ("Difference", "1/s"),
        ("of the first", "%"),
        ("P(second larger)", ""),
        ("", ""),
    ];
    let caption = "b_{eq} of the second condition less that of the first at roll amplitude A, \
                   from the free decays that reach it, and the posterior probability that it is \
                   larger.";
    Some(section(
        "compared",
        "Conditions compared",
        &html! {
            (table("compared-table", caption, &columns, &rows))
            @for note in notes { p.note { (note) } }
        },
    ))
}

/// What is known of the scatter, and at which amplitudes where that differs between them.
fn notes(all: &[Comparison]) -> Vec<String> {
    let mut amplitudes_deg: Vec<(Basis, Vec<f64>)> = Vec::new();
    for Comparison { basis, amplitude_deg, .. } in all {
        match amplitudes_deg.iter_mut().find(|(known, _)| known == basis) {
            Some((_, at)) if at.last() == Some(amplitude_deg) => {}
            Some((_, at)) => at.push(*amplitude_deg),
            None => amplitudes_deg.push((*basis, vec![*amplitude_deg])),
        }
    }
    let is_one = amplitudes_deg.len() == 1;
    let note = |(basis, at): (Basis, Vec<f64>)| {
        let at: Vec<String> = at.into_iter().map(|deg| fixed(deg, 0)).collect();
        let place = if is_one { String::new() } else { format!("At {} deg: ", at.join(", ")) };
        place + told(basis)
    };
    amplitudes_deg.into_iter().map(note).collect()
}

fn told(basis: Basis) -> &'static str {
    match basis {
        Basis::Repeats => {
            "The scatter from run to run is known from repeats, as a share of the damping alike at \
             all speeds; how little few repeats tell of it is in the probability."
        }
        Basis::Law => {
            "No speed has repeats enough: the scatter from run to run is what the runs leave of \
             c₀ + c₂ Fr², as a share of the damping of the condition."
        }
        Basis::Nothing => {
            "Every run is alone at its condition and speed, so the scatter from run to run is not \
             known, and nothing can be told: repeat one."
        }
    }
}

fn row(at: &Comparison) -> Markup {
    let probability = at.probability_larger;
    let verdict = match probability {
        None => "can't tell",
        Some(p) if p >= KNOWN => "larger",
        Some(p) if p <= 1.0 - KNOWN => "smaller",
        Some(_) => "not parted",
    };
    html! {
        td { (at.second) " against " (at.first) }
        (number_cell(&fixed(at.amplitude_deg, 0)))
        (number_cell(&fixed(at.froude, 3)))
        (estimate_cell(at.difference_per_s.as_ref()))
        (short_estimate_cell(at.difference_share.map(|share| share.scaled(100.0)).as_ref()))
        (number_cell(&probability.map_or_else(|| UNKNOWN.to_owned(), percentage)))
        td.name { (verdict) }
    }
}

/// Nothing is certain: the ends are told as bounds.
fn percentage(probability: f64) -> String {
    match 100.0 * probability {
        percent if percent > 99.9 => "> 99.9 %".to_owned(),
        percent if percent < 0.1 => "< 0.1 %".to_owned(),
        percent => format!("{} %", significant(percent, 3)),
    }
}
