//! Judges half cycle after half cycle whether the roll under the rod is steady.

use super::drive::DriveSwing;
use super::half_cycles::HalfCycle;
use super::harmonic::Harmonic;
use super::ripple::Ripple;
use super::track::Track;

/// A half cycle of the roll with the drive over the full cycle that ends with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cycle {
    /// The half cycle.
    pub(super) half: HalfCycle,
    /// The drive, where one is recorded.
    pub(super) drive: Option<DriveSwing>,
    /// Whether the carriage was steady.
    pub(super) steady: bool,
}

impl Cycle {
    /// Whether the drive stands out of its noise.
    pub(super) fn is_driven(&self) -> bool {
        self.drive.is_some_and(|d| d.is_significant())
    }
}

/// Half cycles that must be steady before a forced run is believed: three periods.
pub(super) const N_SETTLED: usize = 6;
/// The same without a drive channel, where a lightly damped decay must be told apart.
const N_SETTLED_UNDRIVEN: usize = 14;
/// Change of the mean amplitude from the first to the second half of the settled cycles [-].
const TREND: f64 = 0.01;
/// Spread of amplitude about the mean over the settled cycles [-].
const SPREAD: f64 = 0.03;
/// Slope of the logarithm of the amplitude per half cycle below which an undriven roll is held
/// up by something; the KVLCC2 model in calm water has 0.008 and more at 1 deg.
const UNDRIVEN_SLOPE: f64 = 0.003;
/// Deviation of an amplitude at the start of a run from that of its settled cycles [-].
const START_SPREAD: f64 = 0.01;
/// How many half cycles ahead a turning point is foretold.
const N_AHEAD: usize = 4;
/// How far it may miss, as a share of the half period.
const OUT_OF_STEP: f64 = 0.05;
/// Half cycles at the start of a run that must follow the sine of the later ones.
const N_START_CHECKED: usize = 4;
/// Deviation from that sine, of the amplitude.
const ARRIVAL: f64 = 0.02;
/// Deviation of a half period at the start of a run from that of its later half [-].
const START_PERIOD_SPREAD: f64 = 0.012;
/// Deviation of a half period from the mean [-].
const PERIOD_SPREAD: f64 = 0.06;
/// The same over the settled cycles, where a frequency that still changes must be seen [-].
const SETTLED_PERIOD_SPREAD: f64 = 0.025;
/// Deviation of one amplitude that shows another excitation [-].
const CHANGED: f64 = 0.05;
/// Deviation of the drive that shows another excitation [-].
const DRIVE_CHANGED: f64 = 0.1;
/// Deviation from the steady sine that shows where the excitation changed, of the amplitude.
const DEPARTURE: f64 = 0.06;

/// Index from which `cycles` are steady up to the last one; none when they are not.
pub(super) fn settled(cycles: &[Cycle], is_recorded: bool, ripple: Ripple) -> Option<usize> {
    let n = if is_recorded { N_SETTLED } else { N_SETTLED_UNDRIVEN };
    let from = cycles.len().checked_sub(n)?;
    let last = &cycles[from..];
    let level = level(last);
    let noise = ripple.ratio_tolerance(level.amplitude_rad);
    let (early, late) = last.split_at(n / 2);
    let trend = self::level(late).amplitude_rad / self::level(early).amplitude_rad - 1.0;
    let is_flat = if is_recorded {
        last.iter().all(Cycle::is_driven) && trend.abs() <= TREND + 0.5 * noise
    } else {
        trend.abs() <= UNDRIVEN_SLOPE * (n / 2) as f64
    };
    let within = |c: &Cycle, spread: f64| {
        c.steady
            && (c.half.amplitude_rad() / level.amplitude_rad - 1.0).abs() <= spread + 1.5 * noise
            && period_off(c, level) <= SETTLED_PERIOD_SPREAD + noise
    };
    let period_trend = self::level(late).half_period_s / self::level(early).half_period_s - 1.0;
    if level.amplitude_rad < super::decay::START_RAD.max(ripple.lost_below_rad)
        || !is_flat
        || period_trend.abs() > TREND + 0.5 * noise
        || !last.iter().all(|c| within(c, SPREAD))
        || !last[1..].iter().all(|c| same_drive(c, level))
    {
        return None;
    }
    // The drive of a half cycle is that of the full cycle which ends with the next one.
    let mut start = from;
    while start > 0 && within(&cycles[start - 1], START_SPREAD) && same_drive(&cycles[start], level)
    {
        start -= 1;
    }
    Some(start)
}

