//! How much of a hidden effect the base model cannot take up: its misfit `lambda`.
//!
//! `lambda = min over the base's coefficients of sum ((with the effect) - (base))^2/sigma^2`, both
//! without noise. The base may adapt everything that a fit may: the damping and its law, inertia
//! and restoring within what hydrostatics leave (10 % and 2 %), the start of each decay, amplitude
//! and phase of the rod, and the run-to-run scatter within its standard deviation. With an effect
//! of the table beside the base, it tells whether that one could stand for the hidden one.

use super::base::{ARM_M, Base};
use super::campaign::{Campaign, Effect};
use super::draw::Draw;
use super::effect::Hiding;
use super::effects::row;
use super::instruments::{MOMENT_NOISE_N_M, ROLL_NOISE_RAD, Rows, record};
use super::least_squares::{Part, minimise};
use super::motion::{Start, simulate};
use super::plan::{Action, Pass};
use super::timeline::Timeline;

/// Step of the fitted simulations [s]: one a sample, which the integrator's order allows.
const STEP_S: f64 = 0.01;
/// Unknowns of the whole campaign: B0, kappa, B3, inertia, restoring, as changes by share.
const SHARED: usize = 5;
/// Prior standard deviations of these; the damping is as good as free.
const SHARED_SD: [f64; SHARED] = [1.0, 1.0, 3.0, 0.10, 0.02];
/// Steps of the derivatives by differences.
const SHARED_STEP: [f64; SHARED] = [1e-3, 1e-2, 1e-2, 1e-5, 1e-5];
/// The restoring among these, and where it may start: a long decay that is a cycle off has a
/// minimum of its own.
const RESTORING: usize = 4;
const RESTORING_STARTS: [f64; 5] = [0.0, -0.04, 0.04, -0.08, 0.08];
/// Unknowns of one run: roll and roll rate at its start, or amplitude and phase; two of scatter.
const OWN: usize = 4;
/// Prior standard deviation and difference step of the start of a run [rad], [rad/s].
pub(super) const START_SD: f64 = 1.0;
pub(super) const START_STEP: f64 = 1e-5;

/// Misfit below which two effects are one class on the runs at hand (EFFECTS.md, section 6).
pub(crate) const INDISTINGUISHABLE: f64 = 12.0;

/// A pass with what it shows.
pub(super) struct Target {
    pub(super) pass: Pass,
    pub(super) rows: Rows,
    pub(super) first: usize,
    pub(super) last: usize,
    roll_sd: f64,
}

/// From a small effect on, either sign is near; as a change by share.
const SMALL: f64 = -0.9;

/// Misfit of the base to what hides in a campaign; `beside` may stand for it, from its values on.
pub(crate) fn misfit(campaign: &Campaign, hidden: &[Effect], beside: Option<&Effect>) -> f64 {
    least(campaign, hidden, beside, SMALL)
}

/// Misfit of the base with one of two hidden effects to both: what is left to find of the other.
pub(crate) fn misfit_beside(campaign: &Campaign, known: &Effect) -> f64 {
    least(campaign, &campaign.effects, Some(known), 0.0)
}

/// The least misfit near where the effect beside the base starts, as a change of its first value.
fn least(campaign: &Campaign, hidden: &[Effect], beside: Option<&Effect>, start: f64) -> f64 {
    let targets: Vec<Target> =
        campaign.passes.iter().map(|pass| target(campaign, hidden, pass)).collect();
    let n_beside = beside.map_or(0, |effect| effect.values.len());
    let n = SHARED + n_beside + OWN * targets.len();
    let mut x = vec![0.0; n];
    let mut priors: Vec<(f64, f64)> = SHARED_SD.map(|sd| (0.0, sd)).to_vec();
    // The values of the effect beside are changes by share; three times either way is its range.
    priors.extend(vec![(0.0, 3.0); n_beside]);
    if n_beside > 0 {
        x[SHARED] = start;
    }
    for (index, target) in targets.iter().enumerate() {
        let at = SHARED + n_beside + OWN * index;
        let start = started(target);
        x[at..at + 2].copy_from_slice(&start);
        let scatter = campaign.asked.scatter.max(1e-6);
        let own = [(start[0], START_SD), (start[1], START_SD), (0.0, scatter), (0.0, scatter)];
        priors.extend(own);
    }
    let model = |x: &[f64], index: usize| modelled(campaign, &targets[index], x, beside, index);
    let parts = |x: &[f64], with_slopes: bool| -> Vec<Part> {
        (0..targets.len())
            .map(|index| {
                let residuals = model(x, index);
                let mut slopes = Vec::new();
                if with_slopes {
                    let own = SHARED + n_beside + OWN * index;
                    for unknown in (0..SHARED + n_beside).chain(own..own + OWN) {
                        let step = step_of(unknown, n_beside);
                        let mut moved = x.to_vec();
                        moved[unknown] += step;
                        let after = model(&moved, index);
                        let slope =
                            after.iter().zip(&residuals).map(|(b, a)| (b - a) / step).collect();
                        slopes.push((unknown, slope));
                    }
                }
                Part { residuals, slopes }
            })
            .collect()
    };
    let squares = |x: &[f64]| -> f64 {
        parts(x, false).iter().flat_map(|part| &part.residuals).map(|r| r * r).sum()
    };
    let starts = RESTORING_STARTS.map(|share| {
        let mut start = x.clone();
        start[RESTORING] = share;
        (squares(&start), start)
    });
    let nearest = starts.into_iter().min_by(|(a, _), (b, _)| a.total_cmp(b));
    minimise(nearest.map_or(x, |(_, start)| start), &priors, 12, parts).sum
}

