//! Reads the truth of a pass off its script as played.

use super::action::Action;
use super::motion::{Node, Scene, Stretch};
use super::truth::{RejectedKind, TrueEnd, TrueKind, TrueRejection, TrueRun};

/// Least number of roll periods of a decay that counts as a run [-].
const DECAY_PERIODS_MIN: f64 = 2.0;
/// Least number of periods of a forced run [-].
const FORCED_PERIODS_MIN: f64 = 3.0;
/// Share to which the free rolling of a driven start has died when the run begins [-].
const TRANSIENT_LEFT: f64 = 0.01;

/// Reads runs and unusable stretches off the script as played.
pub(super) struct Witness<'a> {
    /// What moved the model.
    pub(super) scene: &'a Scene<'a>,
    /// What it did.
    pub(super) stretches: &'a [Stretch],
    /// Holes in the roll record: start and end [s].
    pub(super) holes_s: &'a [(f64, f64)],
    /// Standard deviation of all that disturbs the roll record [rad].
    pub(super) roll_noise_rad: f64,
    /// Froude number of the steady stretch [-].
    pub(super) froude: f64,
}

impl Witness<'_> {
    /// Runs and unusable stretches, each in order of time.
    pub(super) fn account(&self) -> (Vec<TrueRun>, Vec<TrueRejection>) {
        let (mut runs, mut unusable) = (Vec::new(), Vec::new());
        for (at, stretch) in self.stretches.iter().enumerate() {
            let (start_s, end_s) = (stretch.start_s, stretch.end_s);
            let mut refuse = |kind, start_s, end_s| {
                if end_s > start_s {
                    unusable.push(TrueRejection { kind, start_s, end_s });
                }
            };
            match stretch.action {
                Action::Rest { .. } => {}
                Action::Hold { .. } => refuse(RejectedKind::Held, start_s, end_s),
                Action::Rock { .. } => refuse(RejectedKind::Rocked, start_s, end_s),
                Action::Catch { .. } => refuse(RejectedKind::Caught, start_s, end_s),
                Action::Stop { ramp_s, .. } => {
                    refuse(RejectedKind::Stopping, start_s, end_s.min(start_s + ramp_s));
                }
                Action::Release { fade_s, .. } => {
                    refuse(RejectedKind::Held, start_s, start_s + fade_s);
                    self.decay(at, start_s + fade_s, &mut runs, &mut unusable);
                }
                Action::Strike { blow_s, .. } => {
                    refuse(RejectedKind::Struck, start_s, start_s + blow_s);
                    self.decay(at, start_s + blow_s, &mut runs, &mut unusable);
                }
                Action::Forced { ramp_s, .. } | Action::Driven { ramp_s, .. } => {
                    let steady_s = (start_s + ramp_s + self.transient_s(at)).min(end_s);
                    refuse(RejectedKind::StartUp, start_s, steady_s);
                    self.forced(at, steady_s, &mut runs, &mut unusable);
                }
                // Nothing need be steady where the moment is measured throughout.
                Action::ForcedSweep { .. }
                | Action::ForcedIrregular { .. }
                | Action::DrivenSweep { .. }
                | Action::DrivenIrregular { .. } => {
                    self.forced(at, start_s, &mut runs, &mut unusable);
                }
            }
        }
        unusable.sort_by(|a, b| a.start_s.total_cmp(&b.start_s));
        (runs, unusable)
    }

    fn natural_frequency_rad_s(&self) -> f64 {
        let model = &self.scene.model;
        (model.restoring_n_m_per_rad / model.inertia_kg_m2).sqrt()
    }

    /// How long free rolling overlays a driven motion; an imposed motion has none.
    fn transient_s(&self, at: usize) -> f64 {
        match self.stretches[at].action {
            Action::Driven { .. } => {
                -TRANSIENT_LEFT.ln() * 2.0 / (self.scene.b1_per_s)(self.scene.carriage.speed_m_s)
            }
            _ => 0.0,
        }
    }

    fn decay(
        &self,
        at: usize,
        start_s: f64,
        runs: &mut Vec<TrueRun>,
        unusable: &mut Vec<TrueRejection>,
    ) {
        let period_s = std::f64::consts::TAU / self.natural_frequency_rad_s();
        // A rest after a release changes nothing: the model goes on rolling.
        let last = (at + 1..self.stretches.len())
            .take_while(|&k| matches!(self.stretches[k].action, Action::Rest { .. }))
            .last()
            .unwrap_or(at);
        let free_end_s = self.stretches[last].end_s;
        let carriage = &self.scene.carriage;
        let mut refuse = |kind, start_s: f64, end_s: f64| {
            if end_s > start_s {
                unusable.push(TrueRejection { kind, start_s, end_s });
            }
        };
        let lost_s = self.lost_in_noise_s(start_s, &self.stretches[at..=last]);
        refuse(RejectedKind::SpeedUp, start_s, carriage.steady_s.min(free_end_s));
        refuse(RejectedKind::Braking, carriage.brake_s.max(start_s), free_end_s.min(lost_s));
        let start_s = start_s.max(carriage.steady_s);
        let hole_s = self.hole_after_s(start_s);
        let (end_s, end) = earliest([
            (lost_s, TrueEnd::LostInNoise),
            (free_end_s, self.what_follows(last)),
            (carriage.brake_s, TrueEnd::PassEnded),
            (hole_s, TrueEnd::Gap),
        ]);
        if end == TrueEnd::Gap {
            refuse(RejectedKind::Gap, end_s, free_end_s.min(lost_s).min(carriage.brake_s));
        }
        if end_s - start_s < DECAY_PERIODS_MIN * period_s {
            refuse(RejectedKind::TooShort, start_s, end_s);
        } else {
            runs.push(self.run(TrueKind::Decay, at, start_s, end_s, end));
        }
    }

    fn forced(
        &self,
        at: usize,
        steady_s: f64,
        runs: &mut Vec<TrueRun>,
        unusable: &mut Vec<TrueRejection>,
    ) {
        let action = self.stretches[at].action;
        let frequency_rad_s = match (action, action.band()) {
            (
                Action::Forced { frequency_rad_s, .. } | Action::Driven { frequency_rad_s, .. },
                _,
            ) => frequency_rad_s,
            (_, Some(band)) => band.middle_rad_s(),
            _ => return,
        };
        let period_s = std::f64::consts::TAU / frequency_rad_s;
        let carriage = &self.scene.carriage;
        let action_end_s = self.stretches[at].end_s;
        let mut start_s = steady_s.max(carriage.steady_s);
        let mut refuse = |kind, start_s: f64, end_s: f64| {
            if end_s > start_s {
                unusable.push(TrueRejection { kind, start_s, end_s });
            }
        };
        refuse(RejectedKind::SpeedUp, steady_s, carriage.steady_s.min(action_end_s));
        refuse(RejectedKind::Braking, carriage.brake_s.max(steady_s), action_end_s);
        let following = match self.what_follows(at) {
            TrueEnd::RecordingEnded => TrueEnd::RecordingEnded,
            _ => TrueEnd::ExcitationChanged,
        };
        // A steady motion can be used on both sides of a hole.
        while start_s < action_end_s.min(carriage.brake_s) {
            let (end_s, end) = earliest([
                (action_end_s, following),
                (carriage.brake_s, TrueEnd::PassEnded),
                (self.hole_after_s(start_s), TrueEnd::Gap),
            ]);
            if end_s - start_s < FORCED_PERIODS_MIN * period_s {
                refuse(RejectedKind::TooShort, start_s, end_s);
            } else {
                runs.push(self.run(TrueKind::Forced, at, start_s, end_s, end));
            }
            let past = |s: f64| self.holes_s.iter().find(|h| h.0 <= s && s < h.1).map(|h| h.1);
            let Some(hole_end_s) = past(end_s).filter(|_| end == TrueEnd::Gap) else { break };
            refuse(RejectedKind::Gap, end_s, hole_end_s);
            start_s = hole_end_s;
        }
    }

    fn hole_after_s(&self, start_s: f64) -> f64 {
        let after = self.holes_s.iter().filter(|h| h.1 > start_s).map(|h| h.0.max(start_s));
        after.fold(f64::INFINITY, f64::min)
    }

    fn what_follows(&self, at: usize) -> TrueEnd {
        match self.stretches.get(at + 1).map(|s| s.action) {
            None => TrueEnd::RecordingEnded,
            Some(Action::Strike { .. }) => TrueEnd::ReStruck,
            Some(Action::Forced { .. } | Action::Driven { .. }) => TrueEnd::ExcitationChanged,
            Some(action) if action.band().is_some() => TrueEnd::ExcitationChanged,
            Some(_) => TrueEnd::Caught,
        }
    }

    /// When the amplitude of free rolling first falls below three times the noise.
    fn lost_in_noise_s(&self, start_s: f64, free: &[Stretch]) -> f64 {
        let w = self.natural_frequency_rad_s();
        let rest = self.scene.model.rest_roll_rad;
        let amplitude = |n: &Node| (n.state.roll_rad - rest).hypot(n.state.rate_rad_per_s / w);
        free.iter()
            .flat_map(|s| &s.nodes)
            .filter(|n| n.time_s >= start_s)
            .find(|n| amplitude(n) < 3.0 * self.roll_noise_rad)
            .map_or(f64::INFINITY, |n| n.time_s)
    }

    fn run(&self, kind: TrueKind, at: usize, start_s: f64, end_s: f64, end: TrueEnd) -> TrueRun {
        let model = &self.scene.model;
        let node = self.stretches[at..]
            .iter()
            .flat_map(|s| &s.nodes)
            .find(|n| n.time_s >= start_s - 1e-9)
            .unwrap_or(&self.stretches[at].nodes[0]);
        let (excitation_rad_s, imposed_amplitude_rad) = match self.stretches[at].action {
            Action::Forced { amplitude_rad, frequency_rad_s, .. } => {
                (Some(frequency_rad_s), Some(amplitude_rad))
            }
            Action::Driven { frequency_rad_s, .. } => (Some(frequency_rad_s), None),
            Action::ForcedSweep { amplitude_rad, .. } => (None, Some(amplitude_rad)),
            _ => (None, None),
        };
        TrueRun {
            kind,
            start_s,
            end_s,
            end,
            froude: self.froude,
            natural_frequency_rad_s: self.natural_frequency_rad_s(),
            b1_per_s: (self.scene.b1_per_s)(self.scene.carriage.speed_m_s),
            b3_s: model.b3_s,
            initial_roll_rad: node.state.roll_rad - model.rest_roll_rad,
            initial_roll_rate_rad_per_s: node.state.rate_rad_per_s,
            inertia_kg_m2: model.inertia_kg_m2,
            excitation_rad_s,
            imposed_amplitude_rad,
        }
    }
}

fn earliest<const N: usize>(ends: [(f64, TrueEnd); N]) -> (f64, TrueEnd) {
    ends.into_iter().fold((f64::INFINITY, TrueEnd::RecordingEnded), |best, next| {
        if next.0 < best.0 { next } else { best }
    })
}
