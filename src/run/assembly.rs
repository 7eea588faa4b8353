//! Makes a run of a stretch that has ended, or says why it cannot be one.

use super::Event;
use super::Limits;
use super::Rejection;
use super::Run;
use super::RunEnd;
use super::RunKind;
use super::Timing;
use super::decay::N_HALF_CYCLES_MIN;
use super::driven;
use super::forced;
use super::forced::Cycle;
use super::records::LEAD_S;
use super::records::Records;

/// Ratio of last to first amplitude above which a decay does not tell its damping from noise.
const DECAY_RATIO_MAX: f64 = 0.97;

/// Half cycles that a decay needs when it begins and ends in the middle of other roll: waves make
/// three falling amplitudes in a row, not six.
const N_BETWEEN_TOUCHES: usize = 6;

/// A stretch whose end is known.
#[derive(Debug)]
pub(super) struct Stretch<'a> {
    /// Decay or forced.
    pub(super) kind: RunKind,
    /// Whether a forced roll repeats at one frequency.
    pub(super) repeats: bool,
    /// First instant [s].
    pub(super) start_s: f64,
    /// Last instant [s].
    pub(super) end_s: f64,
    /// Why it ends.
    pub(super) end: RunEnd,
    /// Its half cycles, those after the end included.
    pub(super) cycles: &'a [Cycle],
    /// Whether it began without a hold or a rest before it, and ended by another touch.
    pub(super) between_touches: bool,
}

impl Stretch<'_> {
    /// The run, or the rejection of the whole stretch.
    pub(super) fn close(&self, records: &Records, limits: &Limits) -> Event {
        let (start_s, end_s) = (self.start_s, self.end_s.max(self.start_s));
        let used = self.used();
        let run = || self.run(used, records, limits);
        match self.refusal(used).map_or_else(run, Err) {
            Ok(run) => Event::Run(run),
            Err(reason) => Event::Rejected(Rejection { start_s, end_s, reason }),
        }
    }

    /// The half cycles that end within the stretch, with a fifth of the last one to spare.
    pub(super) fn used(&self) -> &[Cycle] {
        let whole = |c: &&Cycle| c.half.end.time_s <= self.end_s + 0.2 * c.half.duration_s();
        &self.cycles[..self.cycles.iter().take_while(whole).count()]
    }

    fn n_needed(&self) -> usize {
        match self.kind {
            RunKind::Forced if self.repeats => forced::N_SETTLED,
            RunKind::Forced => driven::N_HALF_CYCLES_MIN,
            RunKind::Decay if self.between_touches => N_BETWEEN_TOUCHES,
            RunKind::Decay => N_HALF_CYCLES_MIN,
        }
    }

    /// Whether it has too few half cycles for a run.
    pub(super) fn is_too_short(&self) -> bool {
        self.used().len() < self.n_needed()
    }

    fn refusal(&self, used: &[Cycle]) -> Option<String> {
        let needed = self.n_needed();
        let n = used.len();
        let what = match self.kind {
            RunKind::Decay => "free decay",
            RunKind::Forced if self.repeats => "steady roll",
            RunKind::Forced => "roll under the rod",
        };
        if n < needed {
            return Some(format!(
                "only {n} half cycles of {what} until {}, at least {needed} are needed",
                self.end.clause()
            ));
        }
        let (first, last) = (used[0].half.amplitude_rad(), used[n - 1].half.amplitude_rad());
        (self.kind == RunKind::Decay && last > DECAY_RATIO_MAX * first).then(|| {
            format!(
                "no decay: the amplitude went from {:.2} deg to {:.2} deg in {n} half cycles, \
                 it must fall by {:.0} % or more",
                first.to_degrees(),
                last.to_degrees(),
                100.0 * (1.0 - DECAY_RATIO_MAX)
            )
        })
    }

    fn run(&self, used: &[Cycle], records: &Records, limits: &Limits) -> Result<Run, String> {
        let (start_s, end_s) = (self.start_s, self.end_s);
        let speed_m_s = records.carriage.track.mean(start_s, end_s);
        if let Some(reason) =
            speed_m_s.or(limits.declared_speed_m_s).and_then(|v| limits.too_fast(v))
        {
            return Err(reason);
        }
        let middle = |c: &Cycle| 0.5 * (c.half.start.roll_rad + c.half.end.roll_rad);
        let mean_rad = used.iter().map(middle).sum::<f64>() / used.len() as f64;
        // A roll that does not repeat may begin with any of its half cycles.
        let n_first = if self.repeats { 1 } else { used.len() };
        let amplitudes = used[..n_first].iter().map(|c| c.half.amplitude_rad());
        let reach_rad = 0.5 * amplitudes.fold(0.0, f64::max);
        let roll = records.roll.series(start_s, end_s);
        let (Some(&start_s), Some(&end_s)) = (roll.time_s.first(), roll.time_s.last()) else {
            return Err("no roll sample in the stretch".to_owned());
        };
        let driven = records.drive.is_recorded();
        let excitation_rad_s = (self.kind == RunKind::Forced && self.repeats)
            .then(|| {
                let track = if driven { &records.drive.track } else { &records.roll };
                forced::frequency_rad_s(used, track)
            })
            .flatten();
        Ok(Run {
            kind: self.kind,
            start_s,
            end_s,
            end: self.end,
            speed_m_s,
            drive: records.drive.track.series(start_s, end_s),
            speed: records.carriage.track.series(start_s, end_s),
            lead: records.roll.series(start_s - LEAD_S, start_s.next_down()),
            roll,
            still: records.still_before(start_s, mean_rad, reach_rad),
            excitation_rad_s,
            timing: Timing::default(),
        })
    }
}

impl RunEnd {
    /// The reason as the end of a sentence that begins with "until".
    pub fn clause(self) -> &'static str {
        match self {
            Self::LostInNoise => "the roll was lost in the noise",
            Self::Caught => "the model was stopped or touched",
            Self::PassEnded => "the carriage left its steady speed",
            Self::ReStruck => "the model was struck or released again",
            Self::ExcitationChanged => "the excitation changed",
            Self::Gap => "the record had a hole",
            Self::RecordingEnded => "the recording ended",
            Self::TooLong => "the longest run was reached",
        }
    }
}
