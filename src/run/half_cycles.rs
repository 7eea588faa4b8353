//! Cuts the roll into half cycles between turning points that stand out of the noise.

use std::collections::VecDeque;

use super::bins::Bin;
use super::ripple::Ripple;

/// A model of which no half cycle is known is still when its roll stays within the noise for this
/// long [s].
const QUIET_S: f64 = 2.0;
/// One that rolled is still when its roll stays within the noise for so many half periods, in which
/// it would have shown a whole swing ...
const QUIET_HALF_PERIODS: f64 = 1.2;
/// ... and for this long at least [s].
pub(super) const QUIET_MIN_S: f64 = 1.0;
/// A half cycle longer than this [s] is no roll, so a creeping mean cannot fill the memory.
const LEG_MAX_S: f64 = 15.0;
/// The roll must come back by this share of its swing, so that a vibration on top of a large roll
/// makes no turning points.
const SHARE_OF_SWING: f64 = 0.15;
/// The same of the swing before, of which bilge keels at speed leave a tenth two half cycles later.
const SHARE_OF_LAST_SWING: f64 = 0.03;

/// Share of a swing by which the roll has clearly left its turning point.
const LEFT_SHARE: f64 = 0.02;

/// A turning point of the roll.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turn {
    /// When [s].
    pub(super) time_s: f64,
    /// When the roll clearly leaves it [s]; long after `time_s` for a model held at heel.
    pub(super) left_s: f64,
    /// Roll [rad].
    pub(super) roll_rad: f64,
}

/// The roll from one turning point to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HalfCycle {
    /// Where it begins.
    pub(super) start: Turn,
    /// Where it ends.
    pub(super) end: Turn,
}

impl HalfCycle {
    /// Half the swing [rad], whatever the mean.
    pub(super) fn amplitude_rad(&self) -> f64 {
        0.5 * (self.end.roll_rad - self.start.roll_rad).abs()
    }

    /// Half a period [s].
    pub(super) fn duration_s(&self) -> f64 {
        self.end.time_s - self.start.time_s
    }

    /// Whether the model was held at the first turning point, or lingered there.
    pub(super) fn is_from_hold(&self) -> bool {
        self.start.left_s - self.start.time_s > 0.3 * self.duration_from_hold_s()
    }

    /// Half a period [s] when the model was held at the first turning point.
    pub(super) fn duration_from_hold_s(&self) -> f64 {
        self.end.time_s - self.start.left_s
    }
}

/// What the roll did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Swing {
    /// A half cycle ended.
    Half(HalfCycle),
    /// The model has been still, or held, up to this time [s].
    Quiet(f64),
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Leg {
    #[default]
    Quiet,
    Rising,
    Falling,
}

/// Finds turning points in the bins of the roll.
#[derive(Debug, Clone, Default)]
pub(super) struct HalfCycles {
    unsmoothed: [Option<Bin>; 2],
    /// Smoothed bins since the last turning point; the last [`QUIET_S`] while the model is still.
    leg_bins: VecDeque<Bin>,
    /// Smoothed bins of the last seconds.
    recent: VecDeque<Bin>,
    leg: Leg,
    turn: Option<Turn>,
    last: Option<HalfCycle>,
}

impl HalfCycles {
    /// Whether the model is still or held.
    pub(super) fn is_quiet(&self) -> bool {
        self.leg == Leg::Quiet
    }

    /// The last turning point, from which the next half cycle will begin.
    pub(super) fn turn(&self) -> Option<Turn> {
        self.turn
    }

    /// Takes the next bin.
    pub(super) fn push(&mut self, bin: Bin, ripple: Ripple) -> Option<Swing> {
        let smooth = match self.unsmoothed {
            [Some(a), Some(b)] => Bin {
                time_s: 0.25 * a.time_s + 0.5 * b.time_s + 0.25 * bin.time_s,
                value: 0.25 * a.value + 0.5 * b.value + 0.25 * bin.value,
            },
            _ => bin,
        };
        self.unsmoothed = [self.unsmoothed[1], Some(bin)];
        self.leg_bins.push_back(smooth);
        if self.becomes_quiet(smooth, ripple) {
            self.leg = Leg::Quiet;
            self.turn = None;
            self.last = None;
            return Some(Swing::Quiet(smooth.time_s));
        }
        match self.leg {
            Leg::Quiet => {
                self.leave_quiet(smooth, ripple);
                None
            }
            Leg::Rising | Leg::Falling => self.turn_round(smooth, ripple).map(Swing::Half),
        }
    }

