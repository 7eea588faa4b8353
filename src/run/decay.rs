//! Judges half cycle after half cycle whether the model still rolls freely.

use super::RunEnd;
use super::bins::Bin;
use super::half_cycles::HalfCycle;
use super::harmonic::Harmonic;
use super::ripple::Ripple;
use super::track::Track;

/// Smallest first amplitude [rad] of a decay: 0.6 deg, so that a release at 1 deg is found whose
/// first half cycle is strongly damped, and the rolling of a model at rest is not.
pub(super) const START_RAD: f64 = 0.010_5;
/// Half cycles a decay needs for a damping that depends on amplitude.
pub(super) const N_HALF_CYCLES_MIN: usize = 3;
/// Shortest and longest half period of a roll [s].
const HALF_PERIOD_S: std::ops::RangeInclusive<f64> = 0.2..=7.5;
/// Change of half period from one half cycle to the next that large angles explain [-].
const PERIOD_CHANGE: f64 = 0.2;
/// Growth of the amplitude that waves left in the tank explain [-].
const GROWTH: f64 = 0.06;
/// Fall of the amplitude ratio, from one half cycle to the next, that friction explains [-].
const RATIO_FALL: f64 = 0.12;
/// Rise of the amplitude ratio with falling amplitude below which the first half cycle is free:
/// damping never grows as the amplitude falls by more than this [-].
const RATIO_RISE: f64 = 0.04;
/// Share of the next fall of amplitude that the first must show after a hand rocked the model up.
const ROCKED_FALL: f64 = 0.75;
/// Change of half period after a hand has rocked the model up [-].
const ROCKED_CHANGE: f64 = 0.03;
/// Deviation from the decay that shows a hand, as a share of the amplitude.
const DEPARTURE: f64 = 0.06;
/// Growth of the amplitude by a hand that rocks the model up [-].
const ROCKED: f64 = 1.02;
/// Share of the swing by which a model let go has come away from the hand.
const LET_GO_SHARE: f64 = 0.1;
/// About the length of a bin [s].
const BIN_S: f64 = 0.06;

/// What the next half cycle means for a decay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Verdict {
    /// The decay goes on.
    Continues,
    /// The decay goes on, but the hand was still on its first half cycle.
    DropsFirst,
    /// The decay ended before this half cycle.
    Ends(RunEnd),
}

/// Whether two successive half cycles can be the start of a decay.
pub(super) fn begins(first: &HalfCycle, second: &HalfCycle, ripple: Ripple) -> bool {
    let (a, b) = (first.amplitude_rad(), second.amplitude_rad());
    let off = |first_s: f64| (second.duration_s() - first_s).abs() / second.duration_s();
    let (from_hold, from_turn) = (off(first.duration_from_hold_s()), off(first.duration_s()));
    // The end of a hold is known to a bin or so.
    let hold_tolerance = BIN_S / second.duration_s();
    a >= START_RAD.max(ripple.lost_below_rad)
        && HALF_PERIOD_S.contains(&second.duration_s())
        && from_hold.min(from_turn) <= period_tolerance(second, ripple) + hold_tolerance
        && b <= a * (1.0 + 0.01 + ripple.ratio_tolerance(a))
        && b >= 0.1 * a
}

/// Whether a hand rocked the model up to the half cycle at `start`, so that it may still have been
/// on it then: large amplitudes grew before it.
pub(super) fn is_rocked_up(halves: &[HalfCycle], start: usize) -> bool {
    let grew = |k: &usize| {
        let (before, after) = (halves[k - 1].amplitude_rad(), halves[*k].amplitude_rad());
        before >= START_RAD && after > ROCKED * before
    };
    (start.saturating_sub(2).max(1)..=start).filter(grew).count() >= 2
}

/// First instant [s] at which the model rolls free in a decay whose first half cycle is `first`.
///
/// A hand lets go within some time, so a decay from a hold begins when the roll has come away
/// from it by a tenth of its swing; a free turning point is its own start.
pub(super) fn start_s(first: &HalfCycle, roll: &Track, ripple: Ripple) -> f64 {
    if !first.is_from_hold() {
        return first.start.left_s;
    }
    let near_rad = LET_GO_SHARE * 2.0 * first.amplitude_rad() + 3.0 * ripple.sd_rad;
    let near = |b: &Bin| (b.value - first.start.roll_rad).abs() <= near_rad;
    let bins = roll.bins(first.start.time_s, first.end.time_s);
    bins.filter(near)
        .map(|b| b.time_s)
        .take_while(|&t| t <= first.end.time_s)
        .last()
        .map_or(first.start.left_s, |t| t.max(first.start.left_s))
}

