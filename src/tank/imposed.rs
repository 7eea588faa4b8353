//! Imposed motions, each joined smoothly to the motion before it.

use std::f64::consts::TAU;

use super::equation::RollState;

/// A roll history with its first two derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Kinematics {
    /// Roll [rad].
    pub(super) roll_rad: f64,
    /// Roll rate [rad/s].
    pub(super) rate_rad_per_s: f64,
    /// Roll acceleration [rad/s2].
    pub(super) acceleration_rad_per_s2: f64,
}

impl Kinematics {
    /// Roll and rate without the acceleration.
    pub(super) fn state(self) -> RollState {
        RollState { roll_rad: self.roll_rad, rate_rad_per_s: self.rate_rad_per_s }
    }

    /// The sum of two motions.
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            roll_rad: self.roll_rad + other.roll_rad,
            rate_rad_per_s: self.rate_rad_per_s + other.rate_rad_per_s,
            acceleration_rad_per_s2: self.acceleration_rad_per_s2 + other.acceleration_rad_per_s2,
        }
    }
}

/// The smooth step `s(x) = 10 x^3 - 15 x^4 + 6 x^5`: its integral, value and two derivatives.
pub(super) fn smooth_step(x: f64) -> [f64; 4] {
    if x <= 0.0 {
        return [0.0; 4];
    }
    if x >= 1.0 {
        return [x - 0.5, 1.0, 0.0, 0.0];
    }
    let (x2, x3) = (x * x, x * x * x);
    [
        x2 * x2 * (2.5 - 3.0 * x + x2),
        x3 * (10.0 - 15.0 * x + 6.0 * x2),
        30.0 * x2 * (1.0 - x).powi(2),
        60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
    ]
}

/// Time in which an imposed motion takes up the speed the model had [s].
///
/// Short, because the model turns on meanwhile: at 1 rad/s by a twentieth of a radian or so.
const TAKE_UP_S: f64 = 0.5;

/// Fifth-degree paths that bring position and rate of a state to zero within `length_s`.
pub(super) fn settle(from: RollState, elapsed_s: f64, length_s: f64) -> Kinematics {
    let [_, s, ds, dds] = smooth_step(elapsed_s / length_s);
    let position = Kinematics {
        roll_rad: from.roll_rad * (1.0 - s),
        rate_rad_per_s: -from.roll_rad * ds / length_s,
        acceleration_rad_per_s2: -from.roll_rad * dds / length_s.powi(2),
    };
    position.plus(take_up(from.rate_rad_per_s, elapsed_s, length_s.min(TAKE_UP_S)))
}

/// The path `x (1 - x)^3 (1 + 3x)`: it starts with a rate and no acceleration, and ends at rest.
fn take_up(rate_rad_per_s: f64, elapsed_s: f64, length_s: f64) -> Kinematics {
    let x = (elapsed_s / length_s).clamp(0.0, 1.0);
    let left = 1.0 - x;
    Kinematics {
        roll_rad: rate_rad_per_s * length_s * x * left.powi(3) * (1.0 + 3.0 * x),
        rate_rad_per_s: rate_rad_per_s * left.powi(2) * (1.0 + 2.0 * x - 15.0 * x * x),
        acceleration_rad_per_s2: rate_rad_per_s / length_s * left * (60.0 * x * x - 36.0 * x),
    }
}

/// Heeling to an angle by hand.
#[derive(Debug, Clone, Copy)]
pub(super) struct Heeling {
    /// State at the start.
    pub(super) from: RollState,
    /// Angle to reach [rad].
    pub(super) heel_rad: f64,
    /// Time to reach it [s].
    pub(super) ramp_s: f64,
    /// Length of the action [s].
    pub(super) duration_s: f64,
    /// Trembling about the angle [rad].
    pub(super) tremor_rad: f64,
}

