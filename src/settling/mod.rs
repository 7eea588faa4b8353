//! How calm the water is between two runs, by the roll that it still gives the model.
//!
//! Samples of the roll are pushed in. Windows of six seconds tell the level of the roll
//! (`window`), and its logarithm is followed by a line whose slope may wander (`trend`). Nothing
//! here reads a clock: the time to go counts from the last sample.

mod trend;
mod window;

use serde::Serialize;

use trend::Trend;
use window::{Level, Windows};

/// Windows remembered: eight minutes.
const N_KEPT: usize = 80;
/// Windows that a forecast needs.
const N_NEEDED: usize = 4;
/// A level that rises by more than this factor was stirred anew.
const STIRRED: f64 = 1.6;
/// The waves are seen apart from the model's own roll when the level falls by less than this share
/// of its steepest fall, in logarithms.
const WAVES_SHARE: f64 = 0.35;
/// Windows below the limit in a row that are calm.
const N_CALM: usize = 2;

/// What is known of the water.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Calm {
    /// Amplitude of the roll over the last six seconds, noise apart [deg]; none before they are
    /// full.
    pub level_deg: Option<f64>,
    /// Time in which it falls to 1/e at the present rate [s], where it falls.
    pub decay_time_s: Option<f64>,
    /// When it will be calm.
    pub to_go: ToGo,
}

/// When the level stays below the limit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "state", rename_all = "kebab-case")]
pub enum ToGo {
    /// It does already.
    Calm,
    /// In so many seconds from the last sample.
    Seconds {
        /// As likely sooner as later [s].
        median_s: f64,
        /// Lower end of the central 95 % interval [s].
        lo95_s: f64,
        /// Upper end [s].
        hi95_s: f64,
    },
    /// Nobody can tell yet.
    CantTell {
        /// Why.
        why: &'static str,
    },
}

/// Follows the roll from run to run.
#[derive(Debug)]
pub struct Settling {
    limit_rad: f64,
    windows: Windows,
    levels: Vec<Level>,
    last_s: f64,
}

impl Settling {
    /// Nothing is known yet; the water is calm below `limit_deg`.
    pub fn new(limit_deg: f64) -> Self {
        Self {
            limit_rad: limit_deg.to_radians(),
            windows: Windows::default(),
            levels: Vec::new(),
            last_s: 0.0,
        }
    }

    /// Takes the next sample of the roll, never earlier than the last one.
    pub fn push(&mut self, time_s: f64, roll_rad: f64) {
        self.last_s = time_s;
        let Some(level) = self.windows.push(time_s, roll_rad) else { return };
        let last = self.levels.last();
        if last.is_some_and(|last| level.roll_rad > STIRRED * last.roll_rad.max(last.blur_rad)) {
            self.levels.clear();
        }
        if self.levels.len() == N_KEPT {
            self.levels.remove(0);
        }
        self.levels.push(level);
    }

    /// What is known now.
    pub fn calm(&self) -> Calm {
        let level_deg = self.levels.last().map(|level| level.roll_rad.to_degrees());
        let waves = &self.levels[self.waves_from()..];
        let trend = (waves.len() >= N_NEEDED).then(|| Trend::of(waves));
        let slope_per_s = trend.as_ref().map(Trend::slope_per_s);
        let decay_time_s = slope_per_s.filter(|slope| *slope < 0.0).map(|slope| -1.0 / slope);
        Calm { level_deg, decay_time_s, to_go: self.to_go(trend.as_ref()) }
    }

    fn to_go(&self, trend: Option<&Trend>) -> ToGo {
        let is_below = |level: &Level| level.roll_rad.max(level.blur_rad) <= self.limit_rad;
        let last = self.levels.iter().rev().take(N_CALM);
        if last.len() == N_CALM && last.clone().all(is_below) {
            return ToGo::Calm;
        }
        let cant_tell = |why| ToGo::CantTell { why };
        if last.clone().any(|level| level.blur_rad > self.limit_rad) {
            return cant_tell("the noise of the roll hides the limit");
        }
        if self.waves_from() == 0 {
            return cant_tell("the model itself still rolls, the waves behind it are not seen yet");
        }
        let Some(trend) = trend else {
            return cant_tell("too little has been seen of the waves behind the model's own roll");
        };
        let crossing = trend.crossing(self.limit_rad.ln(), self.last_s);
        crossing.unwrap_or(cant_tell("the roll does not fall evenly enough"))
    }

    /// Index of the first level of the waves alone: behind the last steep fall, which is the
    /// model's own, and the window in which one goes over into the other.
    fn waves_from(&self) -> usize {
        let fall =
            |pair: &[Level]| (pair[0].log() - pair[1].log()) / (pair[1].time_s - pair[0].time_s);
        let falls: Vec<f64> = self.levels.windows(2).map(fall).collect();
        let steepest = falls.iter().copied().fold(0.0, f64::max);
        let steep = |fall: &f64| *fall > WAVES_SHARE * steepest && steepest > 0.0;
        let last = falls.iter().rposition(steep).map_or(0, |index| index + 2);
        last.min(self.levels.len().saturating_sub(1))
    }
}
