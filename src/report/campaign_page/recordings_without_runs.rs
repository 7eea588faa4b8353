//! Recordings that gave no run, drawn so that their reasons can be judged.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel};
use crate::results::Overview;

/// Recordings drawn; a campaign file that is wrong may reject hundreds for one reason.
const N_RECORDINGS_MAX: usize = 12;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let without: Vec<_> = page
        .results
        .overviews
        .iter()
        .filter(|overview| !overview.roll.time_s.is_empty())
        .filter(|overview| page.results.runs.iter().all(|run| run.recording != overview.recording))
        .collect();
    (!without.is_empty()).then(|| {
        section(
            "recordings-without-runs",
            "Recordings without a run",
            &html! {
                @for (index, overview) in without.iter().take(N_RECORDINGS_MAX).enumerate() {
                    (figure(page, index + 1, overview).markup())
                }
                @if without.len() > N_RECORDINGS_MAX {
                    p.note { "Not drawn: " (without.len() - N_RECORDINGS_MAX) " more." }
                }
            },
        )
    })
}

fn figure(page: &CampaignPage, number: usize, overview: &Overview) -> Figure {
    let roll_deg: Vec<_> = overview.roll.value.iter().map(|roll| roll.to_degrees()).collect();
    let mut panel = Panel::new(Axis::new("roll φ [deg]")).height(110);
    for stretch in &page.results.rejected {
        if stretch.recording == overview.recording {
            let ink = Ink::new(Hue::Vermillion).named("rejected");
            panel = panel.stretch(stretch.start_s, stretch.end_s, ink);
        }
    }
    let line = Ink::new(Hue::Black).wide(0.7);
    Figure::new(format!("recording-{number}"), overview.recording.clone(), Axis::time())
        .panel(panel.line(&overview.roll.time_s, &roll_deg, line))
}
