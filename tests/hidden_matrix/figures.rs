//! What the answers are worth beside the name: held-out error, speed, and parameters.

use std::fmt::Write as _;

use serde_json::Value;

use crate::count::text;

/// Appends the figures to the page.
pub(crate) fn append(page: &mut String, outcomes: &[Value]) {
    page.push_str("## Beside the name\n\n| figure | campaigns | result |\n|---|---|---|\n");
    let mut seconds: Vec<f64> =
        outcomes.iter().filter_map(|outcome| outcome["seconds"].as_f64()).collect();
    seconds.sort_by(f64::total_cmp);
    if let (Some(longest), Some(middle)) = (seconds.last(), seconds.get(seconds.len() / 2)) {
        let n = seconds.len();
        writeln!(page, "| seconds, median and longest | {n} | {middle:.2}, {longest:.2} |")
            .expect("text");
    }
    let right: Vec<&Value> = outcomes
        .iter()
        .filter(|outcome| ["named", "in class"].contains(&text(outcome, "outcome")))
        .collect();
    let mut excess: Vec<f64> = right
        .iter()
        .filter_map(|outcome| {
            let after = mean(&outcome["gain"]["held_out_rmse_deg"]["after"])?;
            Some(after / outcome["foretold_rmse_deg"].as_f64()? - 1.0)
        })
        .collect();
    excess.sort_by(f64::total_cmp);
    let n = excess.len();
    if n > 0 {
        let within = excess.iter().filter(|excess| **excess < 0.05).count();
        writeln!(
            page,
            "| held-out RMSE after, within 5 % of what the true model foretells with the \
             damping of the same other runs | {n} | {:.1} %, median excess {:.1} % |",
            100.0 * within as f64 / n as f64,
            100.0 * excess[n / 2]
        )
        .expect("text");
    }
    let mut covered = [0, 0];
    for outcome in &right {
        for hit in outcome["covered"].as_array().into_iter().flatten() {
            if let Some(hit) = hit["inside"].as_bool() {
                covered[0] += usize::from(hit);
                covered[1] += 1;
            }
        }
    }
    let share = 100.0 * f64::from(covered[0] as u32) / f64::from(covered[1].max(1) as u32);
    writeln!(
        page,
        "| size of the named effect inside its 95 % interval | {} | {share:.1} % |",
        covered[1]
    )
    .expect("text");
    asked(page, &right);
    crate::bias::append(page, &right);
}

/// How often the runs that were asked for decide: all of them, and those told as deciding ones.
fn asked(page: &mut String, right: &[&Value]) {
    let all: Vec<(bool, bool)> = right
        .iter()
        .filter_map(|outcome| {
            let is_promised = outcome["next_run"]["decides"].as_bool().unwrap_or(true);
            Some((outcome["decided"].as_bool()?, is_promised))
        })
        .collect();
    let promised: Vec<(bool, bool)> = all.iter().copied().filter(|(_, told)| *told).collect();
    for (runs, of) in [("the run asked for", &all), ("one that was told to decide", &promised)] {
        let decided = of.iter().filter(|(decided, _)| *decided).count();
        let share = 100.0 * decided as f64 / of.len().max(1) as f64;
        writeln!(page, "| undecided, and {runs} decides | {} | {share:.1} % |", of.len())
            .expect("text");
    }
}

/// A number, or the mean of a belief.
fn mean(value: &Value) -> Option<f64> {
    value.as_f64().or_else(|| value["mean"].as_f64())
}
