//! Runs that could be made, and how each would be observed.

use crate::campaign::Tank;
use crate::diagnosis::fit::run_fit::{ChannelNoise, RunState};
use crate::diagnosis::fit::survey::{Fit, Survey};
use crate::diagnosis::record::observation::Observation;
use crate::model::course::N_COURSE;
use crate::model::lead::Lead;
use crate::run::RunKind;

/// A run as it would be made.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRun {
    /// `decay`, `forced` or `rest_reading`.
    pub kind: &'static str,
    /// Froude number [-].
    pub froude: f64,
    /// Frequency of the excitation [rad/s] of a forced run.
    pub frequency_rad_s: Option<f64>,
    /// Roll amplitude [deg].
    pub amplitude_deg: f64,
}

/// A run that could be made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Plan {
    pub(super) kind: RunKind,
    /// Froude number [-].
    pub(super) froude: f64,
    /// Heel of a decay, amplitude of a forced run [deg].
    pub(super) amplitude_deg: f64,
    /// Excitation over natural frequency [-].
    pub(super) tuning: f64,
}

/// Length that the carriage may run steadily, as a share of the tank.
const STEADY_SHARE: f64 = 0.7;
const LONGEST_S: f64 = 25.0;
const SHORTEST_S: f64 = 8.0;
/// Periods after which a planned rod has settled.
const PLANNED_START_PERIODS: f64 = 2.0;
/// Between samples of a run that was not made [s].
pub(super) const SAMPLE_S: f64 = 0.02;
/// Froude numbers at which the rod may be asked for [-].
const FORCED_FROUDES: [f64; 3] = [0.0, 0.2, 0.4];
/// Amplitude that may be asked for, over the largest that was rolled: beyond it the law is not
/// known, nor whether the deck stays dry.
const REACH: f64 = 1.8;
/// Amplitude that may be asked for, over the end of the roll channel's range where that was met.
const WITHIN_RANGE: f64 = 0.95;

/// Every run that the tank allows, with its length [s].
pub(super) fn plans(tank: &Tank, survey: &Survey) -> Vec<(Plan, f64)> {
    let run = &survey.runs[0];
    let rolled_rad = survey.runs.iter().map(|run| run.at.amplitude_rad).fold(0.0, f64::max);
    let largest_deg = REACH * rolled_rad.to_degrees();
    let unit_m_s = run.at.speed_m_s / run.at.froude.max(1e-9);
    let mut plans = Vec::new();
    for froude in [0.0, 0.05, 0.1, 0.2, 0.3, 0.4] {
        // Without a run under way the speed of a Froude number is not known here.
        let speed_m_s = if run.at.froude > 0.01 { froude * unit_m_s } else { froude * 4.95 };
        if tank.carriage_max_speed_m_s.is_some_and(|most| speed_m_s > most) {
            continue;
        }
        let steady_s = tank.length_m.map_or(LONGEST_S, |m| STEADY_SHARE * m / speed_m_s.max(1e-9));
        let span_s = steady_s.min(LONGEST_S);
        if span_s < SHORTEST_S {
            continue;
        }
        for amplitude_deg in [4.0, 10.0, 15.0, -15.0, 25.0] {
            plans.push((Plan { kind: RunKind::Decay, froude, amplitude_deg, tuning: 1.0 }, span_s));
        }
        if FORCED_FROUDES.iter().any(|f| (froude - f).abs() < 1e-9) {
            // Lag and skew of a channel part only well above resonance (EFFECTS.md, section 6).
            for tuning in [0.75, 1.0, 1.2, 1.5] {
                for amplitude_deg in [5.0, 10.0, 15.0] {
                    plans.push((
                        Plan { kind: RunKind::Forced, froude, amplitude_deg, tuning },
                        span_s,
                    ));
                }
            }
        }
    }
    // What a channel cannot read says nothing.
    let ends = survey.runs.iter().filter_map(|run| run.facts.clip);
    let end_deg = ends.map(|clip| clip.level_rad.to_degrees()).fold(f64::INFINITY, f64::min);
    let most_deg = largest_deg.max(4.0).min(WITHIN_RANGE * end_deg);
    plans.retain(|(plan, _)| plan.amplitude_deg.abs() <= most_deg);
    plans
}

