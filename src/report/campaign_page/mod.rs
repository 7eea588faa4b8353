//! The page of the campaign: its parts in reading order.

mod against_amplitude;
mod alike;
mod at_speeds;
mod budget;
mod compared;
mod conditions;
mod damping_against_froude;
mod diagnosis;
mod equivalent_damping;
mod extinction;
mod forced_damping;
mod forced_figures;
mod forced_runs;
mod froude_law;
mod gates;
mod groups;
mod inertia;
mod law_gaps;
mod losses;
mod nonlinear_at_speeds;
mod particulars;
mod peak_moment;
mod plan;
mod recordings_to_judge;
mod rejected;
mod repeats;
mod runs;

use maud::{Markup, html};

use super::{APPENDIX_PAGE, document, field_units::FieldUnits, figure::Figure, glossary};
use crate::campaign::Campaign;
use crate::diagnosis::Diagnosis;
use crate::inverse::identification::ForcedResponse;
use crate::results::{IdentifiedRun, Results};

/// Every part, in reading order; a part without data is left out.
const PARTS: [fn(&CampaignPage) -> Option<Markup>; 24] = [
    at_speeds::part,
    diagnosis::part,
    law_gaps::part,
    damping_against_froude::part,
    froude_law::part,
    nonlinear_at_speeds::part,
    equivalent_damping::part,
    against_amplitude::part,
    extinction::part,
    compared::part,
    repeats::part,
    budget::part,
    conditions::part,
    particulars::part,
    runs::part,
    forced_runs::part,
    forced_damping::part,
    inertia::part,
    peak_moment::part,
    plan::part,
    gates::part,
    rejected::part,
    recordings_to_judge::part,
    losses::part,
];

/// What the parts of the page are made from.
#[derive(Debug, Clone, Copy)]
pub(super) struct CampaignPage<'a> {
    pub(super) campaign: &'a Campaign,
    pub(super) results: &'a Results,
    pub(super) diagnosis: Option<&'a Diagnosis>,
}

impl<'a> CampaignPage<'a> {
    /// Conditions that have runs, in the order in which the campaign names them.
    fn conditions(&self) -> Vec<&'a str> {
        let named = self.campaign.recordings.iter().map(|recording| recording.condition.as_str());
        let seen = self.results.runs.iter().map(|run| run.condition.as_str());
        let mut conditions: Vec<&str> = Vec::new();
        for condition in named.chain(seen) {
            if !conditions.contains(&condition) && self.runs_of(condition).next().is_some() {
                conditions.push(condition);
            }
        }
        conditions
    }

    fn runs_of(&self, condition: &str) -> impl Iterator<Item = &'a IdentifiedRun> {
        self.results.runs.iter().filter(move |run| run.condition == condition)
    }

    /// Forced runs of a condition with their response.
    fn forced_of(&self, condition: &str) -> Vec<(&'a IdentifiedRun, &'a ForcedResponse)> {
        self.runs_of(condition)
            .filter_map(|run| Some((run, run.identification.forced.as_ref()?)))
            .collect()
    }

    pub(super) fn field_units(&self, run: &'a IdentifiedRun) -> FieldUnits<'a> {
        FieldUnits::new(self.campaign, run)
    }
}

/// The parts that grow on the live page while the day goes on.
pub(super) fn live_parts(page: &CampaignPage) -> Markup {
    let parts =
        [at_speeds::part, damping_against_froude::part, froude_law::part, equivalent_damping::part];
    html! { @for part in parts { @if let Some(part) = part(page) { (part) } } }
}

/// The test plan with what is done of it, and what the procedure says of the whole campaign.
pub(super) fn plan_parts(page: &CampaignPage) -> Option<Markup> {
    let (plan, gates) = (plan::part(page)?, gates::part(page));
    Some(html! { (plan) @if let Some(gates) = gates { (gates) } })
}

/// The page of the campaign.
pub(super) fn html(
    campaign: &Campaign,
    results: &Results,
    diagnosis: Option<&Diagnosis>,
    has_appendix: bool,
) -> Markup {
    let page = CampaignPage { campaign, results, diagnosis };
    let (refused, changeovers) = results.refusals_and_changeovers();
    let body = html! {
        h1 { (campaign.name) }
        p.lead {
            "Roll damping identified from " (counted(results.runs.len(), "run")) " in "
            (counted(results.overviews.len().max(campaign.recordings.len()), "recording")) "; "
            (counted(refused.len(), "stretch")) " refused"
            @if !changeovers.is_empty() {
                ", " (counted(changeovers.len(), "changeover")) " between excitations left out"
            }
            ". Model scale, SI units; means with central 95 % credible intervals."
            @if has_appendix {
                " Instruments, calibrations and check sums are in the "
                a href=(APPENDIX_PAGE) { "appendix" } "."
            }
        }
        @if results.runs.is_empty() {
            p.warning { "No run was identified; the reasons are listed below." }
        }
        @for part in PARTS {
            @if let Some(part) = part(&page) { (part) }
        }
        (glossary::conventions())
        (glossary::symbols())
    };
    document::page(&campaign.name, &body)
}

/// The figure of damping against Froude number, if a run was identified.
pub(super) fn damping_figure(campaign: &Campaign, results: &Results) -> Option<Figure> {
    damping_against_froude::figure(&CampaignPage { campaign, results, diagnosis: None })
}

fn counted(n: usize, noun: &str) -> String {
    let ending = match (n, noun.ends_with("ch")) {
        (1, _) => "",
        (_, true) => "es",
        (_, false) => "s",
    };
    format!("{n} {noun}{ending}")
}
