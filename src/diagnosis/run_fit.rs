//! One run under a model: what its channels should read, and what each number does to them.

use super::elimination::{Eliminated, Products};
use super::observation::Observation;
use crate::model::imposed::{Course, N_COURSE};
use crate::model::{Acts, Base, Term, free, imposed};
use crate::run::RunKind;

/// Numbers of the base equation in one run: frequency, linear and cubic damping, moment scale.
pub(super) const N_BASE: usize = 4;
/// Standard deviation of the zero offset that a run may have beside the campaign's [rad]: what
/// taking a zero leaves.
const OFFSET_SD_RAD: f64 = 1e-4;

/// The noise of the channels of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ChannelNoise {
    /// Standard deviation of a value of roll [rad] and moment [N m].
    pub(super) sd: [f64; 2],
    /// Correlation of neighbouring values [-].
    pub(super) correlation: [f64; 2],
}

/// The numbers of one run.
#[derive(Debug, Clone)]
pub(super) struct RunState {
    /// Initial state or course, then the run's own offset.
    pub(super) own: Vec<f64>,
    /// Base equation.
    pub(super) base: Base,
}

/// What both channels should read, one after the other.
pub(super) fn predict(run: &Observation, state: &RunState, terms: &[Term]) -> Vec<f64> {
    let own = &state.own;
    let (times, moments) = (&run.roll_time_s, &run.moment_time_s);
    let (mut roll, moment) = match run.at.kind {
        RunKind::Decay => {
            free::readings(&run.at, &state.base, terms, (own[0], own[1]), times, moments)
        }
        RunKind::Forced => {
            let mut numbers = [0.0; N_COURSE];
            numbers.copy_from_slice(&own[..N_COURSE]);
            imposed::readings(&run.at, &state.base, terms, &Course { numbers }, times, moments)
        }
    };
    let offset = own[own.len() - 1];
    roll.iter_mut().for_each(|r| *r += offset);
    roll.extend(moment);
    roll
}

/// What the channels read less what they should, one channel after the other.
pub(super) fn residual(run: &Observation, predicted: &[f64]) -> Vec<f64> {
    run.roll_rad.iter().chain(&run.moment_n_m).zip(predicted).map(|(m, p)| m - p).collect()
}

/// Divides by the noise and takes out its memory, channel by channel.
pub(super) fn whiten(run: &Observation, noise: &ChannelNoise, values: &[f64]) -> Vec<f64> {
    let n_roll = run.roll_rad.len();
    let mut white = Vec::with_capacity(values.len());
    for (channel, part) in [&values[..n_roll], &values[n_roll..]].into_iter().enumerate() {
        let (sd, rho) = (noise.sd[channel], noise.correlation[channel]);
        let innovation = sd * (1.0 - rho * rho).sqrt();
        for i in 0..part.len() {
            let value =
                if i == 0 { part[0] / sd } else { (part[i] - rho * part[i - 1]) / innovation };
            white.push(value);
        }
    }
    white
}

/// Inner products of what the numbers do, the run's own ones eliminated.
#[derive(Debug, Clone)]
pub(super) struct Summary {
    /// Own numbers eliminated: base, parameters of the terms, candidates, record.
    pub(super) eliminated: Eliminated,
    /// Number of candidate columns.
    pub(super) n_candidates: usize,
    /// What the run's own numbers would gain in misfit alone.
    pub(super) own_gain: f64,
}

impl Summary {
    /// The same run with readings that count nothing.
    pub(super) fn emptied(&self) -> Self {
        let mut empty = self.clone();
        empty.eliminated.rest = Products::zero(self.eliminated.rest.n());
        empty.own_gain = 0.0;
        empty
    }
}

/// Largest share of the typical size by which a strength is moved to see what it does.
const SMALL: f64 = 1e-3;

/// Linearises a run about its state.
pub(super) fn summarise(
    run: &Observation,
    state: &RunState,
    terms: &[Term],
    candidates: &[Term],
    noise: &ChannelNoise,
) -> Summary {
    let here = predict(run, state, terms);
    let difference = |moved: &[f64], step: f64| -> Vec<f64> {
        let slope: Vec<f64> = moved.iter().zip(&here).map(|(m, h)| (m - h) / step).collect();
        whiten(run, noise, &slope)
    };
    let mut columns = Vec::new();
    let n_own = state.own.len();
    for k in 0..n_own {
        let step = 1e-6 * if k == 0 { 1.0 } else { state.own[k].abs().max(0.1) };
        let mut moved = state.clone();
        moved.own[k] += step;
        columns.push(difference(&predict(run, &moved, terms), step));
    }
    for k in 0..N_BASE {
        let mut moved = state.clone();
        let step = 1e-6 * [state.base.natural_rad_s, 1.0, 1.0, 1.0][k];
        let base = &mut moved.base;
        *[&mut base.natural_rad_s, &mut base.b1_per_s, &mut base.b3_s, &mut base.log_scale][k] +=
            step;
        columns.push(difference(&predict(run, &moved, terms), step));
    }
    for (t, term) in terms.iter().enumerate() {
        for k in 0..term.values.len() {
            let parameter = term.effect.parameter(k);
            if parameter.typical == 0.0 || matches!(term.effect.acts, Acts::Record(_)) {
                columns.push(vec![0.0; here.len()]);
                continue;
            }
            let step = SMALL * parameter.typical;
            let mut moved = terms.to_vec();
            moved[t].values[k] += step;
            columns.push(difference(&predict(run, state, &moved), step));
        }
    }
    let mut n_candidates = 0;
    let mut extended = terms.to_vec();
    for candidate in candidates {
        extended.push(candidate.clone());
        for k in 0..candidate.effect.strengths.len() {
            n_candidates += 1;
            if !(candidate.effect.shows)(&run.at) {
                columns.push(vec![0.0; here.len()]);
                continue;
            }
            let step = SMALL * candidate.effect.strengths[k].typical;
            let last = extended.len() - 1;
            extended[last].values[k] = step;
            columns.push(difference(&predict(run, state, &extended), step));
            extended[last].values[k] = 0.0;
        }
        extended.pop();
    }
    columns.push(whiten(run, noise, &residual(run, &here)));
    let mut products = Products::of(&columns);
    // The offset's prior is one more reading of it.
    let (last, offset) = (products.n() - 1, state.own[n_own - 1]);
    let precision = OFFSET_SD_RAD.powi(-2);
    products.add(n_own - 1, n_own - 1, precision);
    products.add(n_own - 1, last, -precision * offset);
    products.add(last, last, precision * offset * offset);
    let before = products.at(last, last);
    let eliminated = products.eliminate(n_own);
    let own_gain = before - eliminated.rest.at(last - n_own, last - n_own);
    Summary { eliminated, n_candidates, own_gain }
}

/// Twice the negative logarithm of the likelihood, noise given, up to a constant.
pub(super) fn misfit(
    run: &Observation,
    state: &RunState,
    terms: &[Term],
    noise: &ChannelNoise,
) -> f64 {
    let left = residual(run, &predict(run, state, terms));
    let offset = state.own[state.own.len() - 1] / OFFSET_SD_RAD;
    let white: f64 = whiten(run, noise, &left).iter().map(|r| r * r).sum();
    white + offset * offset
}
