//! The page of the diagnosis: its parts in reading order.

mod against_motion;
mod bias;
mod causes;
mod gain;
mod in_time;
mod left;
mod next_run;
mod over_runs;
mod ranking;

use maud::{Markup, html};

use super::{diagnosis_json::word, diagnosis_text::meaning, document, glossary};
use crate::diagnosis::{Diagnosis, Unexplained};
use crate::model::effects::UNTESTABLE;

/// Every part, in reading order; a part without data is left out.
const PARTS: [fn(&DiagnosisPage) -> Option<Markup>; 9] = [
    causes::part,
    next_run::part,
    gain::part,
    bias::part,
    in_time::part,
    against_motion::part,
    over_runs::part,
    left::part,
    ranking::part,
];

/// What the parts of the page are made from.
#[derive(Debug)]
struct DiagnosisPage<'a> {
    diagnosis: &'a Diagnosis,
}

impl<'a> DiagnosisPage<'a> {
    /// Runs with what each model leaves, the one that the base model fails most in first.
    fn worst_first(&self) -> Vec<(&'a Unexplained, &'a Unexplained)> {
        let after = &self.diagnosis.unexplained_after;
        let pair = |before: &'a Unexplained| {
            Some((before, after.iter().find(|after| after.run == before.run)?))
        };
        let mut pairs: Vec<_> = self.diagnosis.unexplained_before.iter().filter_map(pair).collect();
        pairs.sort_by(|a, b| b.0.share_of_damping.total_cmp(&a.0.share_of_damping));
        pairs
    }

    /// Whether the model was extended at all.
    fn is_extended(&self) -> bool {
        !(self.diagnosis.causes.is_empty() && self.diagnosis.suspects.is_empty())
    }
}

/// The parts that the live page shows.
pub(super) fn live_parts(diagnosis: &Diagnosis) -> Markup {
    let page = DiagnosisPage { diagnosis };
    let parts = [causes::part, gain::part, left::part];
    html! { @for part in parts { @if let Some(part) = part(&page) { (part) } } }
}

/// The page of a campaign's diagnosis; without one, of a campaign none of whose runs could be
/// diagnosed.
pub(super) fn html(campaign: &str, diagnosis: Option<&Diagnosis>) -> Markup {
    let body = html! {
        h1 { "What the simulation gets wrong" }
        @match diagnosis {
            None => {
                p.lead { (campaign) " · " a href="index.html" { "campaign report" } }
                p.warning { "No run could be diagnosed." }
            }
            Some(diagnosis) => {
                p.lead {
                    (campaign) " · " a href="index.html" { "campaign report" } " · "
                    b { (word(diagnosis.verdict)) } ": " (meaning(diagnosis.verdict)) "."
                }
                @for part in PARTS {
                    @if let Some(part) = part(&DiagnosisPage { diagnosis }) { (part) }
                }
                p.note {
                    "No roll test can say anything of "
                    (UNTESTABLE.map(|(effect, _)| effect).join(", ")) "."
                }
            }
        }
        (glossary::conventions())
        (glossary::symbols())
    };
    document::page(&format!("Diagnosis – {campaign}"), &body)
}
