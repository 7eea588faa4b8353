//! What the emulated instruments see: a model that is heeled, held, released, round after round.

use std::f64::consts::TAU;

/// Length of a round [s].
pub(crate) const ROUND_S: f64 = 40.0;
/// When the model is released in each round [s].
pub(crate) const RELEASED_S: f64 = 12.0;
/// Damping of the free roll [1/s].
pub(crate) const B1_PER_S: f64 = 0.45;

const NATURAL_RAD_S: f64 = 6.905;
const HEEL_RAD: f64 = 0.19;
const HELD_FROM_S: f64 = 6.0;
const HEELING_S: f64 = 1.5;
const CAUGHT_S: f64 = 36.0;
/// Counts of the roll instrument per radian.
const COUNTS_PER_RAD: f64 = 1e5;
/// Standard deviation of the noise, near enough [rad].
const NOISE_RAD: f64 = 6e-4;

/// Counts of the roll instrument at a time of the tank [s].
pub(crate) fn raw_roll(time_s: f64) -> f64 {
    COUNTS_PER_RAD * (roll_rad(time_s.rem_euclid(ROUND_S)) + NOISE_RAD * noise(time_s))
}

/// Millimetres a second of a carriage that stands.
pub(crate) fn raw_speed(time_s: f64) -> f64 {
    noise(time_s + 0.5).round()
}

/// Newtons of a rod that is not there.
pub(crate) fn raw_force(time_s: f64) -> f64 {
    noise(time_s + 0.25)
}

fn roll_rad(time_s: f64) -> f64 {
    match time_s {
        ..HELD_FROM_S | CAUGHT_S.. => 0.0,
        HELD_FROM_S..RELEASED_S => {
            let share = ((time_s - HELD_FROM_S) / HEELING_S).min(1.0);
            HEEL_RAD * share * share * (3.0 - 2.0 * share)
        }
        _ => {
            let free_s = time_s - RELEASED_S;
            let damping = B1_PER_S / 2.0;
            let damped_rad_s = (NATURAL_RAD_S * NATURAL_RAD_S - damping * damping).sqrt();
            let (sin, cos) = (damped_rad_s * free_s).sin_cos();
            HEEL_RAD * (-damping * free_s).exp() * (cos + damping / damped_rad_s * sin)
        }
    }
}

/// Noise that repeats exactly: four tones far above the roll that never meet.
fn noise(time_s: f64) -> f64 {
    let tones = [17.3, 23.9, 31.7, 41.1];
    tones.iter().map(|hz| (TAU * hz * time_s).sin()).sum::<f64>() / 2.0_f64.sqrt()
}
