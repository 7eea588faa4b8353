//! Do the forced runs climb the ladder of frequencies about resonance?

use crate::procedure::gate::{Answer, Gate, ITTC};
use crate::results::IdentifiedRun;
use crate::run::RunKind;

const GATE: Gate = Gate {
    id: "frequency-ladder",
    asks: "Frequencies of the ladder, two more near the peak",
    unit: "–",
    source: ITTC,
};

/// Rungs of the ladder, as shares of the natural frequency.
const RUNGS: [f64; 7] = [0.8, 0.9, 0.95, 0.975, 1.0, 1.05, 1.2];
/// How near a frequency must come to its rung: half the narrowest gap.
const NEAR: f64 = 0.0125;
/// Shares between which a further frequency is near the peak.
const PEAK: std::ops::Range<f64> = 0.85..1.15;
/// Further frequencies wanted there.
const N_NEAR_PEAK: usize = 2;

pub(super) fn answer(runs: &[&IdentifiedRun]) -> Option<Answer> {
    let frequency =
        |run: &&&IdentifiedRun| Some(run.identification.forced.as_ref()?.frequency_rad_s.mean);
    let forced: Vec<f64> = runs.iter().filter_map(|run| frequency(&run)).collect();
    if forced.is_empty() {
        return None;
    }
    let natural_rad_s = natural_frequency_rad_s(runs);
    let shares: Vec<f64> = forced.iter().map(|frequency| frequency / natural_rad_s).collect();
    let met = |rung: f64| shares.iter().any(|share| (share - rung).abs() <= NEAR);
    let missing: Vec<String> =
        RUNGS.iter().filter(|rung| !met(**rung)).map(ToString::to_string).collect();
    let mut further: Vec<f64> = shares
        .iter()
        .copied()
        .filter(|share| PEAK.contains(share))
        .filter(|share| RUNGS.iter().all(|rung| (share - rung).abs() > NEAR))
        .collect();
    further.sort_by(f64::total_cmp);
    further.dedup_by(|a, b| (*a - *b).abs() < 0.5 * NEAR);
    let n_near_peak = further.len().min(N_NEAR_PEAK);
    let n = RUNGS.len() - missing.len() + n_near_peak;
    let words = if missing.is_empty() {
        format!("every rung, {n_near_peak} more near the peak")
    } else {
        format!(
            "missing {} of the natural frequency; {n_near_peak} more near the peak",
            missing.join(", ")
        )
    };
    Some(Answer::at_least(GATE, n as f64, (RUNGS.len() + N_NEAR_PEAK) as f64, words))
}

/// From the decays where there are any, since a forced run tells its own less well.
fn natural_frequency_rad_s(runs: &[&IdentifiedRun]) -> f64 {
    let of = |kind| -> Vec<f64> {
        let of_kind = runs.iter().filter(|run| run.run.kind == kind);
        of_kind.map(|run| run.identification.natural_frequency_rad_s.mean).collect()
    };
    let decays = of(RunKind::Decay);
    let known = if decays.is_empty() { of(RunKind::Forced) } else { decays };
    known.iter().sum::<f64>() / known.len() as f64
}
