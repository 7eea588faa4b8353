//! Follows the carriage through rest, speeding up, steady speed and braking.

use std::collections::VecDeque;

use super::bins::Bin;
use super::noise::BinNoise;
use super::noise::Quantum;
use super::track::Track;

/// The speed is steady when it stays within a range for this long [s].
const STEADY_S: f64 = 1.0;
/// How long after an instant [s] it is known whether the speed became steady then.
const KNOWN_AFTER_S: f64 = STEADY_S + 0.4;
/// Range of a steady speed within [`STEADY_S`], as a share of the speed.
const RANGE_SHARE: f64 = 0.04;
/// Deviation from the steady speed that ends it, as a share of the speed.
const LEFT_SHARE: f64 = 0.06;
/// The same of a carriage that wobbles: one that does so by 6 % may have been at a crest when it
/// was taken for steady. Its runs are worth keeping, and what the wobble does to them is for the
/// diagnosis to tell.
const SWUNG_SHARE: f64 = 0.15;
/// Time [s] within which a wobble brings it back to the steady speed: more than half a period of
/// the slowest that is looked for, 0.2 Hz.
const BACK_S: f64 = 3.5;
/// Change of the speed over [`STEADY_S`] at the crest of a wobble, as a share of the speed; by
/// judgement, far below what a carriage that gathers speed changes by where its range is too wide.
const CREST_SHARE: f64 = 0.01;
/// Deviation from the steady speed that is still part of it, as a share of the speed.
const KEPT_SHARE: f64 = 0.015;
/// Speeds below this [m/s] do not matter.
const FLOOR_M_S: f64 = 0.005;
/// Share by which a bin moves the steady level, so that a slow change is followed: some 3 s.
const LEVEL_SHARE: f64 = 0.017;
/// Steady stretches remembered.
const N_STEADY: usize = 16;

/// A stretch of steady speed, rest included.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::struct_field_names, reason = "the units end alike")]
struct Steady {
    start_s: f64,
    end_s: Option<f64>,
    level_m_s: f64,
}

/// How the carriage moved during a stretch of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Passage {
    /// Steady throughout, or no speed was recorded.
    Steady,
    /// Steady at first, up to this time [s].
    Ends(f64),
    /// Not steady at the start.
    Changing,
}

/// The speed channel and its steady stretches.
#[derive(Debug, Clone, Default)]
pub(super) struct CarriagePass {
    /// Samples of the speed [m/s].
    pub(super) track: Track,
    noise: BinNoise,
    quantum: Quantum,
    recent: VecDeque<Bin>,
    level_m_s: f64,
    /// When the speed was last close to its steady level [s]: where a steady stretch ends.
    kept_s: f64,
    n_outside: usize,
    steady: VecDeque<Steady>,
}

impl CarriagePass {
    /// Takes a speed sample.
    pub(super) fn push(&mut self, time_s: f64, speed_m_s: f64) {
        if self.track.hole_before(time_s).is_some() {
            self.track.interrupt();
            self.noise.interrupt();
            self.recent.clear();
        }
        self.quantum.push(speed_m_s);
        if let Some(bin) = self.track.push(time_s, speed_m_s) {
            self.noise.push(bin.value);
            self.recent.push_back(bin);
            while self.recent.front().is_some_and(|b| b.time_s < bin.time_s - 3.0 * STEADY_S) {
                self.recent.pop_front();
            }
            if self.steady.back().is_some_and(|s| s.end_s.is_none()) {
                self.stay_steady(bin);
            } else {
                self.become_steady(bin);
            }
        }
    }

    /// Whether no later sample changes how the carriage moved until `time_s`: a steady stretch ends
    /// at the earliest where the speed was last close to its level.
    pub(super) fn is_known(&self, time_s: f64) -> bool {
        let Some(last_s) = self.track.last_s() else { return true };
        let was_steady = !self.steady.is_empty() && self.kept_s >= time_s;
        was_steady || last_s >= time_s + KNOWN_AFTER_S
    }

    /// How the carriage moved from `start_s` to `end_s`.
    pub(super) fn passage(&self, start_s: f64, end_s: f64) -> Passage {
        if self.track.last_s().is_none() {
            return Passage::Steady;
        }
        let holds = |s: &&Steady| s.start_s <= start_s && s.end_s.is_none_or(|e| start_s < e);
        match self.steady.iter().find(holds) {
            Some(Steady { end_s: Some(left_s), .. }) if *left_s < end_s => Passage::Ends(*left_s),
            Some(_) => Passage::Steady,
            None => Passage::Changing,
        }
    }