/// Whether `next` belongs to the steady roll of `run`, at least [`N_SETTLED`] half cycles.
pub(super) fn continues(run: &[Cycle], next: &Cycle, ripple: Ripple) -> bool {
    let recent = level(&run[run.len().saturating_sub(8)..]);
    let first = level(&run[..run.len().min(8)]);
    let noise = ripple.ratio_tolerance(recent.amplitude_rad);
    let off = |from: Level| (next.half.amplitude_rad() / from.amplitude_rad - 1.0).abs();
    off(recent) <= CHANGED + 1.5 * noise
        && off(first) <= 2.0 * CHANGED + 1.5 * noise
        && period_off(next, recent) <= PERIOD_SPREAD + noise
        && is_in_step(run, next, noise)
        && same_drive(next, recent)
}

/// Whether the turning point that ends `next` comes when those before foretell it: frequencies
/// 2.5 % apart differ by less than the noise of one half cycle, but four of them add up.
fn is_in_step(run: &[Cycle], next: &Cycle, noise: f64) -> bool {
    let Some(known) = run.len().checked_sub(N_AHEAD) else { return true };
    let known = &run[known.saturating_sub(2 * N_AHEAD)..known];
    if known.len() < N_AHEAD {
        return true;
    }
    let n = known.len() as f64;
    let middle = 0.5 * (n - 1.0);
    let times_s = || known.iter().map(|c| c.half.end.time_s).enumerate();
    let mean_s = times_s().map(|(_, t)| t).sum::<f64>() / n;
    let spread = times_s().map(|(k, _)| (k as f64 - middle).powi(2)).sum::<f64>();
    let half_s = times_s().map(|(k, t)| (k as f64 - middle) * (t - mean_s)).sum::<f64>() / spread;
    let ahead = n + N_AHEAD as f64 - middle;
    let off_s = next.half.end.time_s - (mean_s + ahead * half_s);
    off_s.abs() <= (OUT_OF_STEP + 2.0 * noise) * half_s
}

/// Number of half cycles at the start of `run` whose amplitude `next` has crept away from while
/// the drive stayed the same, as the answer to a moment does.
pub(super) fn n_crept_from(run: &[Cycle], next: &Cycle, ripple: Ripple) -> usize {
    let recent = level(&run[run.len().saturating_sub(8)..]);
    let noise = ripple.ratio_tolerance(recent.amplitude_rad);
    if recent.drive.is_none()
        || !same_drive(next, recent)
        || !same_drive(&run[0], recent)
        || !is_in_step(run, next, noise)
        || (next.half.amplitude_rad() / recent.amplitude_rad - 1.0).abs() > CHANGED
    {
        return 0;
    }
    let spread = 2.0 * CHANGED + ripple.ratio_tolerance(recent.amplitude_rad);
    let off = |k: &usize| {
        let first = level(&run[*k..(k + 8).min(run.len())]);
        (next.half.amplitude_rad() / first.amplitude_rad - 1.0).abs() > spread
    };
    (0..run.len().saturating_sub(N_SETTLED)).take_while(off).count()
}

/// Mean amplitude and half period, median drive.
#[derive(Debug, Clone, Copy)]
struct Level {
    amplitude_rad: f64,
    half_period_s: f64,
    drive: Option<f64>,
}

fn level(cycles: &[Cycle]) -> Level {
    let n = cycles.len().max(1) as f64;
    let amplitude_rad = cycles.iter().map(|c| c.half.amplitude_rad()).sum::<f64>() / n;
    let half_period_s = match cycles {
        [first, .., last] => (last.half.end.time_s - first.half.start.time_s) / n,
        _ => cycles.first().map_or(0.0, |c| c.half.duration_s()),
    };
    let mut drives: Vec<f64> = cycles.iter().filter_map(|c| c.drive).map(|d| d.amplitude).collect();
    drives.sort_by(f64::total_cmp);
    let drive = drives.get(drives.len() / 2).copied();
    Level { amplitude_rad, half_period_s, drive }
}

