//! States of an effect that follows a motion which it does not change.

use super::effect::{Instant, Lag, MOST_LAGS};
use super::linear::{Matrix, driven};
use super::number::{Sloped, slope};
use super::slopes;

/// The states at every instant of a motion from those at the first; instants are a step apart.
pub(super) fn follow(
    lag: &Lag,
    values: &[f64],
    start: [f64; MOST_LAGS],
    instants: &[Instant<'_>],
    step_s: f64,
) -> Vec<[f64; MOST_LAGS]> {
    let nil = [0.0; MOST_LAGS];
    let (rows, _) = slopes::of_lag(lag, &slopes::inputs(&instants[0]), values, &nil);
    let forcing = |k: usize| (lag.slope.plain)(&instants[k], values, &nil);
    driven(&jacobian(&rows), start, forcing, instants.len(), step_s)
}

/// What the states do to their own slopes.
pub(super) fn jacobian(rows: &[Sloped; MOST_LAGS]) -> Matrix<MOST_LAGS> {
    rows.map(|row| std::array::from_fn(|k| row.slopes[slope::REMEMBERED + k]))
}