/// What `next` means for a decay that has lasted for the half cycles of `chain`, at least two.
///
/// After a hand has rocked the model up (`rocked`), its first half cycle must follow the law of
/// the later ones closely.
pub(super) fn judge(
    chain: &[HalfCycle],
    next: &HalfCycle,
    ripple: Ripple,
    rocked: bool,
) -> Verdict {
    let [.., last] = chain else { return Verdict::Continues };
    let (due, amplitude_rad) = (due_rad(chain), next.amplitude_rad());
    let ratio = amplitude_rad / last.amplitude_rad();
    let due_ratio = due / last.amplitude_rad();
    let tolerance = ripple.ratio_tolerance(last.amplitude_rad());
    if amplitude_rad < ripple.lost_below_rad && due < 1.5 * ripple.lost_below_rad {
        return Verdict::Ends(RunEnd::LostInNoise);
    }
    let near_noise = amplitude_rad.max(due) < 2.0 * ripple.lost_below_rad;
    let end = |end| Verdict::Ends(if near_noise { RunEnd::LostInNoise } else { end });
    let period = next.duration_s() / half_period_s(chain);
    if (period - 1.0).abs() > period_tolerance(next, ripple) {
        return end(if ratio > 1.1 { RunEnd::ReStruck } else { RunEnd::Caught });
    }
    if ratio > 1.0 + GROWTH + 1.5 * tolerance {
        return end(RunEnd::ReStruck);
    }
    if let [first, second] = chain {
        let first_ratio = second.amplitude_rad() / first.amplitude_rad();
        let first_period = second.duration_s() / first.duration_s();
        let pushed = if rocked {
            1.0 - first_ratio < ROCKED_FALL * (1.0 - ratio) - 0.5 * tolerance
                || (first_period - 1.0).abs() > ROCKED_CHANGE + tolerance
        } else {
            first_ratio > ratio + RATIO_RISE + 1.5 * tolerance
        };
        if pushed {
            return Verdict::DropsFirst;
        }
    }
    if ratio < due_ratio - RATIO_FALL - 1.5 * tolerance {
        return if due < 1.5 * ripple.lost_below_rad {
            Verdict::Ends(RunEnd::LostInNoise)
        } else {
            Verdict::Ends(RunEnd::Caught)
        };
    }
    Verdict::Continues
}

/// Amplitude [rad] that the next half cycle should have, from the last three ratios.
pub(super) fn due_rad(chain: &[HalfCycle]) -> f64 {
    let recent = &chain[chain.len().saturating_sub(4)..];
    let [first, .., last] = recent else {
        return recent.first().map_or(0.0, HalfCycle::amplitude_rad);
    };
    let total = last.amplitude_rad() / first.amplitude_rad();
    last.amplitude_rad() * total.powf(1.0 / (recent.len() - 1) as f64)
}

/// When [s] the amplitude falls below the noise near the end of `chain`, by the line through the
/// logarithms of its last amplitudes.
pub(super) fn lost_s(chain: &[HalfCycle], ripple: Ripple) -> f64 {
    let Some(last) = chain.last() else { return f64::NEG_INFINITY };
    // Far above the noise the logarithm is no line.
    let n_low = chain.iter().rev().take_while(|h| h.amplitude_rad() < 5.0 * ripple.lost_below_rad);
    let n_low = n_low.count().clamp(3, 8);
    let recent = &chain[chain.len().saturating_sub(n_low)..];
    let points = || {
        let middle = |h: &HalfCycle| 0.5 * (h.start.left_s + h.end.time_s) - last.end.time_s;
        recent.iter().map(move |h| (middle(h), amplitude_less_noise(h, ripple).ln()))
    };
    let n = recent.len() as f64;
    let mean_s = points().map(|p| p.0).sum::<f64>() / n;
    let mean_ln = points().map(|p| p.1).sum::<f64>() / n;
    let slope = points().map(|p| (p.0 - mean_s) * p.1).sum::<f64>()
        / points().map(|p| (p.0 - mean_s).powi(2)).sum::<f64>();
    let half_s = half_period_s(chain);
    // With less than three half cycles, or none that falls, the last turning point must do.
    let after_s = (mean_s + (ripple.lost_below_rad.ln() - mean_ln) / slope)
        .clamp(-1.5 * half_s, 2.0 * half_s);
    let falls = slope < 0.0 && after_s.is_finite();
    last.end.time_s + if falls { after_s } else { 0.0 }
}