fn period_off(cycle: &Cycle, level: Level) -> f64 {
    (cycle.half.duration_s() / level.half_period_s - 1.0).abs()
}

/// Where, going back, the start of a finished `run` leaves the steady sine of what follows [s].
fn arrival_s(run: &[Cycle], roll: &Track, ripple: Ripple) -> Option<f64> {
    let later = run.get(N_START_CHECKED..)?;
    let later = &later[..later.len().min(16)];
    let (first, last) = (later.first()?, later.last()?);
    let (from_s, to_s) = (first.half.start.time_s, last.half.end.time_s);
    let frequency_rad_s = frequency_rad_s(later, roll)?;
    let fit = Harmonic::fit(roll.bins(from_s, to_s), frequency_rad_s, 0.0)?;
    let tolerance_rad = ARRIVAL * fit.amplitude() + 4.0 * ripple.sd_rad;
    fit.departure_s(roll.bins(run[0].half.start.time_s, from_s).rev(), tolerance_rad)
}

/// Number of half cycles at the start of a finished `run` whose amplitude or period was not yet
/// that of its later half.
pub(super) fn n_not_yet_steady(run: &[Cycle], roll: &Track, ripple: Ripple) -> usize {
    let later = level(&run[run.len() / 2..]);
    let noise = ripple.ratio_tolerance(later.amplitude_rad);
    let off = |c: &&Cycle| {
        (c.half.amplitude_rad() / later.amplitude_rad - 1.0).abs() > START_SPREAD + 1.5 * noise
            || period_off(c, later) > START_PERIOD_SPREAD + noise
    };
    let n_off = run[..run.len() / 2].iter().take_while(off).count();
    let arrival_s = arrival_s(&run[n_off..], roll, ripple);
    let early = |c: &&Cycle| arrival_s.is_some_and(|s| c.half.start.time_s < s);
    n_off + run[n_off..].iter().take_while(early).count()
}

fn same_drive(cycle: &Cycle, level: Level) -> bool {
    match (cycle.drive, level.drive) {
        (Some(drive), Some(mean)) => {
            (drive.amplitude - mean).abs() <= DRIVE_CHANGED * mean + 5.0 * drive.noise
        }
        _ => true,
    }
}

/// Where `track` leaves the steady sine of the last cycles of `run` before `until_s`, scanning
/// from the start of its last full cycle; `sd` is the noise of a bin.
pub(super) fn departure_s(run: &[Cycle], track: &Track, sd: f64, until_s: f64) -> Option<f64> {
    // A change is noticed some half cycles late, so the last of them may already hold it.
    let n_late = if run.len() > 3 * N_AHEAD { N_AHEAD + 2 } else { 2 };
    let known = &run[..run.len().saturating_sub(n_late)];
    let known = &known[known.len().saturating_sub(2 * N_AHEAD)..];
    let (first, last) = (known.first()?, known.last()?);
    let half_s = level(known).half_period_s;
    let fit_end_s = last.half.end.time_s;
    let bins = track.bins(first.half.start.time_s, fit_end_s);
    let frequency_rad_s = frequency_rad_s(known, track).unwrap_or(std::f64::consts::PI / half_s);
    let fit = Harmonic::fit(bins, frequency_rad_s, 0.0)?;
    let tolerance = DEPARTURE * fit.amplitude() + 6.0 * sd;
    fit.departure_s(track.bins(fit_end_s, until_s), tolerance)
}

/// Frequency [rad/s] of a steady stretch: the advance of phase between its two ends.
pub(super) fn frequency_rad_s(run: &[Cycle], track: &Track) -> Option<f64> {
    let (first, last) = (run.first()?, run.last()?);
    let (start_s, end_s) = (first.half.start.time_s, last.half.end.time_s);
    let mut frequency_rad_s = std::f64::consts::PI * run.len() as f64 / (end_s - start_s);
    for part in [3.0, 2.0] {
        let length_s = (end_s - start_s) / part;
        let fit = |from_s: f64| {
            Harmonic::fit(track.bins(from_s, from_s + length_s), frequency_rad_s, 0.0)
        };
        let middle_s = 0.5 * (start_s + end_s);
        let (early, late) = (fit(start_s)?, fit(end_s - length_s)?);
        let turn_rad = std::f64::consts::TAU;
        let advance_rad = late.phase_rad(middle_s) - early.phase_rad(middle_s);
        let slip_rad = advance_rad - turn_rad * (advance_rad / turn_rad).round();
        frequency_rad_s += slip_rad / (end_s - start_s - length_s);
    }
    frequency_rad_s.is_finite().then_some(frequency_rad_s)
}

