//! When things happen in a pass, and the motions that hands and rod impose.

use super::plan::{Action, Pass};

/// Acceleration and braking of the carriage [m/s2].
const CARRIAGE_M_S2: f64 = 0.5;
/// What the carriage can use of a tank of 50 m [m].
const TRACK_M: f64 = 43.0;
/// Undisturbed rest at the start of every recording [s].
pub(crate) const REST_S: f64 = 6.0;
/// Hands take the model to its heel [s].
const HEELING_S: f64 = 1.5;
/// Longest decay that the crew waits for [s].
const DECAY_S: f64 = 25.0;
/// The rod takes up its amplitude, and lays it down [s].
const RAMP_S: f64 = 3.0;
/// Steady forced rolling [s].
const FORCED_S: f64 = 22.0;

/// The instants of a pass [s].
#[derive(Clone, Copy, Debug)]
#[expect(clippy::struct_field_names, reason = "each is an instant, and says its unit")]
pub(crate) struct Timeline {
    /// Hands or rod take the model.
    pub(crate) taken_s: f64,
    /// Release of a decay, or the rod at full amplitude.
    pub(crate) start_s: f64,
    /// The carriage brakes, or the rod slows: the run is over.
    pub(crate) end_s: f64,
    /// The recording stops.
    pub(crate) stop_s: f64,
}

impl Timeline {
    /// That of a pass; a fast one has less time, because the tank ends.
    pub(crate) fn of(pass: &Pass) -> Self {
        let taken_s = REST_S;
        if pass.is_forced() {
            let start_s = taken_s + RAMP_S;
            let end_s = start_s + FORCED_S;
            return Self { taken_s, start_s, end_s, stop_s: end_s + RAMP_S + 3.0 };
        }
        let accelerating_s = pass.speed_m_s / CARRIAGE_M_S2;
        // The water needs a moment at speed, the model a moment of stillness.
        let start_s = taken_s + (accelerating_s + 2.0).max(8.0);
        if pass.speed_m_s == 0.0 {
            let end_s = start_s + DECAY_S;
            return Self { taken_s, start_s, end_s, stop_s: end_s };
        }
        let steady_s = (TRACK_M - pass.speed_m_s * accelerating_s) / pass.speed_m_s;
        let at_speed_s = taken_s + accelerating_s;
        let end_s = (at_speed_s + steady_s).min(start_s + DECAY_S);
        let end_s = (end_s * 100.0).floor() / 100.0;
        Self { taken_s, start_s, end_s, stop_s: end_s + accelerating_s + 1.0 }
    }

    /// Speed of the carriage [m/s].
    pub(crate) fn speed_m_s(&self, pass: &Pass, time_s: f64) -> f64 {
        let gained = (time_s - self.taken_s) * CARRIAGE_M_S2;
        let left = pass.speed_m_s - (time_s - self.end_s) * CARRIAGE_M_S2;
        gained.min(left).clamp(0.0, pass.speed_m_s)
    }
}

/// An imposed motion: angle [rad], rate [rad/s], acceleration [rad/s2].
pub(crate) type Imposed = [f64; 3];

/// What hands or rod impose at an instant; none while the model is free.
pub(crate) fn imposed(pass: &Pass, line: &Timeline, time_s: f64) -> Option<Imposed> {
    match pass.action {
        Action::Decay { heel_rad } => {
            if !(line.taken_s..line.start_s).contains(&time_s) {
                return None;
            }
            let mut path = eased((time_s - line.taken_s) / HEELING_S, HEELING_S);
            path = path.map(|value| value * heel_rad);
            // A hand trembles at 1.3 Hz, and stops in the last second before it lets go.
            let tremor_rad =
                0.02_f64.to_radians() * f64::from(u8::from(time_s < line.start_s - 1.0));
            path[0] += tremor_rad * (8.2 * time_s).sin();
            Some(path)
        }
        Action::Forced { amplitude_rad, frequency_rad_s } => {
            let up = eased((time_s - line.taken_s) / RAMP_S, RAMP_S);
            let down = eased((time_s - line.end_s) / RAMP_S, RAMP_S);
            let envelope = [up[0] - down[0], up[1] - down[1], up[2] - down[2]];
            let w = frequency_rad_s;
            let (sin, cos) = (w * (time_s - line.taken_s)).sin_cos();
            let wave = [sin, w * cos, -w * w * sin];
            let angle = envelope[0] * wave[0];
            let rate = envelope[1] * wave[0] + envelope[0] * wave[1];
            let acceleration =
                envelope[2] * wave[0] + 2.0 * envelope[1] * wave[1] + envelope[0] * wave[2];
            Some([angle, rate, acceleration].map(|value| amplitude_rad * value))
        }
    }
}

/// A smooth way from 0 to 1, `x^3 (10 - 15 x + 6 x^2)`, with its two derivatives in time.
fn eased(x: f64, duration_s: f64) -> Imposed {
    let x = x.clamp(0.0, 1.0);
    [
        x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x),
        30.0 * (x * (1.0 - x)).powi(2) / duration_s,
        60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / duration_s.powi(2),
    ]
}
