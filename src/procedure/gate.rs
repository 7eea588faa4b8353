//! A gate of the procedure with its answer.

use serde::Serialize;

/// What a gate asks, whoever asks it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Gate {
    /// Name in the JSON contract.
    #[serde(rename = "gate")]
    pub id: &'static str,
    /// What is asked, as the heading of a row.
    pub asks: &'static str,
    /// Unit of value and limit.
    pub unit: &'static str,
    /// Where the limit comes from.
    pub source: &'static str,
}

/// The limit is the procedure's own.
pub(super) const ITTC: &str = "ITTC 7.5-02-07-04.5";
/// The procedure asks for it without a number.
pub(super) const OUR_LIMIT: &str = "ITTC 7.5-02-07-04.5, the limit is ours";

/// What became of a gate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Answer {
    /// The gate.
    #[serde(flatten)]
    pub gate: Gate,
    /// Whether it is met; none where it can't be told.
    pub met: Option<bool>,
    /// What was found, in the gate's unit.
    pub value: Option<f64>,
    /// What is asked for, in the gate's unit.
    pub limit: Option<f64>,
    /// The answer in words.
    pub words: String,
}

impl Answer {
    /// The value must reach the limit.
    pub(super) fn at_least(gate: Gate, value: f64, limit: f64, words: String) -> Self {
        // A count of samples or a stretch cut at a sample may lack one part in fifty of it.
        Self::judged(gate, value, limit, value >= 0.98 * limit, words)
    }

    /// The value must not exceed the limit.
    pub(super) fn at_most(gate: Gate, value: f64, limit: f64, words: String) -> Self {
        Self::judged(gate, value, limit, value <= limit, words)
    }

    fn judged(gate: Gate, value: f64, limit: f64, met: bool, words: String) -> Self {
        let known = value.is_finite() && limit.is_finite();
        let met = known.then_some(met);
        let finite = |number: f64| number.is_finite().then_some(number);
        Self { gate, met, value: finite(value), limit: finite(limit), words }
    }

    /// The gate is missed for want of something that has no size.
    pub(super) fn missing(gate: Gate, limit: f64, words: &str) -> Self {
        Self { gate, met: Some(false), value: None, limit: Some(limit), words: words.to_owned() }
    }

    /// The recording does not tell.
    pub(super) fn untold(gate: Gate, words: &str) -> Self {
        Self { gate, met: None, value: None, limit: None, words: words.to_owned() }
    }
}
