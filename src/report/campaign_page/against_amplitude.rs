//! Equivalent damping against amplitude at each Froude number, one figure per condition.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Ink, Panel};
use crate::report::notation;
use crate::report::number::fixed;
use crate::results::{IdentifiedRun, by_speed};
use crate::run::RunKind;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let conditions = page.conditions().into_iter().enumerate();
    let figures: Vec<Figure> = conditions
        .filter_map(|(index, condition)| {
            let decays = page.runs_of(condition).filter(|run| run.run.kind == RunKind::Decay);
            figure(index + 1, condition, &by_speed(decays.collect()))
        })
        .collect();
    (!figures.is_empty()).then(|| {
        section(
            "against-amplitude",
            "Equivalent damping against amplitude",
            &html! { @for figure in &figures { (figure.markup()) } },
        )
    })
}

fn figure(number: usize, condition: &str, speeds: &[Vec<&IdentifiedRun>]) -> Option<Figure> {
    let mut panel = Panel::new(Axis::new("b_{eq} [1/s]").holding(0.0)).height(240);
    let mut n_runs = 0;
    for (index, runs) in speeds.iter().enumerate() {
        for (k, run) in runs.iter().enumerate() {
            let reached = run.identification.equivalent_damping.iter();
            let reached = reached.filter(|at| !at.extrapolated && at.fitted_per_s.mean.is_finite());
            let (mut amplitude, mut damping) = (Vec::new(), [(); 3].map(|()| Vec::new()));
            for at in reached {
                let b = at.fitted_per_s;
                amplitude.push(at.amplitude_deg);
                let [mean, lo, hi] = &mut damping;
                mean.push(b.mean);
                lo.push(b.lo95);
                hi.push(b.hi95);
            }
            if amplitude.is_empty() {
                continue;
            }
            n_runs += 1;
            let [mean, lo, hi] = damping;
            let line = Ink::of_series(index).wide(1.4);
            // One name a speed: its repeats are drawn alike.
            let line =
                if k == 0 { line.named(format!("Fr {}", fixed(run.froude, 2))) } else { line };
            panel = panel
                .band(&amplitude, &lo, &hi, Ink::of_series(index))
                .line(&amplitude, &mean, line);
        }
    }
    let title = format!("Equivalent damping against amplitude: {condition}");
    let x = Axis::new("roll amplitude A [deg]").holding(0.0);
    (n_runs > 0).then(|| {
        Figure::new(format!("against-amplitude-{number}"), notation::plain(&title), x)
            .panel(panel)
            .caption(
                "Free decays with 95 % bands, as far as each run reached; the bands are often \
                 narrower than the lines.",
            )
    })
}
