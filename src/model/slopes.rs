//! An equation's slopes along its own inputs: the motion, what it remembers, its parameters.

use super::effect::{Instant, Lag, Law, MOST_LAGS};
use super::number::{MOST_PARAMETERS, Sloped, slope};

/// The instant with the motion as inputs.
pub(super) fn inputs<'a>(instant: &Instant<'a>) -> Instant<'a, Sloped> {
    Instant {
        time_s: instant.time_s,
        roll_rad: Sloped::input(instant.roll_rad, slope::ROLL),
        rate_rad_per_s: Sloped::input(instant.rate_rad_per_s, slope::RATE),
        acceleration_rad_per_s2: Sloped::input(
            instant.acceleration_rad_per_s2,
            slope::ACCELERATION,
        ),
        moment_n_m: instant.moment_n_m.into(),
        natural_rad_s: Sloped::input(instant.natural_rad_s, slope::BASE),
        b1_per_s: Sloped::input(instant.b1_per_s, slope::BASE + 1),
        run: instant.run,
    }
}

/// The parameters as inputs.
fn parameters(values: &[f64]) -> [Sloped; MOST_PARAMETERS] {
    std::array::from_fn(|k| {
        Sloped::input(values.get(k).copied().unwrap_or(0.0), slope::PARAMETER + k)
    })
}

/// A law's value with its slopes.
pub(super) fn of_law(law: &Law, instant: &Instant<'_, Sloped>, values: &[f64]) -> Sloped {
    (law.sloped)(instant, &parameters(values)[..values.len()])
}

/// Slopes of the states, and the moment, with their slopes.
pub(super) fn of_lag(
    lag: &Lag,
    instant: &Instant<'_, Sloped>,
    values: &[f64],
    states: &[f64],
) -> ([Sloped; MOST_LAGS], Sloped) {
    let parameters = parameters(values);
    let parameters = &parameters[..values.len()];
    let states: [Sloped; MOST_LAGS] = std::array::from_fn(|k| {
        let state = states.get(k).copied().unwrap_or(0.0);
        Sloped::input(state, slope::REMEMBERED + k)
    });
    let states = &states[..lag.n_states];
    (
        (lag.slope.sloped)(instant, parameters, states),
        (lag.moment.sloped)(instant, parameters, states),
    )
}
