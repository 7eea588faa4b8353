//! Whether the damping is the hull's once the model is extended: error and interval, before and
//! after.

use std::fmt::Write as _;

use serde_json::{Value, json};

use crate::hidden_tank::campaign::Campaign;

/// A coefficient of the program's base, and its name on the page.
const COEFFICIENTS: [(&str, &str); 3] =
    [("b1_per_s", "linear damping at rest"), ("kappa", "growth with speed"), ("b3_s", "cubic")];

/// What the hull has, by the keys of the answer; the factors that each run draws are left out.
pub(crate) fn truth(campaign: &Campaign) -> Value {
    let hull = &campaign.base;
    let by_inertia = |damping: f64| damping / hull.inertia;
    json!({
        "b1_per_s": by_inertia(hull.b0), "kappa": hull.kappa, "b3_s": by_inertia(hull.b3),
    })
}

/// A coefficient as one model has it.
struct Told {
    /// Share of the truth by which it is off.
    error: f64,
    /// Its 95 % interval holds the truth.
    holds: bool,
}

/// Appends what of the campaigns told right became of the damping.
pub(crate) fn append(page: &mut String, right: &[&Value]) {
    page.push_str(
        "\n## Damping before and after\n\nOff the hull's by, the middle campaign; 95 % interval \
         holds the hull's. *Biased*: the old model's does not.\n\n\
         | coefficient | campaigns | off, before | off, after | holds, before | holds, after | \
         biased | off, before | off, after | holds, after |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    for (key, name) in COEFFICIENTS {
        let all: Vec<[Told; 2]> = right.iter().filter_map(|line| both(line, key)).collect();
        let biased: Vec<&[Told; 2]> = all.iter().filter(|[before, _]| !before.holds).collect();
        let all: Vec<&[Told; 2]> = all.iter().collect();
        writeln!(
            page,
            "| {name} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            all.len(),
            middle(&all, 0),
            middle(&all, 1),
            held(&all, 0),
            held(&all, 1),
            biased.len(),
            middle(&biased, 0),
            middle(&biased, 1),
            held(&biased, 1),
        )
        .expect("text");
    }
}

/// Before and after; nothing where these runs do not tell it.
fn both(line: &Value, key: &str) -> Option<[Told; 2]> {
    let truth = line["truth"][key].as_f64()?;
    let told = |when: &str| {
        let quantity = &line["bias"][key][when];
        let (low, high) = (quantity["lo95"].as_f64()?, quantity["hi95"].as_f64()?);
        let error = (quantity["mean"].as_f64()? / truth - 1.0).abs();
        Some(Told { error, holds: (low..=high).contains(&truth) })
    };
    Some([told("before")?, told("after")?])
}

/// Middle of the errors [%].
fn middle(all: &[&[Told; 2]], when: usize) -> String {
    let mut errors: Vec<f64> = all.iter().map(|told| told[when].error).collect();
    errors.sort_by(f64::total_cmp);
    errors.get(errors.len() / 2).map_or("-".to_owned(), |error| format!("{:.1} %", 100.0 * error))
}

/// Share of the intervals that hold the truth [%].
fn held(all: &[&[Told; 2]], when: usize) -> String {
    let held = all.iter().filter(|told| told[when].holds).count();
    format!("{:.1} %", 100.0 * held as f64 / all.len().max(1) as f64)
}
