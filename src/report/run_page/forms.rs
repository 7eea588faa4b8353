//! Which form of law the evidence favours, and what it says of restoring and noise.

use maud::{Markup, html};

use super::RunPage;
use crate::inverse::identification::Beliefs;
use crate::report::document::{number_cell, section, table, text_cell};
use crate::report::number;

/// Below this a form's solutions were not kept.
const NEGLIGIBLE: f64 = 1e-4;

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let beliefs = page.identification().beliefs.as_ref()?;
    let columns = [("Form of B/(I+ΔI)", ""), ("Probability", "%"), ("Coefficients", "")];
    let rows: Vec<Markup> = beliefs
        .forms
        .iter()
        .map(|form| {
            let coefficients: Vec<String> = form
                .coefficients
                .iter()
                .map(|(symbol, unit, value)| {
                    format!("{symbol} = {} {unit}", number::estimate(value))
                })
                .collect();
            html! {
                (text_cell(form.equation))
                (number_cell(&percentage(form.probability)))
                (text_cell(&coefficients.join("; ")))
            }
        })
        .collect();
    let caption = "Forms of the damping law by evidence; the equivalent damping and the moment \
                   are those of all of them together, each as far as it is believed.";
    Some(section(
        "forms",
        "Form of the damping law",
        &html! {
            (table("forms-table", caption, &columns, &rows))
            ul {
                @for sentence in sentences(beliefs) { li { (sentence) } }
            }
        },
    ))
}

fn percentage(probability: f64) -> String {
    if probability < NEGLIGIBLE {
        "< 0.01".to_owned()
    } else {
        number::significant(100.0 * probability, 3)
    }
}

fn sentences(beliefs: &Beliefs) -> Vec<String> {
    let misfit: f64 = beliefs.misfit_orders.iter().sum();
    let mut sentences = vec![
        format!(
            "The restoring has a cubic part with probability {} %.",
            percentage(beliefs.cubic_restoring)
        ),
        format!(
            "The record holds a moment that no law of the rate explains with probability {} %.",
            percentage(misfit)
        ),
        format!(
            "The noise remembers from sample to sample with probability {} %; the run knows as \
             much as {:.0} samples with independent noise.",
            percentage(beliefs.coloured_noise),
            beliefs.n_effective
        ),
    ];
    if let Some(quantum_rad) = beliefs.quantum_rad {
        sentences.push(format!(
            "The roll channel moves in steps of {} deg, whose own noise is the least assumed.",
            number::significant(quantum_rad.to_degrees(), 3)
        ));
    }
    sentences
}
