//! Finds the last usable instant of a run whose end has been noticed.

use super::RunEnd;
use super::RunKind;
use super::decay;
use super::forced;
use super::forced::Cycle;
use super::half_cycles::HalfCycle;
use super::records::Records;
use super::ripple::Ripple;

/// A stop shows in the roll only some time after it began: so much of a period is dropped before
/// the roll leaves its decay.
const DROPPED: f64 = 1.0 / 6.0;
/// Greatest part of a period dropped to end on a turning point, of which a hand takes a tenth to
/// show in a free roll and a rod nothing.
const DROPPED_MAX_FREE: f64 = 0.55;
const DROPPED_MAX_DRIVEN: f64 = 0.45;

/// What a reason says where the roll did not go on as a decay or a driven roll does.
pub const LEFT_ITS_COURSE: &str = "the roll left its course";

/// Why and when a run really ends.
#[derive(Debug)]
pub(super) struct Usable {
    /// Why.
    pub(super) end: RunEnd,
    /// Last usable instant [s].
    pub(super) end_s: f64,
    /// When the drive, or without one the roll, left its course [s], where it did.
    pub(super) left_s: Option<f64>,
    /// The same as a sentence.
    pub(super) why: String,
}

/// The end of the run of `cycles` that was noticed as `(why, when)`; the usable end may be earlier
/// and for another reason.
pub(super) fn find(
    records: &Records,
    kind: RunKind,
    cycles: &[Cycle],
    (end, end_s): (RunEnd, f64),
) -> Usable {
    let ripple = records.ripple();
    let halves: Vec<HalfCycle> = cycles.iter().map(|c| c.half).collect();
    let at = |end: RunEnd, end_s: f64| {
        let why = format!("{} at {end_s:.1} s", end.clause());
        Usable { end, end_s, left_s: None, why }
    };
    let last_s = halves.last().map_or(end_s, |h| h.end.time_s);
    let is_instant =
        matches!(end, RunEnd::Gap | RunEnd::PassEnded | RunEnd::RecordingEnded | RunEnd::TooLong);
    let until_s = if is_instant { end_s } else { last_s.min(end_s) };
    let half_s = decay::half_period_s(&halves);
    let lost_s = decay::lost_s(&halves, ripple);
    if end == RunEnd::LostInNoise {
        return at(end, lost_s.min(end_s));
    }
    let departures_s = departures_s(records, kind, cycles, &halves, ripple, end_s);
    let Some(left_s) = departures_s.into_iter().flatten().reduce(f64::min) else {
        let fades = kind == RunKind::Decay && is_instant && lost_s < last_s + half_s;
        return if fades && lost_s < until_s {
            at(RunEnd::LostInNoise, lost_s)
        } else {
            at(end, until_s)
        };
    };
    let dropped_max = match kind {
        RunKind::Decay => DROPPED_MAX_FREE,
        RunKind::Forced => DROPPED_MAX_DRIVEN,
    };
    let latest_s = left_s - 2.0 * DROPPED * half_s;
    let first_s = halves.first().map(|h| h.start.left_s);
    let mut turns = halves.iter().rev().map(|h| h.end.time_s).chain(first_s);
    let turn_s = turns.find(|&t| t <= latest_s).unwrap_or(latest_s);
    let end = match (is_instant, kind) {
        (false, _) => end,
        (true, RunKind::Decay) => RunEnd::Caught,
        (true, RunKind::Forced) => RunEnd::ExcitationChanged,
    };
    let why = format!("{}: {LEFT_ITS_COURSE} at {left_s:.1} s", end.clause());
    let end_s = turn_s.max(left_s - 2.0 * dropped_max * half_s);
    // A rod that lets go is gone when its force shows it; the roll may leave earlier or later.
    let [roll_s, drive_s] = departures_s;
    let left_s = drive_s.or(roll_s);
    Usable { end, end_s, left_s, why }
}

/// When roll and drive left their course.
fn departures_s(
    records: &Records,
    kind: RunKind,
    cycles: &[Cycle],
    halves: &[HalfCycle],
    ripple: Ripple,
    end_s: f64,
) -> [Option<f64>; 2] {
    match kind {
        RunKind::Decay => [decay::departure_s(halves, &records.roll, ripple, end_s), None],
        RunKind::Forced => [
            forced::departure_s(cycles, &records.roll, ripple.sd_rad, end_s),
            forced::departure_s(cycles, &records.drive.track, records.drive.sd(), end_s),
        ],
    }
}
