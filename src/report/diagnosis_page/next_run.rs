//! The run to tow next, with its reason.

use maud::{Markup, html};

use super::DiagnosisPage;
use crate::report::document::section;

pub(super) fn part(page: &DiagnosisPage) -> Option<Markup> {
    let next = page.diagnosis.next_run.as_ref()?;
    Some(section("next-run", "Next run", &html! { p { (next.why) } }))
}