/// What is left of the hidden effect where another that a program names is fitted beside the base;
/// below [`INDISTINGUISHABLE`] nothing could tell the two apart on these runs.
pub(crate) fn left_by(campaign: &Campaign, cause: &str, hidden: &str) -> f64 {
    let hidden = campaign.effects.iter().find(|effect| effect.row.id == hidden);
    let (Some(hidden), Some(row)) = (hidden, row(cause)) else { return f64::INFINITY };
    let values = (row.draw)(1.0, &mut Draw::named("a middling one"), &campaign.base);
    misfit(campaign, std::slice::from_ref(hidden), Some(&Effect { row, values }))
}

fn step_of(unknown: usize, n_beside: usize) -> f64 {
    if unknown < SHARED {
        SHARED_STEP[unknown]
    } else if unknown < SHARED + n_beside {
        1e-3
    } else if (unknown - SHARED - n_beside) % OWN < 2 {
        START_STEP
    } else {
        1e-3
    }
}

/// The noise-free recording of a pass between the start and the end of its run.
fn target(campaign: &Campaign, hidden: &[Effect], pass: &Pass) -> Target {
    let line = Timeline::of(pass);
    let rows = campaign.rows_with(hidden, pass, false);
    recorded(rows, [line.start_s, line.end_s], pass.as_labelled())
}

/// A stretch of a recording, from one instant [s] to another, to be modelled as a pass.
pub(super) fn recorded(rows: Rows, [from_s, to_s]: [f64; 2], as_pass: Pass) -> Target {
    let at = |time_s: f64| rows.time_s.partition_point(|stamp_s| *stamp_s < time_s - 1e-6);
    let (first, last) = (at(from_s), at(to_s).min(rows.time_s.len()));
    Target { pass: as_pass, first, last, rows, roll_sd: ROLL_NOISE_RAD }
}

/// The start that the plan has: roll and roll rate, or amplitude and phase.
pub(super) fn started(target: &Target) -> [f64; 2] {
    match target.pass.action {
        Action::Decay { heel_rad } => [heel_rad, 0.0],
        Action::Forced { amplitude_rad, .. } => [amplitude_rad, 0.0],
    }
}

/// Model less target of one run, by the noise: roll, and the moment where the rod drives.
fn modelled(
    campaign: &Campaign,
    target: &Target,
    x: &[f64],
    beside: Option<&Effect>,
    index: usize,
) -> Vec<f64> {
    let n_beside = beside.map_or(0, |effect| effect.values.len());
    let own = &x[SHARED + n_beside + OWN * index..][..OWN];
    let was = &campaign.base;
    let base = Base {
        b0: was.b0 * (1.0 + x[0]),
        kappa: was.kappa * (1.0 + x[1]),
        b3: was.b3 * (1.0 + x[2]),
        inertia: was.inertia * (1.0 + x[3]),
        restoring: was.restoring * (1.0 + x[4]),
    };
    let scatter = [0, 1].map(|i| target.pass.scatter[i] * (1.0 + own[2 + i]));
    let pass = Pass { scatter, ..target.pass.clone() };
    let hiding: Hiding = beside.map_or_else(Vec::new, |effect| {
        let changes = &x[SHARED..SHARED + n_beside];
        let values: Vec<f64> =
            effect.values.iter().zip(changes).map(|(value, x)| value * (1.0 + x)).collect();
        let mut hidden = (effect.row.hide)(&values);
        hidden.plan(&mut campaign.passes.clone());
        vec![hidden]
    });
    off_target(target, pass, &base, &hiding, [own[0], own[1]], campaign.has_force())
}

/// Model less target of one run that starts with a roll and a roll rate, or an amplitude and a
/// phase, by the noise: roll, and the moment where it is wanted.
pub(super) fn off_target(
    target: &Target,
    mut pass: Pass,
    base: &Base,
    hiding: &Hiding,
    own: [f64; 2],
    has_force: bool,
) -> Vec<f64> {
    let rows = &target.rows;
    let range = target.first..target.last;
    if let Action::Forced { frequency_rad_s, .. } = pass.action {
        pass.action = Action::Forced { amplitude_rad: own[0], frequency_rad_s };
        // A phase is a later start of everything but the ramp, which is over by then.
        let motion = simulate(&pass, base, hiding, STEP_S, None);
        let shift_s = own[1] / frequency_rad_s;
        let shown = record(motion, &pass, hiding, None);
        let at = |values: &[f64], i: usize| {
            super::instruments::between(values, i as f64 + shift_s / STEP_S)
        };
        let roll = range
            .clone()
            .map(|i| (at(&shown.roll_deg, i) - rows.roll_deg[i]).to_radians() / target.roll_sd);
        let moment = range
            .clone()
            .map(|i| (at(&shown.force_n, i) - rows.force_n[i]) * ARM_M / MOMENT_NOISE_N_M);
        return roll.chain(moment).collect();
    }
    let start = Start { time_s: rows.time_s[target.first], roll: own[0], rate: own[1] };
    let motion = simulate(&pass, base, hiding, STEP_S, Some(start));
    let shown = record(motion, &pass, hiding, None);
    let roll = range
        .clone()
        .zip(&shown.roll_deg)
        .map(|(i, roll)| (roll - rows.roll_deg[i]).to_radians() / target.roll_sd);
    if !has_force {
        return roll.collect();
    }
    let moment = range
        .clone()
        .zip(&shown.force_n)
        .map(|(i, force)| (force - rows.force_n[i]) * ARM_M / MOMENT_NOISE_N_M);
    roll.chain(moment).collect()
}
