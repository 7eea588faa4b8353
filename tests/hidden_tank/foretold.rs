//! What the true model, with the damping of the other runs, foretells of a run that it is only told
//! the start of.

use serde_json::Value;

use super::base::Base;
use super::campaign::{Campaign, Effect, hiding};
use super::effect::Hiding;
use super::fit::{START_SD, Target, off_target, recorded, started};
use super::instruments::ROLL_NOISE_RAD;
use super::learnt::{ROUNDS, Shown, learnt, shown, slopes};
use super::least_squares::{Part, minimise};
use super::plan::Pass;

/// A run within the recording of a pass, from its first to its last sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stretch {
    /// Place of the pass in the campaign.
    pub(crate) pass: usize,
    /// Its first sample [s].
    pub(crate) from_s: f64,
    /// Its last one [s].
    pub(crate) to_s: f64,
}

/// The runs that an answer tells the moment of: in a hull that damps heavily a decay ends long
/// before the crew stops waiting, and what follows is noise that anyone foretells.
pub(crate) fn stretches(answer: &Value) -> Vec<Stretch> {
    let told = |left: &Value| {
        let (pass, _) = left["run"].as_str()?.strip_prefix("pass_")?.split_once('-')?;
        let time_s = left["time_s"].as_array()?;
        Some(Stretch {
            pass: pass.parse::<usize>().ok()?.checked_sub(1)?,
            from_s: time_s.first()?.as_f64()?,
            to_s: time_s.last()?.as_f64()?,
        })
    };
    answer["residual"]["moment_after"].as_array().into_iter().flatten().filter_map(told).collect()
}

/// Root mean square of recorded less foretold roll [deg], mean over runs; none without a run. The
/// true model has the values of hull and effects, and learns the damping of the day from the other
/// runs, of which it knows all else. Of the run it knows neither the scatter nor what the day drew
/// for it, goes by its label, and finds its start in the recording.
pub(crate) fn rmse_deg(campaign: &Campaign, runs: &[Stretch]) -> Option<f64> {
    let shown: Vec<Shown> = runs.iter().map(|run| shown(campaign, run)).collect();
    let error_rad = |run: &Stretch| {
        let is_other = |other: &&Shown| other.pass.index != run.pass && !other.pass.other_hull;
        let others: Vec<&Shown> = shown.iter().filter(is_other).collect();
        error_rad(campaign, run, &others)
    };
    let sum: f64 = runs.iter().map(error_rad).sum();
    (!runs.is_empty()).then(|| (sum / runs.len() as f64).to_degrees())
}

fn error_rad(campaign: &Campaign, run: &Stretch, others: &[&Shown]) -> f64 {
    let pass = &campaign.passes[run.pass];
    let effects: Vec<Effect> = campaign
        .effects
        .iter()
        .filter(|effect| !is_of_each_pass(campaign, effect, pass))
        .cloned()
        .collect();
    let mut acting = hiding(&effects);
    for hidden in &mut acting {
        hidden.plan(&mut campaign.passes.clone());
    }
    let scatter = learnt(&campaign.base, pass, others, campaign.asked.scatter);
    let lawful = Pass { scatter, ..pass.as_labelled() };
    let base = campaign.base_of(&lawful);
    let target = recorded(campaign.rows(pass, true), [run.from_s, run.to_s], lawful);
    let start = started(&target);
    let off = |x: &[f64]| off_roll(&target, base, &acting, [x[0], x[1]]);
    let n = (target.last - target.first) as f64;
    let priors = start.map(|start| (start, START_SD));
    let least = minimise(start.to_vec(), &priors, ROUNDS, |x, with_slopes| {
        vec![Part { residuals: off(x), slopes: slopes(x, with_slopes, &off) }]
    });
    (least.sum / n).sqrt() * ROLL_NOISE_RAD
}

/// Foretold less recorded roll, by the noise.
fn off_roll(target: &Target, base: &Base, acting: &Hiding, own: [f64; 2]) -> Vec<f64> {
    let mut off = off_target(target, target.pass.clone(), base, acting, own, false);
    off.truncate(target.last - target.first);
    off
}

/// Whether what an effect does in a pass was drawn for that pass, or comes from elsewhere than the
/// model, as the phase of the mains does.
fn is_of_each_pass(campaign: &Campaign, effect: &Effect, pass: &Pass) -> bool {
    if effect.row.id == "instrument.hum" {
        return true;
    }
    let alone = std::slice::from_ref(effect);
    let otherwise = Pass { chance: pass.chance.map(|chance| 1.0 - chance), ..pass.clone() };
    let [here, there] =
        [pass, &otherwise].map(|pass| campaign.rows_with(alone, pass, false).roll_deg);
    here != there
}
