//! What the true model, with the damping of the other runs, foretells of a run that it is only told
//! the start of.

use super::base::{Base, froude};
use super::campaign::{Campaign, Effect, hiding};
use super::effect::Hiding;
use super::fit::{START_SD, START_STEP, Target, off_target, recorded, started};
use super::instruments::ROLL_NOISE_RAD;
use super::least_squares::{Part, minimise};
use super::plan::Pass;

/// Root mean square of recorded less foretold roll [deg], mean over the runs of a campaign. The
/// true model has the values of hull and effects, but its damping is what the other runs had on the
/// day: no two are alike, and nobody learns more from so few. Of the run it knows neither the
/// scatter nor what the day drew for it, goes by its label, and finds its start in the recording.
pub(crate) fn rmse_deg(campaign: &Campaign) -> f64 {
    let errors: Vec<f64> = campaign.passes.iter().map(|pass| error_rad(campaign, pass)).collect();
    (errors.iter().sum::<f64>() / errors.len() as f64).to_degrees()
}

fn error_rad(campaign: &Campaign, pass: &Pass) -> f64 {
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
    let lawful = Pass { scatter: learnt(campaign, pass), ..pass.as_labelled() };
    let base = campaign.base_of(&lawful);
    let target = recorded(campaign.rows(pass, true), pass, lawful);
    let start = started(&target);
    let off = |x: &[f64]| off_roll(&target, base, &acting, [x[0], x[1]]);
    let parts = |x: &[f64], with_slopes: bool| {
        let residuals = off(x);
        let mut slopes = Vec::new();
        for unknown in (0..2).filter(|_| with_slopes) {
            let mut moved = x.to_vec();
            moved[unknown] += START_STEP;
            let after = off(&moved);
            let slope = after.iter().zip(&residuals).map(|(b, a)| (b - a) / START_STEP).collect();
            slopes.push((unknown, slope));
        }
        vec![Part { residuals, slopes }]
    };
    let n = (target.last - target.first) as f64;
    let priors = start.map(|start| (start, START_SD));
    (minimise(start.to_vec(), &priors, 12, parts).sum / n).sqrt() * ROLL_NOISE_RAD
}

/// Factors on linear and cubic damping in a pass, from those that the other passes of the
/// campaign's hull had for sure: by least squares `B0` and its growth with speed, and the mean
/// cubic one.
fn learnt(campaign: &Campaign, pass: &Pass) -> [f64; 2] {
    let others: Vec<&Pass> = campaign
        .passes
        .iter()
        .filter(|other| other.index != pass.index && !other.other_hull)
        .collect();
    if others.is_empty() {
        return [1.0; 2];
    }
    let n = others.len() as f64;
    let mean = |i: usize| others.iter().map(|other| other.scatter[i]).sum::<f64>() / n;
    let base = &campaign.base;
    // Of a lawful damping the share that speed brings: a factor is a line over it.
    let share = |pass: &Pass| 1.0 - base.b0 / base.linear(froude(pass.speed_m_s));
    let middle = others.iter().map(|other| share(other)).sum::<f64>() / n;
    let moment = |of: &dyn Fn(&Pass) -> f64| -> f64 {
        others.iter().map(|other| (share(other) - middle) * of(other)).sum()
    };
    let spread = moment(&|other| share(other) - middle);
    let slope = if spread > 1e-6 { moment(&|other| other.scatter[0]) / spread } else { 0.0 };
    [mean(0) + slope * (share(pass) - middle), mean(1)]
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
