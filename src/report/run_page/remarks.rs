//! Sentences a reader must know before using the numbers.

use maud::{Markup, html};

use super::RunPage;

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let remarks = &page.identification().remarks;
    (!remarks.is_empty()).then(|| {
        html! {
            section id="remarks" {
                h2 { "Remarks" }
                div.remarks { ul { @for remark in remarks { li { (remark) } } } }
            }
        }
    })
}
