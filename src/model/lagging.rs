//! States of an effect that follows a motion which it does not change.

use super::effect::{Instant, Lag, MOST_LAGS};
use super::linear::middle;

/// The states at every point of a motion, at rest before the first; points are half a step apart.
pub(super) fn follow(
    lag: &Lag,
    values: &[f64],
    points: &[Instant<'_>],
    step_s: f64,
) -> Vec<[f64; MOST_LAGS]> {
    let slope = |point: usize, state: &[f64; MOST_LAGS]| {
        (lag.slope.plain)(&points[point], values, &state[..])
    };
    let mut states = Vec::with_capacity(points.len());
    let mut state = [0.0; MOST_LAGS];
    let mut first = slope(0, &state);
    states.push(state);
    for start in (0..points.len() - 2).step_by(2) {
        let along = |slope: &[f64; MOST_LAGS], share: f64| -> [f64; MOST_LAGS] {
            std::array::from_fn(|i| state[i] + share * step_s * slope[i])
        };
        let second = slope(start + 1, &along(&first, 0.5));
        let third = slope(start + 1, &along(&second, 0.5));
        let fourth = slope(start + 2, &along(&third, 1.0));
        let mean =
            std::array::from_fn(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0);
        let next = along(&mean, 1.0);
        let to = slope(start + 2, &next);
        states.push(middle([&state, &next], [&first, &to], step_s));
        states.push(next);
        (state, first) = (next, to);
    }
    states
}
