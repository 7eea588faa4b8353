//! What the simulation gets wrong: cause, gain, next run, and the way to the page of the diagnosis.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::DIAGNOSIS_PAGE;
use crate::report::diagnosis_json::{log10, word};
use crate::report::diagnosis_text::meaning;
use crate::report::document::section;
use crate::report::number::{estimate, significant};

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let diagnosis = page.diagnosis?;
    let gain = diagnosis.gain.as_ref().filter(|_| !diagnosis.causes.is_empty());
    Some(section(
        "diagnosis",
        "What the simulation gets wrong",
        &html! {
            p {
                b { (word(diagnosis.verdict)) } ": " (meaning(diagnosis.verdict)) ". "
                a href=(DIAGNOSIS_PAGE) { "Diagnosis with evidence, gain and next run" } "."
            }
            ul {
                @for cause in &diagnosis.causes {
                    li {
                        "Cause: " b { (cause.effect) } ", " (cause.equation)
                        @if !cause.equivalent_to.is_empty() {
                            ", or " (cause.equivalent_to.join(" or "))
                            ", which these runs cannot tell apart"
                        }
                        " (log₁₀ Bayes factor "
                        (significant(log10(cause.log_bayes_factor), 3)) ")."
                    }
                }
                @if let Some(gain) = gain {
                    li {
                        "Gain on runs held out: roll error from "
                        (estimate(&gain.rmse_deg.before)) " to " (estimate(&gain.rmse_deg.after))
                        " deg, unexplained share of the moment from "
                        (estimate(&gain.unexplained_share.before)) " to "
                        (estimate(&gain.unexplained_share.after)) "."
                    }
                }
                @if let Some(next) = &diagnosis.next_run { li { "Next run: " (next.why) "." } }
            }
        },
    ))
}
