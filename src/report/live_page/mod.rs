//! What was learnt so far, as parts of the live page: the report's own figures and tables.

mod damping;
mod diagnosis;
mod last_run;
mod latest;
mod next;
mod plan;
mod runs;
mod verdict;

use maud::Markup;

use super::campaign_page::CampaignPage;
use crate::campaign::Campaign;
use crate::diagnosis::Diagnosis;
use crate::results::Results;

/// A part, from what was learnt.
type Part = fn(&CampaignPage) -> Markup;

/// Every part by the name of its place on the page.
const PARTS: [(&str, Part); 8] = [
    ("latest", latest::part),
    ("verdict", verdict::part),
    ("last-run", last_run::part),
    ("damping", damping::part),
    ("runs", runs::part),
    ("next", next::part),
    ("plan", plan::part),
    ("diagnosis", diagnosis::part),
];

/// The parts as HTML; results that are the same give the same text.
pub(super) fn parts(
    campaign: &Campaign,
    results: &Results,
    diagnosis: Option<&Diagnosis>,
) -> Vec<(&'static str, String)> {
    let page = CampaignPage { campaign, results, diagnosis };
    PARTS.into_iter().map(|(name, part)| (name, part(&page).into_string())).collect()
}