impl Heeling {
    /// Motion after `elapsed_s` from the start of the action.
    pub(super) fn at(&self, elapsed_s: f64) -> Kinematics {
        let away = RollState { roll_rad: self.from.roll_rad - self.heel_rad, ..self.from };
        let mut motion = settle(away, elapsed_s, self.ramp_s);
        motion.roll_rad += self.heel_rad;
        motion.plus(self.tremor(elapsed_s))
    }

    /// A hand trembles at about 1 Hz, and is still when it heels the model and when it lets go.
    fn tremor(&self, elapsed_s: f64) -> Kinematics {
        let length = self.duration_s - self.ramp_s;
        let t = elapsed_s - self.ramp_s;
        if length <= 0.0 || t <= 0.0 || t >= length {
            return Kinematics { roll_rad: 0.0, rate_rad_per_s: 0.0, acceleration_rad_per_s2: 0.0 };
        }
        // The window sin^2 as two cosines, times the tremor: a sum of three pure tones.
        let (w, r) = (TAU, TAU / length);
        let tone = |amplitude: f64, frequency: f64| Kinematics {
            roll_rad: amplitude * (frequency * t).sin(),
            rate_rad_per_s: amplitude * frequency * (frequency * t).cos(),
            acceleration_rad_per_s2: -amplitude * frequency.powi(2) * (frequency * t).sin(),
        };
        let a = self.tremor_rad;
        tone(0.5 * a, w).plus(tone(-0.25 * a, w - r)).plus(tone(-0.25 * a, w + r))
    }
}

/// The oscillation an imposed motion ends with, so that the next one can go on from it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Oscillation {
    /// Amplitude [rad].
    pub(super) amplitude_rad: f64,
    /// Frequency [rad/s].
    pub(super) frequency_rad_s: f64,
    /// Phase of the cosine [rad].
    pub(super) phase_rad: f64,
}

/// `A cos(theta)` about the position of rest, going over from one oscillation to the next.
#[derive(Debug, Clone, Copy)]
pub(super) struct Oscillating {
    before: Oscillation,
    amplitude_rad: f64,
    frequency_rad_s: f64,
    ramp_s: f64,
    rest_roll_rad: f64,
    left_over: RollState,
}

impl Oscillating {
    /// Goes over from the state `from`, part of the oscillation `before`, within `ramp_s`.
    pub(super) fn new(
        from: RollState,
        before: Oscillation,
        amplitude_rad: f64,
        frequency_rad_s: f64,
        ramp_s: f64,
        rest_roll_rad: f64,
    ) -> Self {
        // Started from rest there is no old frequency to leave, and stopping keeps the last one.
        let before = if before.amplitude_rad == 0.0 {
            Oscillation { amplitude_rad: 0.0, frequency_rad_s, phase_rad: -0.25 * TAU }
        } else {
            before
        };
        let frequency_rad_s =
            if amplitude_rad == 0.0 { before.frequency_rad_s } else { frequency_rad_s };
        let mut oscillating = Self {
            before,
            amplitude_rad,
            frequency_rad_s,
            ramp_s,
            rest_roll_rad,
            left_over: RollState { roll_rad: 0.0, rate_rad_per_s: 0.0 },
        };
        let start = oscillating.at(0.0);
        oscillating.left_over = RollState {
            roll_rad: from.roll_rad - start.roll_rad,
            rate_rad_per_s: from.rate_rad_per_s - start.rate_rad_per_s,
        };
        oscillating
    }

    fn phase_rad(&self, elapsed_s: f64) -> f64 {
        let change = self.frequency_rad_s - self.before.frequency_rad_s;
        let grown_s = smooth_step(elapsed_s / self.ramp_s)[0] * self.ramp_s;
        self.before.phase_rad + self.before.frequency_rad_s * elapsed_s + change * grown_s
    }

