//! The page of one run: its parts in reading order.

mod chain;
mod coefficients;
mod counted;
mod equivalent_damping;
mod extinction;
mod facts;
mod forced;
mod forms;
mod gates;
mod law_gaps;
mod least_squares;
mod moment;
mod natural_frequency;
mod observable;
mod record;
mod remarks;
mod resimulation;
mod result;
mod roll;
mod scatter;

use maud::{Markup, html};

use super::{document, field_units::FieldUnits, glossary, judged_run, provisional};
use crate::campaign::Campaign;
use crate::inverse::identification::Identification;
use crate::results::{IdentifiedRun, Overview, RejectedStretch};
use crate::run::RunKind;

/// Every part, in reading order; a part without data is left out.
const PARTS: [fn(&RunPage) -> Option<Markup>; 19] = [
    law_gaps::part,
    facts::part,
    record::part,
    counted::part,
    roll::part,
    moment::part,
    scatter::part,
    equivalent_damping::part,
    extinction::part,
    forms::part,
    coefficients::part,
    resimulation::part,
    forced::part,
    natural_frequency::part,
    observable::part,
    least_squares::part,
    chain::part,
    gates::part,
    remarks::part,
];

/// What the parts of the page are made from.
#[derive(Debug, Clone, Copy)]
pub(super) struct RunPage<'a> {
    pub(super) campaign: &'a Campaign,
    pub(super) run: &'a IdentifiedRun,
    pub(super) overview: Option<&'a Overview>,
    pub(super) rejected: &'a [RejectedStretch],
}

impl<'a> RunPage<'a> {
    fn identification(&self) -> &'a Identification {
        &self.run.identification
    }

    fn field_units(&self) -> FieldUnits<'a> {
        FieldUnits::new(self.campaign, self.run)
    }
}

/// The parts that the live page shows of the run that ended last.
pub(super) fn live_parts(page: &RunPage) -> Markup {
    let parts =
        [equivalent_damping::part, coefficients::part, forced::part, gates::part, remarks::part];
    html! { @for part in parts { @if let Some(part) = part(page) { (part) } } }
}

/// The page of one run.
pub(super) fn html(
    campaign: &Campaign,
    run: &IdentifiedRun,
    overview: Option<&Overview>,
    rejected: &[RejectedStretch],
) -> Markup {
    let page = RunPage { campaign, run, overview, rejected };
    let body = html! {
        h1 { "Run " (run.id) ": " (kind_name(run.run.kind)) ", Fr " (froude(run.froude)) }
        p.lead {
            (campaign.name) " · " (run.condition) " · " a href="index.html" { "campaign report" }
        }
        @if let Some(banner) = provisional::banner(run) { (banner) }
        (result::line(&page))
        (judged_run::place(None, &[]))
        @for part in PARTS {
            @if let Some(part) = part(&page) { (part) }
        }
        (glossary::conventions())
        (glossary::symbols())
    };
    document::page(&format!("{} – {}", run.id, campaign.name), &body)
}

/// The kind of a run in words.
pub(super) fn kind_name(kind: RunKind) -> &'static str {
    match kind {
        RunKind::Decay => "free decay",
        RunKind::Forced => "forced rolling",
    }
}

/// A Froude number as it is printed everywhere.
pub(super) fn froude(froude: f64) -> String {
    super::number::fixed(froude, 3)
}

/// Values in degrees.
fn degrees(values_rad: &[f64]) -> Vec<f64> {
    values_rad.iter().map(|value| value.to_degrees()).collect()
}
