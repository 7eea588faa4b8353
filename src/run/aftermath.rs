//! Follows what the model does after its release until somebody touches it or a minute is over.

use super::Aftermath;
use super::Run;
use super::decay;
use super::decay::START_RAD;
use super::forced::Cycle;
use super::half_cycles::HalfCycle;
use super::records::Records;
use super::ripple::Ripple;

/// Longest time that is followed [s]: the waves of a tank come back within it.
const FOLLOWED_S: f64 = 60.0;
/// Half cycles above the noise that make an aftermath worth a look.
const N_SHOWN: usize = 2;
/// Times of the smallest roll that stands out of the noise from which a half cycle counts.
const SHOWN: f64 = 2.0;
/// Share of the amplitude at release that only a hand reaches again.
const STRUCK: f64 = 0.9;
/// The same of a half cycle that begins with a hold or lasts as no half cycle of the model does.
const TOUCHED: f64 = 0.15;
/// Change of half period that a beat between two motions makes while both are large [-].
const PERIOD_CHANGE: f64 = 0.4;

/// The roll after a decay, as far as it is followed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Following {
    /// Where it begins [s].
    from_s: f64,
    /// End of the decay before it [s], where that is a run.
    run_end_s: Option<f64>,
    /// End of the last half cycle that was the model's own [s].
    end_s: f64,
    /// Where the model comes to rest [rad].
    zero_rad: f64,
    released_rad: f64,
    half_period_s: f64,
    n_shown: usize,
}

impl Following {
    /// Behind the decay of these half cycles that ended at `run_end_s`.
    pub(super) fn behind(used: &[Cycle], run_end_s: f64) -> Option<Self> {
        let halves: Vec<_> = used.iter().map(|cycle| cycle.half).collect();
        let zero_rad = halves.iter().map(middle_rad).sum::<f64>() / halves.len() as f64;
        Some(Self {
            from_s: run_end_s.next_up(),
            run_end_s: Some(run_end_s),
            end_s: run_end_s,
            zero_rad,
            released_rad: halves.first()?.amplitude_rad(),
            half_period_s: decay::half_period_s(&halves),
            n_shown: 0,
        })
    }

    /// From the release with which a half cycle begins, if it begins with one.
    pub(super) fn released(cycle: &Cycle, records: &Records) -> Option<Self> {
        let (half, ripple) = (&cycle.half, records.ripple());
        let is_large = half.amplitude_rad() > (2.0 * START_RAD).max(5.0 * ripple.lost_below_rad);
        let is_release = half.is_from_hold() && is_large && cycle.steady && !cycle.is_driven();
        is_release.then(|| Self {
            from_s: decay::start_s(half, &records.roll, ripple),
            run_end_s: None,
            end_s: half.end.time_s,
            zero_rad: middle_rad(half),
            released_rad: half.amplitude_rad(),
            half_period_s: half.duration_from_hold_s(),
            n_shown: 0,
        })
    }

    /// Whether a decay is the one that this release began: a hand may be on its first period.
    pub(super) fn is_begun_by(&self, run: &Run) -> bool {
        self.run_end_s.is_none() && run.start_s < self.from_s + 2.0 * self.half_period_s
    }

    /// Time [s] from which samples are still needed.
    pub(super) fn needed_from_s(&self) -> f64 {
        self.from_s
    }

    /// Takes the next half cycle; whether the model is still left alone.
    pub(super) fn goes_on(&mut self, cycle: &Cycle, ripple: Ripple) -> bool {
        let half = &cycle.half;
        if half.end.time_s <= self.end_s {
            return true;
        }
        let amplitude_rad = half.amplitude_rad();
        let off = (half.duration_s() / self.half_period_s - 1.0).abs();
        let is_odd = half.is_from_hold() || off > PERIOD_CHANGE;
        let most_rad = if is_odd { TOUCHED } else { STRUCK } * self.released_rad;
        let is_over = self.is_over(half.end.time_s);
        if cycle.is_driven() || !cycle.steady || amplitude_rad > most_rad || is_over {
            return false;
        }
        self.n_shown += usize::from(amplitude_rad > SHOWN * ripple.lost_below_rad);
        self.end_s = half.end.time_s;
        true
    }

    /// Whether a model that is still at `roll_rad` is left alone: nobody holds it at heel.
    pub(super) fn rests_at(&self, roll_rad: f64) -> bool {
        (roll_rad - self.zero_rad).abs() < TOUCHED * self.released_rad
    }

    /// Whether it is over at `time_s`, whatever comes.
    pub(super) fn is_over(&self, time_s: f64) -> bool {
        time_s > self.from_s + FOLLOWED_S
    }

    /// What was followed, if it stands out of the noise.
    pub(super) fn close(self, records: &Records) -> Option<Aftermath> {
        let roll = records.roll.series(self.from_s, self.end_s);
        let drive = records.drive.track.series(self.from_s, self.end_s);
        let is_shown = self.n_shown >= N_SHOWN && !roll.time_s.is_empty();
        is_shown.then_some(Aftermath { run_end_s: self.run_end_s, roll, drive })
    }
}

fn middle_rad(half: &HalfCycle) -> f64 {
    0.5 * (half.start.roll_rad + half.end.roll_rad)
}