    /// How long the speed had been steady at `time_s` [s]; zero when it was not.
    pub(super) fn steady_for_s(&self, time_s: f64) -> f64 {
        if self.track.last_s().is_none() {
            return f64::INFINITY;
        }
        let holds = |s: &&Steady| s.start_s <= time_s && s.end_s.is_none_or(|e| time_s < e);
        self.steady.iter().find(holds).map_or(0.0, |s| time_s - s.start_s)
    }

    /// Whether the carriage was faster in the steady stretch before the one at `time_s`.
    pub(super) fn has_slowed(&self, time_s: f64) -> bool {
        let Some(at) = self.steady.iter().rposition(|s| s.start_s <= time_s) else { return false };
        let level = |k: usize| self.steady[k].level_m_s.abs();
        at > 0 && level(at) < level(at - 1)
    }

    fn ripple_m_s(&self) -> f64 {
        self.noise.sd() + 0.5 * self.quantum.step()
    }

    fn become_steady(&mut self, bin: Bin) {
        let from_s = bin.time_s - STEADY_S;
        if self.recent.front().is_none_or(|b| b.time_s > from_s) {
            return;
        }
        let window = || self.recent.iter().filter(|b| b.time_s >= from_s);
        let (mut low, mut high, mut sum, mut n) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0);
        for b in window() {
            (low, high) = (low.min(b.value), high.max(b.value));
            (sum, n) = (sum + b.value, n + 1);
        }
        let mean_m_s = sum / f64::from(n.max(1));
        let spare_m_s = FLOOR_M_S + 6.0 * self.ripple_m_s();
        let range = |share: f64| share * mean_m_s.abs() + spare_m_s;
        // At the crest of a wobble it ends where it began, as no carriage that gathers speed does.
        let first_m_s = window().next().map_or(mean_m_s, |b| b.value);
        let is_crest = (bin.value - first_m_s).abs() <= range(CREST_SHARE);
        if high - low <= range(if is_crest { SWUNG_SHARE } else { RANGE_SHARE }) {
            if self.steady.len() == N_STEADY {
                self.steady.pop_front();
            }
            let kept = KEPT_SHARE * mean_m_s.abs() + FLOOR_M_S + 2.5 * self.ripple_m_s();
            let settled = |b: &&Bin| b.time_s >= from_s && (b.value - mean_m_s).abs() <= kept;
            let from_s = self.recent.iter().find(settled).map_or(from_s, |b| b.time_s);
            // The very first stretch is taken to reach back to the start of the record.
            let start_s = if self.steady.is_empty() && self.is_first_window() {
                f64::NEG_INFINITY
            } else {
                from_s
            };
            self.steady.push_back(Steady { start_s, end_s: None, level_m_s: mean_m_s });
            (self.level_m_s, self.kept_s, self.n_outside) = (mean_m_s, from_s, 0);
        }
    }

    fn is_first_window(&self) -> bool {
        self.recent
            .iter()
            .zip(self.track.bins(f64::NEG_INFINITY, f64::INFINITY))
            .all(|(a, b)| *a == b)
    }

    fn stay_steady(&mut self, bin: Bin) {
        let level_m_s = self.level_m_s;
        let deviation_m_s = (bin.value - level_m_s).abs();
        let left = (LEFT_SHARE * level_m_s.abs()).max(2.0 * FLOOR_M_S) + 5.0 * self.ripple_m_s();
        let kept = KEPT_SHARE * level_m_s.abs() + 0.5 * FLOOR_M_S + 2.5 * self.ripple_m_s();
        if deviation_m_s <= kept {
            self.kept_s = bin.time_s;
        }
        let swung = left + (SWUNG_SHARE - LEFT_SHARE) * level_m_s.abs();
        let is_back = bin.time_s - self.kept_s < BACK_S;
        if deviation_m_s <= left || is_back && deviation_m_s <= swung {
            self.level_m_s += LEVEL_SHARE * (bin.value - level_m_s);
            self.n_outside = 0;
            return;
        }
        self.n_outside += 1;
        if self.n_outside < 3 {
            return;
        }
        if let Some(steady) = self.steady.back_mut() {
            steady.end_s = Some(self.kept_s.max(steady.start_s));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rest for 3 s, 1 m/s from 5 s, braking at 20 s, rest from 22 s.
    fn pass() -> CarriagePass {
        let mut carriage = CarriagePass::default();
        for k in 0..1250 {
            let t = f64::from(k) * 0.02;
            carriage.push(t, (0.5 * (t - 3.0)).min(0.5 * (22.0 - t)).clamp(0.0, 1.0));
        }
        carriage
    }

    #[test]
    fn a_pass_is_steady_between_speeding_up_and_braking() {
        let carriage = pass();
        assert_eq!(carriage.passage(0.5, 2.5), Passage::Steady);
        assert_eq!(carriage.passage(3.5, 4.0), Passage::Changing);
        assert_eq!(carriage.passage(5.1, 19.8), Passage::Steady);
        let Passage::Ends(end_s) = carriage.passage(6.0, 21.0) else { panic!("braking is missed") };
        assert!((end_s - 20.0).abs() < 0.1, "{end_s} s");
        assert_eq!(carriage.passage(22.3, 24.0), Passage::Steady);
    }

    #[test]
    fn a_steady_speed_is_known_where_it_was_last_steady_and_a_changing_one_later() {
        let mut carriage = CarriagePass::default();
        let told = |carriage: &mut CarriagePass, from_s: f64, to_s: f64| {
            for k in (from_s * 50.0) as usize..(to_s * 50.0) as usize {
                let t = k as f64 * 0.02;
                carriage.push(t, (0.5 * (t - 3.0)).min(0.5 * (22.0 - t)).clamp(0.0, 1.0));
            }
        };
        told(&mut carriage, 0.0, 12.0);
        assert!(carriage.is_known(11.8) && !carriage.is_known(12.1));
        told(&mut carriage, 12.0, 20.5);
        // It has begun to brake: until then it was steady, and from then on nobody knows yet.
        assert!(carriage.is_known(19.9) && !carriage.is_known(20.3));
        assert_eq!(carriage.passage(6.0, 19.9), Passage::Steady);
        assert!(CarriagePass::default().is_known(5.0));
    }

    #[test]
    fn a_speed_that_settles_and_wobbles_is_steady() {
        let mut carriage = CarriagePass::default();
        for k in 0..2000 {
            let t = f64::from(k) * 0.02;
            let settling = 1.0 - 0.1 * (-0.5 * (t - 6.0)).exp();
            let wobble = 0.02 * (1.5 * t).sin();
            let speed = if t < 4.0 { 0.0 } else { (0.45 * (t - 4.0)).min(settling + wobble) };
            carriage.push(t, speed);
        }
        // The last 10 % come with a time constant of 2 s; the wobble of 2 % stays.
        assert_eq!(carriage.passage(9.0, 39.0), Passage::Steady);
        assert_eq!(carriage.passage(5.0, 5.5), Passage::Changing);
    }

    #[test]
    fn a_carriage_that_wobbles_by_six_hundredths_is_steady_until_it_brakes() {
        for frequency_hz in [0.2, 0.35, 0.5] {
            let mut carriage = CarriagePass::default();
            for k in 0..1500 {
                let t = f64::from(k) * 0.02;
                let wobble = 1.0 + 0.06 * (std::f64::consts::TAU * frequency_hz * t).sin();
                carriage.push(t, (0.5 * (t - 3.0)).min(0.5 * (27.0 - t)).clamp(0.0, wobble));
            }
            assert_eq!(carriage.passage(7.5, 22.0), Passage::Steady, "{frequency_hz} Hz");
            let Passage::Ends(end_s) = carriage.passage(8.0, 26.5) else { panic!("no braking") };
            assert!((22.0..25.1).contains(&end_s), "{frequency_hz} Hz: {end_s} s");
        }
    }

    #[test]
    fn a_carriage_that_gathers_speed_slowly_is_steady_once_it_has_it() {
        for gain_m_s2 in [0.04, 0.07, 0.1, 0.2] {
            let mut carriage = CarriagePass::default();
            let there_s = 3.0 + 2.0 / gain_m_s2;
            for k in 0..((there_s + 20.0) * 50.0) as usize {
                let t = k as f64 * 0.02;
                carriage.push(t, (gain_m_s2 * (t - 3.0)).clamp(0.0, 2.0));
            }
            let passage = carriage.passage(there_s + 2.0, there_s + 19.5);
            assert_eq!(passage, Passage::Steady, "{gain_m_s2} m/s2");
            let passage = carriage.passage(there_s - 10.0, there_s);
            assert_ne!(passage, Passage::Steady, "{gain_m_s2} m/s2");
            if gain_m_s2 * STEADY_S > 2.0 * RANGE_SHARE {
                let passage = carriage.passage(there_s - 1.0, there_s - 0.5);
                assert_eq!(passage, Passage::Changing, "{gain_m_s2} m/s2");
            }
        }
    }

    #[test]
    fn a_carriage_that_slows_down_without_end_is_not_steady() {
        let mut carriage = CarriagePass::default();
        for k in 0..1250 {
            let t = f64::from(k) * 0.02;
            carriage.push(t, (0.5 * (t - 3.0)).min(1.2 - 0.04 * t).max(0.0));
        }
        assert_ne!(carriage.passage(6.0, 15.0), Passage::Steady);
    }

    #[test]
    fn a_model_without_speed_channel_is_always_steady() {
        assert_eq!(CarriagePass::default().passage(0.0, 1e3), Passage::Steady);
    }
}