    /// Whether a moving model has come to rest, or a drift has been taken for motion.
    fn becomes_quiet(&mut self, smooth: Bin, ripple: Ripple) -> bool {
        let needed_s = self.last.map_or(QUIET_S, |half| {
            (QUIET_HALF_PERIODS * half.duration_s()).clamp(QUIET_MIN_S, LEG_MAX_S)
        });
        self.recent.push_back(smooth);
        while self.recent.get(1).is_some_and(|b| b.time_s <= smooth.time_s - needed_s) {
            self.recent.pop_front();
        }
        if self.leg == Leg::Quiet {
            return false;
        }
        let spans = self.recent.front().is_some_and(|b| b.time_s <= smooth.time_s - needed_s);
        let (low, high) = range(&self.recent);
        let creeps = self.leg_bins.front().is_some_and(|b| smooth.time_s - b.time_s > LEG_MAX_S);
        creeps || (spans && high - low < ripple.quiet_range_rad())
    }

    fn leave_quiet(&mut self, smooth: Bin, ripple: Ripple) {
        while self.leg_bins.get(1).is_some_and(|b| b.time_s <= smooth.time_s - QUIET_S) {
            self.leg_bins.pop_front();
        }
        let (low, high) = range(&self.leg_bins);
        if smooth.value >= low + ripple.hysteresis_rad() {
            self.leg = Leg::Rising;
            self.turn = self.lowest(ripple, 1.0);
        } else if smooth.value <= high - ripple.hysteresis_rad() {
            self.leg = Leg::Falling;
            self.turn = self.lowest(ripple, -1.0);
        }
    }

    fn turn_round(&mut self, smooth: Bin, ripple: Ripple) -> Option<HalfCycle> {
        let last_rad = self.last.map_or(0.0, |h| 2.0 * h.amplitude_rad());
        let (low, high) = range(&self.leg_bins);
        let needed_rad = ripple
            .hysteresis_rad()
            .max(SHARE_OF_SWING * (high - low))
            .max(SHARE_OF_LAST_SWING * last_rad);
        let end = match self.leg {
            Leg::Rising if smooth.value <= high - needed_rad => {
                self.leg = Leg::Falling;
                self.lowest(ripple, -1.0)?
            }
            Leg::Falling if smooth.value >= low + needed_rad => {
                self.leg = Leg::Rising;
                self.lowest(ripple, 1.0)?
            }
            _ => return None,
        };
        let mut half = HalfCycle { start: self.turn.replace(end)?, end };
        half.start.left_s = self.left_s(&half, ripple);
        while self.leg_bins.front().is_some_and(|b| b.time_s < end.time_s) {
            self.leg_bins.pop_front();
        }
        self.last = Some(half);
        Some(half)
    }

    /// When the roll has clearly left the start of `half` [s], now that its swing is known.
    fn left_s(&self, half: &HalfCycle, ripple: Ripple) -> f64 {
        let near_rad = 4.5 * ripple.sd_rad + LEFT_SHARE * 2.0 * half.amplitude_rad();
        let start = half.start;
        let near =
            |b: &&Bin| b.time_s < half.end.time_s && (b.value - start.roll_rad).abs() <= near_rad;
        self.leg_bins.iter().rev().find(near).map_or(start.time_s, |b| b.time_s.max(start.time_s))
    }

