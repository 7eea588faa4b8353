//! What was run, where it stands in the record, its main results.

use maud::{Markup, html};

use super::{RunPage, froude, kind_name};
use crate::inverse::identification::Method;
use crate::report::document::{section, typeset};
use crate::report::notation;
use crate::report::number::{estimate, fixed, significant};
use crate::run::RunEnd;

#[expect(clippy::unnecessary_wraps, reason = "every part of a page has the same shape")]
pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let (found, identification) = (&page.run.run, page.identification());
    let units = page.field_units();
    let still = found.still.map_or_else(
        || "none found; the zero is estimated from the run".to_owned(),
        |still| {
            let zero = fixed(still.roll_rad.to_degrees(), 3);
            let force = still.force.map_or(String::new(), |force| {
                let unit = if page.campaign.exciter.is_some() { "N" } else { "N m" };
                format!(", mean drive {} {unit}", significant(force, 2))
            });
            let (start, end) = (fixed(still.start_s, 2), fixed(still.end_s, 2));
            format!("{start} to {end} s, mean roll {zero} deg{force}")
        },
    );
    let mut rows = vec![
        ("Recording", page.run.recording.clone()),
        ("Condition", page.run.condition.clone()),
        ("Kind", kind_name(found.kind).to_owned()),
        (
            "Used stretch",
            format!(
                "{} to {} s ({} s); {}",
                fixed(found.start_s, 2),
                fixed(found.end_s, 2),
                fixed(found.end_s - found.start_s, 2),
                end_reason(found.end)
            ),
        ),
        ("Still stretch before", still),
        ("Carriage speed V", format!("{} m/s", fixed(page.run.speed_m_s, 3))),
        ("Froude number Fr on L_{pp}", froude(page.run.froude)),
        ("Method", method_name(identification.method).to_owned()),
        (
            "Natural frequency ω_{n}",
            format!("{} rad/s", estimate(&identification.natural_frequency_rad_s)),
        ),
    ];
    if let (Some(forced), Some(b)) = (&identification.forced, units.work_damping_per_s()) {
        let amplitude = significant(forced.roll_amplitude_rad.mean.to_degrees(), 3);
        let at = format!("at A₁ = {amplitude} deg");
        rows.push(("b_{eq} from the work per cycle", format!("{} 1/s {at}", estimate(&b))));
        let work = forced.work_damping_n_m_s;
        rows.push(("B_{eq} from the work per cycle", format!("{} N m s {at}", estimate(&work))));
        let b44 = work.scaled(units.b44_hat_per_n_m_s());
        rows.push(("B̂₄₄ from the work per cycle", format!("{} {at}", estimate(&b44))));
    }
    if let Some(at) = units.at_comparison() {
        let note = if at.extrapolated { " (not reached in this run)" } else { "" };
        let value = estimate(&at.fitted_per_s);
        rows.push(("b_{eq} at 5 deg, from the law", format!("{value} 1/s{note}")));
        if let Some(local) = &at.local_per_s {
            let value = estimate(local);
            rows.push(("b_{eq} at 5 deg, half cycles near it", format!("{value} 1/s")));
        }
        let value = estimate(&units.moment(at.fitted_per_s));
        rows.push(("B_{eq} at 5 deg, from the law", format!("{value} N m s{note}")));
        let value = estimate(&units.b44_hat(at.fitted_per_s));
        rows.push(("B̂₄₄ at 5 deg, from the law", format!("{value}{note}")));
    }
    let rmse = significant(identification.resimulation.rmse_rad.to_degrees(), 3);
    rows.push(("Resimulation rmse", format!("{rmse} deg")));
    Some(section(
        "facts",
        "The run",
        &html! {
            div.table tabindex="0" role="region" aria-label="The run" { table { tbody {
                @for (name, value) in &rows {
                    tr { th scope="row" { (notation::html(name)) } td { (typeset_numbers(value)) } }
                }
            } } }
        },
    ))
}

/// The printer's minus where a hyphen begins a number; hyphens inside names stay.
fn typeset_numbers(value: &str) -> String {
    value
        .split(' ')
        .map(|word| {
            let bare = word.trim_start_matches(['-', '[']);
            if bare.starts_with(|first: char| first.is_ascii_digit()) && bare.len() < word.len() {
                typeset(word)
            } else {
                word.to_owned()
            }
        })
        .collect::<Vec<_>>()
        .join(" ")
}

fn method_name(method: Method) -> &'static str {
    match method {
        Method::Exact => "exact posterior, scale-free hyperpriors",
        Method::PaperMcmc => "Gibbs and Metropolis-Hastings sampler with the paper's hyperpriors",
    }
}

fn end_reason(end: RunEnd) -> &'static str {
    match end {
        RunEnd::LostInNoise => "ends where the roll is lost in the noise",
        RunEnd::Caught => "ends where something stopped the roll",
        RunEnd::PassEnded => "ends where the carriage speed left its steady value",
        RunEnd::ReStruck => "ends where the model was released or struck again",
        RunEnd::ExcitationChanged => "ends where the excitation changed or stopped",
        RunEnd::Gap => "ends at a hole in the record",
        RunEnd::RecordingEnded => "ends with the recording",
        RunEnd::TooLong => "ends where a run as long as memory allows was full",
    }
}