    /// Motion after `elapsed_s` from the start of the action.
    pub(super) fn at(&self, elapsed_s: f64) -> Kinematics {
        let [_, s, ds, dds] = smooth_step(elapsed_s / self.ramp_s);
        let grow = self.amplitude_rad - self.before.amplitude_rad;
        let a = self.before.amplitude_rad + grow * s;
        let (da, dda) = (grow * ds / self.ramp_s, grow * dds / self.ramp_s.powi(2));
        let change = self.frequency_rad_s - self.before.frequency_rad_s;
        let w = self.before.frequency_rad_s + change * s;
        let dw = change * ds / self.ramp_s;
        let (sin, cos) = self.phase_rad(elapsed_s).sin_cos();
        let oscillation = Kinematics {
            roll_rad: self.rest_roll_rad + a * cos,
            rate_rad_per_s: da * cos - a * w * sin,
            acceleration_rad_per_s2: (dda - a * w * w) * cos - (2.0 * da * w + a * dw) * sin,
        };
        oscillation.plus(settle(self.left_over, elapsed_s, self.ramp_s))
    }

    /// The oscillation that is left after `elapsed_s`.
    pub(super) fn oscillation(&self, elapsed_s: f64) -> Oscillation {
        Oscillation {
            amplitude_rad: self.amplitude_rad,
            frequency_rad_s: self.frequency_rad_s,
            phase_rad: self.phase_rad(elapsed_s).rem_euclid(TAU),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks roll against rate, and rate against acceleration, by central differences.
    fn derivatives_agree(motion: impl Fn(f64) -> Kinematics, times_s: &[f64]) {
        let h = 1e-5;
        for &t in times_s {
            let (a, m, b) = (motion(t - h), motion(t), motion(t + h));
            let rate = (b.roll_rad - a.roll_rad) / (2.0 * h);
            let acceleration = (b.rate_rad_per_s - a.rate_rad_per_s) / (2.0 * h);
            // Central differences of size 1e-5 are good to about h^2 times the fourth derivative.
            assert!((rate - m.rate_rad_per_s).abs() < 1e-7, "rate at {t} s");
            assert!((acceleration - m.acceleration_rad_per_s2).abs() < 1e-6, "acceleration at {t}");
        }
    }

    #[test]
    fn heeling_starts_where_the_model_is_and_its_derivatives_agree() {
        let from = RollState { roll_rad: -0.05, rate_rad_per_s: 0.3 };
        let heeling =
            Heeling { from, heel_rad: 0.2, ramp_s: 1.5, duration_s: 4.0, tremor_rad: 0.01 };
        let start = heeling.at(0.0);
        assert!((start.roll_rad - from.roll_rad).abs() < 1e-15);
        assert!((start.rate_rad_per_s - from.rate_rad_per_s).abs() < 1e-15);
        derivatives_agree(|t| heeling.at(t), &[0.2, 0.7, 1.3, 2.0, 3.1]);
        let end = heeling.at(4.0);
        assert!((end.roll_rad - 0.2).abs() < 1e-12 && end.rate_rad_per_s.abs() < 1e-12);
    }

    #[test]
    fn one_oscillation_goes_over_into_the_next_without_a_step() {
        let still = RollState { roll_rad: 0.01, rate_rad_per_s: 0.0 };
        let first = Oscillating::new(still, Oscillation::default(), 0.15, 5.12, 2.0, 0.01);
        let end_s = 13.7;
        let second = Oscillating::new(
            first.at(end_s).state(),
            first.oscillation(end_s),
            0.08,
            6.9,
            2.0,
            0.01,
        );
        let (a, b) = (first.at(end_s), second.at(0.0));
        assert!((a.roll_rad - b.roll_rad).abs() < 1e-12);
        assert!((a.acceleration_rad_per_s2 - b.acceleration_rad_per_s2).abs() < 1e-9);
        derivatives_agree(|t| first.at(t), &[0.3, 1.1, 1.9, 6.0]);
        derivatives_agree(|t| second.at(t), &[0.3, 1.1, 1.9, 6.0]);
    }
}
