//! What the fitted model does not capture, run by run.

use maud::{Markup, html};

use super::{CampaignPage, alike};
use crate::report::document::section;
use crate::report::remark;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let lines: Vec<_> = page
        .results
        .runs
        .iter()
        .flat_map(|run| run.identification.remarks.iter().map(move |text| (run.id.clone(), text)))
        .filter(|(_, text)| remark::is_of_the_model(text))
        .map(|(id, text)| (id, remark::typeset(text)))
        .collect();
    (!lines.is_empty()).then(|| {
        section(
            "law-gaps",
            "What the fitted law does not capture",
            &html! { div.gaps { (alike::list(&lines)) } },
        )
    })
}
