//! The damping of a campaign as a plain-text table for the terminal.

use super::number;
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::{EquivalentDamping, FroudeLaw};
use crate::results::{IdentifiedRun, Results, by_speed};
use crate::run::RunKind;

/// Longest condition that is printed whole; the table keeps within 100 columns.
const CONDITION_MAX: usize = 60;

/// Significant digits of a mean, for the same reason.
const DIGITS_MAX: i32 = 4;

/// Damping run by run under its condition, aligned, at most 100 columns wide.
///
/// Decays have a row each, by Froude number; forced runs are summed up per Froude number.
pub fn damping_table(results: &Results) -> String {
    if results.runs.is_empty() {
        return "no run was identified\n".to_owned();
    }
    let header = ["Fr", "kind", "b1 [1/s]", "b3 [s]", "b_eq(5 deg) [1/s]"].map(str::to_owned);
    let mut rows = vec![(None, header)];
    for condition in results.conditions() {
        let of = |kind| {
            let runs = results.runs.iter();
            runs.filter(|run| run.condition == condition && run.run.kind == kind).collect()
        };
        let decays = by_speed(of(RunKind::Decay)).concat();
        rows.extend(decays.into_iter().map(|run| (Some(condition), decay_row(run))));
        let forced = by_speed(of(RunKind::Forced));
        rows.extend(forced.iter().map(|runs| (Some(condition), forced_row(runs))));
    }
    let laws = results.froude_laws.iter().map(law_lines);
    std::iter::once(aligned(&rows)).chain(laws).collect()
}

fn law_lines(law: &FroudeLaw) -> String {
    format!(
        "\n{}: b1(Fr) = b0 (1 + kappa Fr^2)\n  b0 = {} 1/s, kappa = {}\n",
        shortened(&law.condition, CONDITION_MAX),
        number::estimate(&law.b0_per_s),
        number::estimate(&law.kappa),
    )
}

fn decay_row(run: &IdentifiedRun) -> [String; 5] {
    let fit = &run.identification.damping;
    [
        number::fixed(run.froude, 3),
        "decay".to_owned(),
        estimate(&fit.b1_per_s),
        estimate(&fit.b3_s),
        run.at_comparison().map_or_else(|| number::UNKNOWN.to_owned(), comparison_cell),
    ]
}

/// Runs at one Froude number differ in frequency, so their means are given as a range.
fn forced_row(runs: &[&IdentifiedRun]) -> [String; 5] {
    let range = |values: Vec<Estimate>| {
        let lowest = values.iter().min_by(|a, b| a.mean.total_cmp(&b.mean));
        let highest = values.iter().max_by(|a, b| a.mean.total_cmp(&b.mean));
        match (lowest, highest) {
            (Some(lo), Some(_)) if values.len() == 1 => estimate(lo),
            (Some(lo), Some(hi)) => {
                let [lo, hi] = [lo, hi].map(|at| number::mean_within(at, DIGITS_MAX));
                if lo == hi { lo } else { format!("{lo} to {hi}") }
            }
            _ => number::UNKNOWN.to_owned(),
        }
    };
    let fits = || runs.iter().map(|run| run.identification.damping);
    let froude = runs.iter().map(|run| run.froude).sum::<f64>() / runs.len() as f64;
    let kind = if runs.len() == 1 { "forced".to_owned() } else { format!("{} forced", runs.len()) };
    [
        number::fixed(froude, 3),
        kind,
        range(fits().map(|fit| fit.b1_per_s).collect()),
        range(fits().map(|fit| fit.b3_s).collect()),
        range(runs.iter().filter_map(|run| Some(run.at_comparison()?.fitted_per_s)).collect()),
    ]
}

fn comparison_cell(at: &EquivalentDamping) -> String {
    let mark = if at.extrapolated { " *" } else { "" };
    estimate(&at.fitted_per_s) + mark
}

fn shortened(name: &str, letters_max: usize) -> String {
    if name.chars().count() <= letters_max {
        return name.to_owned();
    }
    let kept: String = name.chars().take(letters_max - 1).collect();
    kept + "\u{2026}"
}

fn estimate(estimate: &Estimate) -> String {
    number::estimate_within(estimate, DIGITS_MAX)
}

/// Rows in columns, each condition as a line above its rows.
fn aligned(rows: &[(Option<&str>, [String; 5])]) -> String {
    let width = |column: usize| {
        rows.iter().map(|row| row.1[column].chars().count()).max().unwrap_or_default()
    };
    let widths: Vec<_> = (0..5).map(width).collect();
    let mut text = String::new();
    let mut shown = None;
    for (condition, row) in rows {
        if let Some(condition) = condition.filter(|_| *condition != shown) {
            text.push_str(&shortened(condition, CONDITION_MAX));
            text.push('\n');
        }
        shown = *condition;
        let cells: Vec<_> =
            row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}")).collect();
        text.push_str("  ");
        text.push_str(cells.join("  ").trim_end());
        text.push('\n');
    }
    if rows.iter().any(|row| row.1[4].ends_with('*')) {
        text.push_str("* the run did not reach 5 deg: the law is extrapolated\n");
    }
    text
}
