//! Decides whether the roll can be trusted to be free.

use super::RunEnd;
use super::forced::Cycle;
use super::half_cycles::Turn;
use super::records::Records;

/// Growth of the amplitude that a change of speed explains no more than a free roll [-].
const GROWTH: f64 = 1.06;
/// Growth of the amplitude that is a blow or a hand, so that what follows is a new start [-].
const NEW_START: f64 = 1.3;
/// Amplitude left by a blow against the roll, as a share of that before it; a hand leaves less.
const STRUCK_SHARE: f64 = 0.5;
/// A carriage that has just reached its speed jolts the model for this long [s].
const JOLT_S: f64 = 1.0;

const TOUCHED: &str = "the roll after a touch is not free without another release";
const DISTURBED: &str = "the roll was still disturbed by the change of speed";
const BEHIND_HOLE: &str = "the roll goes on behind a hole in the record, without a release";

/// What happened since the model was last still that makes a decay doubtful.
#[derive(Debug, Clone, Default)]
pub(super) struct Trust {
    distrust: Option<&'static str>,
    pass_ended: bool,
    touched_rad: f64,
}

impl Trust {
    /// Trust in a roll that goes on behind a hole in the record.
    pub(super) fn behind_hole() -> Self {
        Self { distrust: Some(BEHIND_HOLE), ..Self::default() }
    }

    /// Why no decay can begin; none when one can.
    pub(super) fn distrust(&self) -> Option<&'static str> {
        self.distrust
    }

    /// Whether the pass is over and the model rolls in its own wake.
    pub(super) fn is_spent(&self, records: &Records, time_s: f64) -> bool {
        self.pass_ended && records.carriage.has_slowed(time_s)
    }

    /// A run has ended at this amplitude.
    pub(super) fn run_ended(&mut self, end: RunEnd, amplitude_rad: f64) {
        self.pass_ended |= end == RunEnd::PassEnded;
        self.touched_rad = amplitude_rad;
        self.distrust = match end {
            RunEnd::Caught => Some(TOUCHED),
            RunEnd::PassEnded => Some(DISTURBED),
            _ => None,
        };
    }

    /// The half cycle `next` follows `cycles`.
    pub(super) fn note(&mut self, cycles: &[Cycle], next: &Cycle, records: &Records) {
        let Some(before) = cycles.last() else { return };
        let growth = next.half.amplitude_rad() / before.half.amplitude_rad();
        let settled = before.steady
            && next.steady
            && records.carriage.steady_for_s(before.half.start.time_s) >= JOLT_S;
        // The first half cycle after a rest or a hole is cut off, and the second grows from it.
        let follows = cycles.len() > 1;
        // A hand that stays would have taken more: this was a blow against the roll.
        let struck_back = self.distrust == Some(TOUCHED)
            && next.half.amplitude_rad() >= STRUCK_SHARE * self.touched_rad;
        // No free roll lingers at its turn for as long as a swing takes: a hand held the model.
        let Turn { time_s, left_s, .. } = next.half.start;
        let was_held = next.steady && left_s - time_s > next.half.duration_from_hold_s();
        if was_held {
            self.distrust = None;
        } else if growth > GROWTH && !settled {
            self.distrust = Some(DISTURBED);
        } else if follows && (struck_back || (settled && growth > NEW_START))
            || next.steady && next.half.is_from_hold()
        {
            self.distrust = None;
        }
    }
}