    /// The lowest point of the leg for `sign` 1, the highest for -1.
    fn lowest(&self, ripple: Ripple, sign: f64) -> Option<Turn> {
        let height = |k: usize| sign * self.leg_bins[k].value;
        let n = self.leg_bins.len();
        let at = (0..n).min_by(|&i, &j| height(i).total_cmp(&height(j)))?;
        let (low, high) = range(&self.leg_bins);
        // The mean of a held model is some 2 sd above the lowest of its bins.
        let near = height(at) + 4.5 * ripple.sd_rad + 0.01 * (high - low);
        let first = (0..=at).find(|&k| height(k) <= near).unwrap_or(at);
        let last = (at..n).rev().find(|&k| height(k) <= near).unwrap_or(at);
        let left_s = self.leg_bins[last].time_s;
        let time_s = if last <= first + 2 {
            self.vertex_s(at)
        } else {
            0.5 * (self.leg_bins[first].time_s + left_s)
        };
        let roll_rad = self.leg_bins[at].value;
        Some(Turn { time_s, left_s: left_s.max(time_s), roll_rad })
    }

    /// Time of the vertex of the parabola through a bin and its neighbours [s].
    fn vertex_s(&self, at: usize) -> f64 {
        let here = self.leg_bins[at];
        let (Some(a), Some(c)) =
            (at.checked_sub(1).map(|k| self.leg_bins[k]), self.leg_bins.get(at + 1))
        else {
            return here.time_s;
        };
        let bend = a.value - 2.0 * here.value + c.value;
        if bend == 0.0 {
            return here.time_s;
        }
        let shift = (0.5 * (a.value - c.value) / bend).clamp(-0.5, 0.5);
        here.time_s + shift * 0.5 * (c.time_s - a.time_s)
    }
}

fn range(bins: &VecDeque<Bin>) -> (f64, f64) {
    bins.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), bin| {
        (low.min(bin.value), high.max(bin.value))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half_cycles(roll: impl Fn(f64) -> f64, end_s: f64) -> Vec<HalfCycle> {
        let mut finder = HalfCycles::default();
        let n_bins = (end_s / 0.05) as usize;
        (0..n_bins)
            .filter_map(|k| {
                let time_s = k as f64 * 0.05;
                finder.push(Bin { time_s, value: roll(time_s) }, Ripple::default())
            })
            .filter_map(|swing| match swing {
                Swing::Half(half) => Some(half),
                Swing::Quiet(_) => None,
            })
            .collect()
    }

    #[test]
    fn a_model_released_from_heel_leaves_its_first_turning_point_at_the_release() {
        let roll = |t: f64| 0.1 + if t < 5.0 { 0.2 } else { 0.2 * (3.0 * (t - 5.0)).cos() };
        let found = half_cycles(roll, 12.0);
        assert!(found.len() >= 5);
        // One bin of 0.05 s and the 0.02 deg by which it must have left.
        assert!((found[0].start.left_s - 5.0).abs() < 0.1, "{:?}", found[0]);
        assert!((found[0].end.time_s - 5.0 - std::f64::consts::PI / 3.0).abs() < 0.03);
        assert!(found.iter().all(|h| (h.amplitude_rad() - 0.2).abs() < 0.005));
    }

    #[test]
    fn half_a_second_of_period_still_has_its_turning_points() {
        let found = half_cycles(|t| 0.1 * (std::f64::consts::TAU * t / 0.5).sin(), 10.0);
        assert!((37..=40).contains(&found.len()), "{}", found.len());
        let periods: Vec<f64> = found.iter().map(|h| 2.0 * h.duration_s()).collect();
        assert!(periods[2..].iter().all(|t| (t - 0.5).abs() < 0.04), "{periods:?}");
    }

    #[test]
    fn a_model_that_comes_to_rest_is_quiet() {
        let mut finder = HalfCycles::default();
        let quiet = (0..400).find_map(|k| {
            let t = f64::from(k) * 0.05;
            let value = if t < 4.0 { 0.1 * (3.0 * t).sin() } else { 0.0 };
            match finder.push(Bin { time_s: t, value }, Ripple::default()) {
                Some(Swing::Quiet(at_s)) => Some(at_s),
                _ => None,
            }
        });
        // Half a period of 1.05 s, and a fifth of it more.
        assert!((5.2..5.6).contains(&quiet.unwrap()), "{quiet:?}");
    }
}
