//! Gathers roll that no run uses into rejections.

use std::collections::VecDeque;

use super::Rejection;
use super::RunEnd;
use super::decay::N_HALF_CYCLES_MIN;
use super::decay::START_RAD;
use super::driven::N_OWN;
use super::forced::Cycle;

/// Half cycles that a run which begins later may still take back.
const N_REMEMBERED: usize = 64;

/// Why a stretch of roll is not used.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cause {
    /// The carriage was not steady.
    SpeedChanging,
    /// The roll neither decayed nor was steady.
    Unsettled,
    /// The rod drove the model, and the roll was not steady.
    DrivenUnsettled,
    /// No decay can begin here, for this reason.
    Distrusted(&'static str),
    /// A run ended, and the roll went on.
    After(RunEnd, String),
}

/// A stretch of roll that no run has used so far.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Unused {
    start_s: f64,
    end_s: f64,
    n_large: usize,
    largest_rad: f64,
    /// The last half cycles: a run may yet begin before them.
    last: VecDeque<Cycle>,
    cause: Cause,
}

impl Unused {
    /// A stretch that begins at `start_s`.
    pub(super) fn new(start_s: f64, cause: Cause) -> Self {
        Self { start_s, end_s: start_s, n_large: 0, largest_rad: 0.0, last: VecDeque::new(), cause }
    }

    /// A stretch that begins with the half cycle `cycle`.
    pub(super) fn from_cycle(cycle: &Cycle, distrust: Option<&'static str>) -> Self {
        let cause = if let Some(why) = distrust {
            Cause::Distrusted(why)
        } else if !cycle.steady {
            Cause::SpeedChanging
        } else if cycle.is_driven() {
            Cause::DrivenUnsettled
        } else {
            Cause::Unsettled
        };
        Self::new(cycle.half.start.time_s, cause)
    }

    /// Takes more half cycles that no run uses.
    pub(super) fn extend_by(&mut self, cycles: &[Cycle]) {
        for cycle in cycles {
            self.extend(cycle);
        }
    }

    /// Takes another half cycle that no run uses.
    pub(super) fn extend(&mut self, cycle: &Cycle) {
        if self.last.len() == N_REMEMBERED {
            self.last.pop_front().iter().for_each(|oldest| self.count(oldest));
        }
        self.last.push_back(*cycle);
        match self.cause {
            Cause::Unsettled | Cause::DrivenUnsettled if !cycle.steady => {
                self.cause = Cause::SpeedChanging;
            }
            Cause::Unsettled if cycle.is_driven() => self.cause = Cause::DrivenUnsettled,
            _ => {}
        }
    }

    fn count(&mut self, cycle: &Cycle) {
        self.end_s = self.end_s.max(cycle.half.end.time_s);
        let amplitude_rad = cycle.half.amplitude_rad();
        self.n_large += usize::from(amplitude_rad >= START_RAD);
        self.largest_rad = self.largest_rad.max(amplitude_rad);
        // What trembles before the first roll to speak of is rest.
        if self.n_large == 0 && !matches!(self.cause, Cause::After(..)) {
            self.start_s = cycle.half.end.time_s;
        }
    }

    /// The rejection of the stretch up to `end_s` at the latest; none when it was no roll to
    /// speak of, or what every run has around it.
    pub(super) fn close(mut self, end_s: f64) -> Option<Rejection> {
        for cycle in std::mem::take(&mut self.last) {
            if cycle.half.end.time_s <= end_s {
                self.count(&cycle);
            }
        }
        let end_s = self.end_s.min(end_s);
        let matters = match self.cause {
            Cause::After(RunEnd::LostInNoise, _) => self.n_large >= N_HALF_CYCLES_MIN,
            Cause::After(..) => self.n_large > 0 || self.largest_rad > 0.25 * START_RAD,
            _ => self.n_large >= N_HALF_CYCLES_MIN,
        };
        if !matters || end_s <= self.start_s {
            return None;
        }
        let largest_deg = self.largest_rad.to_degrees();
        let rolled = format!("roll of up to {largest_deg:.2} deg");
        let reason = match self.cause {
            Cause::SpeedChanging => {
                format!("{rolled} while the carriage was changing its speed")
            }
            Cause::Distrusted(why) => format!("{rolled}, but {why}"),
            Cause::Unsettled => {
                format!("{rolled} that neither decays freely nor is steady, such as a hand makes")
            }
            Cause::DrivenUnsettled => format!(
                "{rolled} under the rod that is not steady: its amplitude or period changes by \
                 more than 3 % within three periods, and fewer than {N_OWN} half cycles of it have \
                 an excitation of their own"
            ),
            Cause::After(_, why) => format!("{why}; {rolled} after that is not used"),
        };
        Some(Rejection { start_s: self.start_s, end_s, reason })
    }
}
