//! What the fitted law does not capture in this run, before any number.

use maud::{Markup, html};

use super::RunPage;
use crate::report::remark;

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let remarks = &page.identification().remarks;
    let gaps: Vec<_> = remarks.iter().filter(|text| remark::is_of_the_model(text)).collect();
    (!gaps.is_empty()).then(|| {
        html! {
            section id="law-gaps" {
                h2 { "What the fitted law does not capture" }
                div.gaps { ul { @for text in gaps { li { (remark::typeset(text)) } } } }
            }
        }
    })
}
