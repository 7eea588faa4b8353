//! Recordings with a refusal or without a run, drawn so that the reasons can be judged.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel};
use crate::results::Overview;

/// Recordings drawn; a campaign file that is wrong may reject hundreds for one reason.
const N_RECORDINGS_MAX: usize = 12;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let (refused, _) = page.results.refusals_and_changeovers();
    let drawn: Vec<_> = page
        .results
        .overviews
        .iter()
        .filter(|overview| !overview.roll.time_s.is_empty())
        .filter(|overview| {
            let gave_a_run =
                page.results.runs.iter().any(|run| run.recording == overview.recording);
            !gave_a_run || refused.iter().any(|stretch| stretch.recording == overview.recording)
        })
        .collect();
    (!drawn.is_empty()).then(|| {
        section(
            "recordings",
            "Recordings with refusals or without a run",
            &html! {
                @for (index, overview) in drawn.iter().take(N_RECORDINGS_MAX).enumerate() {
                    (figure(page, index + 1, overview).markup())
                }
                @if drawn.len() > N_RECORDINGS_MAX {
                    p.note { "Not drawn: " (drawn.len() - N_RECORDINGS_MAX) " more." }
                }
            },
        )
    })
}

fn figure(page: &CampaignPage, number: usize, overview: &Overview) -> Figure {
    let roll_deg: Vec<_> = overview.roll.value.iter().map(|roll| roll.to_degrees()).collect();
    let mut panel = Panel::new(Axis::new("roll φ [deg]")).height(110);
    for run in page.results.runs.iter().filter(|run| run.recording == overview.recording) {
        panel = panel.stretch(run.run.start_s, run.run.end_s, Ink::new(Hue::Sky).named("used"));
    }
    for stretch in &page.results.rejected {
        if stretch.recording == overview.recording {
            let ink = Ink::new(Hue::Vermillion).named("not used");
            panel = panel.stretch(stretch.start_s, stretch.end_s, ink);
        }
    }
    let line = Ink::new(Hue::Black).wide(0.7);
    Figure::new(format!("recording-{number}"), overview.recording.clone(), Axis::time())
        .panel(panel.line(&overview.roll.time_s, &roll_deg, line))
}
