//! Reading and counting lines of the file of outcomes.

use serde_json::Value;

/// The words of an outcome, in the order of the columns.
const WORDS: [&str; 8] =
    ["named", "in class", "partly", "with more", "wrong name", "adequate", "unexplained", "failed"];

/// A text of a line.
pub(crate) fn text<'a>(outcome: &'a Value, key: &str) -> &'a str {
    outcome[key].as_str().unwrap_or_default()
}

/// Names of what hides in it.
pub(crate) fn hidden(outcome: &Value) -> Vec<&str> {
    outcome["hidden"].as_array().into_iter().flatten().filter_map(Value::as_str).collect()
}

/// The least misfit of what hides in it, each effect alone; nothing for a clean campaign.
pub(crate) fn lambda(outcome: &Value) -> f64 {
    least(outcome, &["lambda"])
}

/// The least misfit of what hides in it, alone and beside the other that hides.
pub(crate) fn lambda_beside(outcome: &Value) -> f64 {
    least(outcome, &["lambda", "lambda_beside"])
}

fn least(outcome: &Value, keys: &[&str]) -> f64 {
    let all = keys.iter().filter_map(|key| outcome[*key].as_array()).flatten();
    let least = all.filter_map(Value::as_f64).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// It holds a name that is not there.
pub(crate) fn is_wrong(outcome: &Value) -> bool {
    ["with more", "wrong name"].contains(&text(outcome, "outcome"))
}

/// How often each outcome came.
pub(crate) struct Count {
    pub(crate) n: usize,
    each: [usize; 8],
}

impl Count {
    /// Counts.
    pub(crate) fn of(outcomes: &[&Value]) -> Self {
        let times =
            |word: &str| outcomes.iter().filter(|outcome| text(outcome, "outcome") == word).count();
        Self { n: outcomes.len(), each: WORDS.map(times) }
    }

    /// All that hides was named, or its class, and nothing else.
    pub(crate) fn right(&self) -> usize {
        self.each[0] + self.each[1]
    }

    /// A name was given that is not there.
    pub(crate) fn wrong(&self) -> usize {
        self.each[3] + self.each[4]
    }

    /// Shares [%] in the order of the columns.
    pub(crate) fn shares(&self) -> String {
        let share = |n: &usize| match (*n, self.n) {
            (0, _) => "0".to_owned(),
            (n, all) => format!("{:.1} %", 100.0 * n as f64 / all as f64),
        };
        self.each.iter().map(share).collect::<Vec<_>>().join(" | ")
    }
}
