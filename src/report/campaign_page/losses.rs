//! What was lost or mended while reading, with the lesser remarks on single runs.

use maud::Markup;

use super::{CampaignPage, alike};
use crate::report::document::section;
use crate::report::remark;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let overviews = page.results.overviews.iter();
    let notes = overviews.flat_map(|overview| {
        overview.notes.iter().map(|note| (overview.recording.clone(), note.clone()))
    });
    let runs = page.results.runs.iter();
    let remarks = runs.flat_map(|run| {
        let remarks = run.identification.remarks.iter();
        remarks
            .filter(|text| !remark::is_of_the_model(text))
            .map(|text| (run.id.clone(), remark::typeset(text)))
    });
    let lines: Vec<_> = notes.chain(remarks).collect();
    (!lines.is_empty())
        .then(|| section("notes", "Notes on recordings and runs", &alike::list(&lines)))
}