impl Plan {
    /// The run as it is told, for a model of this natural frequency [rad/s].
    pub(super) fn told(&self, natural_rad_s: f64) -> PlannedRun {
        let is_forced = self.kind == RunKind::Forced;
        PlannedRun {
            kind: self.kind.name(),
            froude: self.froude,
            frequency_rad_s: is_forced.then_some(self.tuning * natural_rad_s),
            amplitude_deg: self.amplitude_deg,
        }
    }

    /// The same in words.
    pub(super) fn words(&self, natural_rad_s: f64) -> String {
        let Self { froude, amplitude_deg, .. } = self;
        if self.kind == RunKind::Decay {
            return format!("a decay from {amplitude_deg:.0} deg at Fr {froude:.2}");
        }
        let w = self.tuning * natural_rad_s;
        let place = if (self.tuning - 1.0).abs() < 0.01 { "at" } else { "off" };
        format!(
            "a forced run of {amplitude_deg:.0} deg at {w:.2} rad/s ({place} resonance) and \
             Fr {froude:.2}"
        )
    }

    /// The run as it would be observed under a fit, without the noise that it is weighed by:
    /// standard deviation and correlation of neighbours in roll and moment.
    pub(super) fn observed(
        &self,
        survey: &Survey,
        fit: &Fit,
        span_s: f64,
        to_come: [Option<(f64, f64)>; 2],
    ) -> (Observation, RunState, ChannelNoise) {
        let like = &survey.runs[0];
        let law = &fit.laws[survey.condition_of[0]];
        let [w, b1, b3] = law.at(self.froude);
        let amplitude_rad = self.amplitude_deg.to_radians();
        let rolling_rad_s = self.tuning * w;
        let mut at = like.at;
        at.kind = self.kind;
        let unit_m_s = if at.froude > 0.01 { at.speed_m_s / at.froude } else { 4.95 };
        (at.froude, at.speed_m_s) = (self.froude, self.froude * unit_m_s);
        (at.rolling_rad_s, at.span_s) = (rolling_rad_s, span_s);
        at.amplitude_rad = amplitude_rad.abs();
        at.initial_roll_rad = amplitude_rad;
        at.rolled_for_s = PLANNED_START_PERIODS * std::f64::consts::TAU / rolling_rad_s;
        at.b1_per_s = b1.max(1e-3);
        at.has_moment = self.kind == RunKind::Forced;
        at.order = survey.runs.len();
        let times: Vec<f64> =
            (0..(span_s / SAMPLE_S) as usize).map(|i| i as f64 * SAMPLE_S).collect();
        let mut run = Observation::clone(like);
        run.at = at;
        run.lead = Lead::default();
        run.moment_time_s = if at.has_moment { times.clone() } else { Vec::new() };
        run.roll_time_s = times;
        let mut own = vec![amplitude_rad, 0.0, 0.0];
        if self.kind == RunKind::Forced {
            own = vec![0.0; N_COURSE + 1];
            own[1] = amplitude_rad;
            own[N_COURSE - 1] = rolling_rad_s;
        }
        let mut base = like.base;
        (base.natural_rad_s, base.b1_per_s, base.b3_s) = (w, b1, b3);
        base.log_scale = fit.log_scale;
        let state = RunState { own, base };
        let stiffness = at.inertia_kg_m2 * w * w;
        // A load cell resolves about a thousandth of the model's moment at half a radian.
        let unheard = [like.rough_noise[0], 6e-4 * stiffness];
        let heard = [0, 1].map(|channel| to_come[channel].unwrap_or((unheard[channel], 0.0)));
        let noise =
            ChannelNoise { sd: heard.map(|(sd, _)| sd), correlation: heard.map(|(_, rho)| rho) };
        (run, state, noise)
    }
}