/// Amplitude [rad] without what noise adds by the choice of the highest of the bins near a turning
/// point, of which an eighth are independent and level with it.
fn amplitude_less_noise(half: &HalfCycle, ripple: Ripple) -> f64 {
    let n_level = (half.duration_s() / (8.0 * BIN_S)).max(1.0);
    let excess_rad = ripple.sd_rad * (2.0 * n_level.ln()).sqrt();
    (half.amplitude_rad() - excess_rad).max(0.5 * half.amplitude_rad())
}

/// Half period [s] of the last half cycles.
pub(super) fn half_period_s(chain: &[HalfCycle]) -> f64 {
    let [first, rest @ ..] = chain else { return 0.0 };
    if rest.is_empty() {
        // It may begin with a hold.
        return first.duration_from_hold_s();
    }
    let recent = &rest[rest.len().saturating_sub(3)..];
    recent.iter().map(HalfCycle::duration_s).sum::<f64>() / recent.len() as f64
}

/// Noise moves a turning point by some `sd / amplitude` radian of phase.
fn period_tolerance(half: &HalfCycle, ripple: Ripple) -> f64 {
    PERIOD_CHANGE + 2.0 * ripple.ratio_tolerance(half.amplitude_rad())
}

/// Where the roll leaves the decay of `chain` before `until_s`, by extrapolation of its last two
/// half cycles; none when it does not.
pub(super) fn departure_s(
    chain: &[HalfCycle],
    roll: &Track,
    ripple: Ripple,
    until_s: f64,
) -> Option<f64> {
    let [.., before, last] = chain else { return None };
    let half_s = half_period_s(chain);
    let frequency_rad_s = std::f64::consts::PI / half_s;
    let decay_per_s = (last.amplitude_rad() / due_rad(chain)).ln() / half_s;
    let from_s = before.start.left_s;
    let fit = Harmonic::fit(roll.bins(from_s, last.end.time_s), frequency_rad_s, decay_per_s)?;
    let tolerance_rad = DEPARTURE * last.amplitude_rad() + 8.0 * ripple.sd_rad;
    fit.departure_s(roll.bins(last.end.time_s, until_s), tolerance_rad)
}

#[cfg(test)]
mod tests {
    use super::super::half_cycles::Turn;
    use super::*;

    /// Half cycles of 1 s through these turning points [deg].
    fn chain(turns_deg: &[f64]) -> Vec<HalfCycle> {
        let turn = |k: usize| Turn {
            time_s: k as f64,
            left_s: k as f64,
            roll_rad: turns_deg[k].to_radians(),
        };
        (1..turns_deg.len()).map(|k| HalfCycle { start: turn(k - 1), end: turn(k) }).collect()
    }

    fn verdict(turns_deg: &[f64]) -> Verdict {
        let ripple = Ripple { lost_below_rad: 0.15_f64.to_radians(), ..Ripple::default() };
        let halves = chain(turns_deg);
        let (next, before) = halves.split_last().unwrap();
        judge(before, next, ripple, false)
    }

    #[test]
    fn a_decay_goes_on_until_it_is_lost_caught_or_struck() {
        assert_eq!(verdict(&[10.0, -9.0, 8.1, -7.3, 6.6]), Verdict::Continues);
        assert_eq!(verdict(&[10.0, -9.0, 8.1, -7.3, 1.0]), Verdict::Ends(RunEnd::Caught));
        assert_eq!(verdict(&[10.0, -9.0, 8.1, -7.3, 12.0]), Verdict::Ends(RunEnd::ReStruck));
        assert_eq!(verdict(&[0.26, -0.22, 0.19, -0.16, 0.12]), Verdict::Ends(RunEnd::LostInNoise));
    }

    #[test]
    fn a_half_cycle_that_a_hand_still_pushed_is_dropped() {
        assert_eq!(verdict(&[8.0, -9.0, 7.5, -6.3]), Verdict::DropsFirst);
        assert_eq!(verdict(&[9.0, -7.7, 6.7, -5.9]), Verdict::Continues);
    }
}
