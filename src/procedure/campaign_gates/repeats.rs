//! Was the decay repeated often enough?

use crate::procedure::gate::{Answer, Gate, ITTC};
use crate::results::IdentifiedRun;
use crate::run::RunKind;

const GATE: Gate =
    Gate { id: "repeats", asks: "Decays at this condition and speed", unit: "–", source: ITTC };

/// Decays wanted, from the largest heel.
const N_DECAYS: f64 = 4.0;

pub(super) fn answer(runs: &[&IdentifiedRun]) -> Option<Answer> {
    let decays: Vec<_> = runs.iter().filter(|run| run.run.kind == RunKind::Decay).collect();
    let n = decays.len();
    let heels = decays
        .iter()
        .map(|run| format!("{:.1}", run.identification.initial_roll_rad.mean.abs().to_degrees()));
    let noun = if n == 1 { "decay" } else { "decays" };
    let words = format!("{n} {noun} from {} deg", heels.collect::<Vec<_>>().join(", "));
    (n > 0).then(|| Answer::at_least(GATE, n as f64, N_DECAYS, words))
}
