//! What the model does: whether it rests, how far it still swings, when its last run ended.

use std::collections::VecDeque;

use serde::Serialize;

/// Over so long the swing is taken [s]: a roll period or two of a model.
const SWING_S: f64 = 3.0;
/// Its extremes are kept for stretches of so long [s].
const STRETCH_S: f64 = 0.5;

/// The model as it is now.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Motion {
    /// Whether the run finder sees neither a run nor any other motion.
    pub at_rest: bool,
    /// Since when that is so [s].
    pub since_s: f64,
    /// Half the way between the extremes of the roll over the last seconds [rad]; none without
    /// roll.
    pub swing_rad: Option<f64>,
    /// When the last run ended [s].
    pub run_ended_s: Option<f64>,
    #[serde(skip)]
    stretches: VecDeque<(i64, f64, f64)>,
}

impl Motion {
    /// Takes a sample of the roll [rad].
    pub fn push(&mut self, time_s: f64, roll_rad: f64) {
        let index = (time_s / STRETCH_S).floor() as i64;
        match self.stretches.back_mut() {
            Some((last, low, high)) if *last == index => {
                (*low, *high) = (low.min(roll_rad), high.max(roll_rad));
                return;
            }
            _ => self.stretches.push_back((index, roll_rad, roll_rad)),
        }
        let oldest = index - (SWING_S / STRETCH_S) as i64;
        while self.stretches.front().is_some_and(|(at, ..)| *at < oldest) {
            self.stretches.pop_front();
        }
        let ends = self
            .stretches
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, least, most)| {
                (low.min(*least), high.max(*most))
            });
        self.swing_rad = Some((ends.1 - ends.0) / 2.0);
    }

    /// Whether the model rests at a time [s].
    pub fn note_rest(&mut self, at_rest: bool, now_s: f64) {
        if at_rest != self.at_rest {
            (self.at_rest, self.since_s) = (at_rest, now_s);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Motion;

    #[test]
    fn the_swing_is_that_of_the_last_seconds() {
        let mut motion = Motion::default();
        let roll = |time_s: f64| 0.02 + 0.1 * (-time_s / 10.0).exp() * (6.9 * time_s).sin();
        (0..6000).for_each(|k| motion.push(f64::from(k) * 0.01, roll(f64::from(k) * 0.01)));
        let swing_rad = motion.swing_rad.expect("roll came");
        assert!((2e-4..5e-4).contains(&swing_rad), "{swing_rad}");
    }
}