/// Whether the drive over `cycles` only follows a dying roll, as crosstalk of the roll into the
/// force channel does.
pub(super) fn drive_follows_decay(cycles: &[Cycle]) -> bool {
    let [first, .., last] = cycles else { return false };
    let (Some(a), Some(b)) = (first.drive, last.drive) else { return false };
    let roll = last.half.amplitude_rad() / first.half.amplitude_rad();
    let drive = b.amplitude / a.amplitude.max(f64::MIN_POSITIVE);
    let noise = 3.0 * b.noise / a.amplitude.max(f64::MIN_POSITIVE);
    roll < 0.85 && (drive - roll).abs() <= 0.3 * (1.0 - roll) + noise
}

#[cfg(test)]
mod tests {
    use super::super::half_cycles::Turn;
    use super::*;

    fn cycles(amplitudes_deg: &[f64], drive: Option<f64>) -> Vec<Cycle> {
        let mut from = Turn { time_s: 0.0, left_s: 0.0, roll_rad: 0.0 };
        amplitudes_deg
            .iter()
            .enumerate()
            .map(|(k, a)| {
                let swing = 2.0 * a.to_radians() * if k % 2 == 0 { 1.0 } else { -1.0 };
                let time_s = from.time_s + 0.5;
                let end = Turn { time_s, left_s: time_s, roll_rad: from.roll_rad + swing };
                let half = HalfCycle { start: std::mem::replace(&mut from, end), end };
                let drive = drive.map(|amplitude| DriveSwing { amplitude, noise: 0.01 });
                Cycle { half, drive, steady: true }
            })
            .collect()
    }

    #[test]
    fn the_start_up_is_not_part_of_the_steady_roll() {
        let mut amplitudes = vec![1.0, 3.0, 4.0, 4.6, 4.8];
        amplitudes.extend([5.0; 8]);
        let driven = cycles(&amplitudes, Some(2.0));
        assert_eq!(settled(&driven[..9], true, Ripple::default()), None);
        assert_eq!(settled(&driven, true, Ripple::default()), Some(5));
    }

    #[test]
    fn a_lightly_damped_decay_without_force_channel_is_not_forced() {
        let amplitudes: Vec<f64> = (0..20).map(|k| 5.0 * 0.991_f64.powi(k)).collect();
        assert_eq!(settled(&cycles(&amplitudes, None), false, Ripple::default()), None);
        assert!(settled(&cycles(&[5.0; 20], None), false, Ripple::default()).is_some());
    }

    #[test]
    fn another_amplitude_ends_the_steady_roll() {
        let goes_on = |amplitude_deg: f64, drive: f64| {
            let mut run = cycles(&[[5.0; 10].as_slice(), &[amplitude_deg]].concat(), Some(2.0));
            let mut next = run.pop().unwrap();
            next.drive = Some(DriveSwing { amplitude: drive, noise: 0.01 });
            continues(&run, &next, Ripple::default())
        };
        assert!(goes_on(5.1, 2.05));
        assert!(!goes_on(6.0, 2.0));
        assert!(!goes_on(5.0, 3.0));
    }

    #[test]
    fn another_frequency_ends_the_steady_roll_when_it_is_out_of_step() {
        let run = cycles(&[5.0; 16], Some(2.0));
        let slower = |k: usize| {
            let mut run = run.clone();
            for (n, cycle) in run.iter_mut().enumerate().skip(16 - k) {
                cycle.half.end.time_s += 0.025 * 0.5 * (n + k - 15) as f64;
            }
            let next = run.pop().unwrap();
            continues(&run, &next, Ripple::default())
        };
        // One half cycle that is 2.5 % longer is noise, four in a row are another frequency.
        assert!(slower(1));
        assert!(!slower(4));
    }
}
