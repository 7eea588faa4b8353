//! The chains of the sampler: traces and convergence (Fig. 11).

use maud::{Markup, html};

use super::RunPage;
use crate::inverse::identification::{Chain, Trace};
use crate::report::document::{number_cell, section, table};
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel};
use crate::report::number::{fixed, significant};

/// Traces drawn on the page.
const N_TRACES_MAX: usize = 6;

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let chain = page.identification().chain.as_ref()?;
    Some(section(
        "chain",
        "Chains of the sampler",
        &html! {
            @if !chain.converged {
                p.warning {
                    "Not converged: the largest split R̂ is " (fixed(chain.r_hat_max, 3))
                    ", the limit 1.05. Means and bands of this run are not to be used."
                }
            }
            (summary(chain))
            (traces(chain))
        },
    ))
}

fn summary(chain: &Chain) -> Markup {
    let columns = [
        ("Seed", ""),
        ("Chains", ""),
        ("Sweeps each", ""),
        ("Burn-in", ""),
        ("Largest split R̂", ""),
        ("Smallest effective sample size", ""),
        ("Converged", ""),
    ];
    let row = html! {
        (number_cell(&chain.seed.to_string()))
        (number_cell(&chain.n_chains.to_string()))
        (number_cell(&chain.n_sweeps.to_string()))
        (number_cell(&chain.n_burn_in.to_string()))
        (number_cell(&fixed(chain.r_hat_max, 3)))
        (number_cell(&significant(chain.effective_sample_size_min, 3)))
        td { @if chain.converged { "yes (R̂ < 1.05)" } @else { "no" } }
    };
    table("chain-table", "Convergence over all components.", &columns, &[row])
}

fn traces(chain: &Chain) -> Markup {
    let mut figure = Figure::new("traces", "Traces of some components", Axis::new("sweep").tight())
        .caption(
            "The shaded burn-in is not used; where it left the scale it is drawn on the edge.",
        );
    for trace in chain.traces.iter().take(N_TRACES_MAX) {
        let sweep: Vec<_> = trace.sweep.iter().map(|&sweep| sweep as f64).collect();
        let burn_in = Ink::new(Hue::Grey).named("burn-in");
        figure = figure.panel(
            Panel::new(axis(trace, chain.n_burn_in))
                .height(84)
                .stretch(0.0, chain.n_burn_in as f64, burn_in)
                .line(&sweep, &trace.value, Ink::new(Hue::Blue).wide(0.7)),
        );
    }
    html! { @if !chain.traces.is_empty() { (figure.markup()) } }
}

/// The component with the symbols of the page, to the scale of what is used of its trace.
fn axis(trace: &Trace, n_burn_in: usize) -> Axis {
    let name = trace.name.replace(" [", "\n[").replace("lambda", "λ").replace("sigma", "σ");
    let name = name.replace("[s4]", "[s⁴]").replace("s2]", "s²]");
    let used = trace.sweep.iter().zip(&trace.value).filter(|(sweep, _)| **sweep >= n_burn_in);
    let (lo, hi) = used
        .map(|(_, &value)| value)
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
    let margin = 0.2 * (hi - lo);
    Axis::new(name).limited(lo - margin, hi + margin)
}
