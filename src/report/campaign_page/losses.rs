//! What was lost or mended while reading, with the remarks on single runs.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::section;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let notes =
        page.results.overviews.iter().map(|overview| (&overview.recording, &overview.notes));
    let remarks = page.results.runs.iter().map(|run| (&run.id, &run.identification.remarks));
    let all: Vec<_> = notes
        .chain(remarks)
        .flat_map(|(source, lines)| lines.iter().map(move |line| (source, line)))
        .collect();
    (!all.is_empty()).then(|| {
        section(
            "notes",
            "Notes on recordings and runs",
            &html! { ul { @for (source, line) in all { li { b { (source) } ": " (line) } } } },
        )
    })
}
