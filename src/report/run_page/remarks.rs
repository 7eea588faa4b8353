//! Remarks on how the run was identified.

use maud::{Markup, html};

use super::RunPage;
use crate::report::document::section;
use crate::report::remark;

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let remarks = &page.identification().remarks;
    let lesser: Vec<_> = remarks.iter().filter(|text| !remark::is_of_the_model(text)).collect();
    (!lesser.is_empty()).then(|| {
        let list = html! { ul { @for text in lesser { li { (remark::typeset(text)) } } } };
        section("remarks", "Remarks on the identification", &list)
    })
}
