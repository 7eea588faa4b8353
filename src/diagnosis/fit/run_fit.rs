//! One run under a model: what its channels should read, and what each number does to them.

use super::elimination::{Eliminated, Products, Side, product};
use crate::diagnosis::record::observation::Observation;
use crate::model::course::{Course, N_COURSE};
use crate::model::free::{Decay, n_stirred};
use crate::model::imposed::Imposed;
use crate::model::{Base, Columns, N_BASE, Term};
use crate::run::RunKind;

/// Standard deviation of the zero offset that a run may have beside the campaign's [rad]: what
/// taking a zero leaves.
const OFFSET_SD_RAD: f64 = 1e-4;

/// The noise of the channels of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::diagnosis) struct ChannelNoise {
    /// Standard deviation of a value of roll [rad] and moment [N m].
    pub(in crate::diagnosis) sd: [f64; 2],
    /// Correlation of neighbouring values [-].
    pub(in crate::diagnosis) correlation: [f64; 2],
}

/// The numbers of one run.
#[derive(Debug, Clone)]
pub(in crate::diagnosis) struct RunState {
    /// Initial state or course, the run's own offset, then what heeling the model stirred, as far
    /// as it is known.
    pub(in crate::diagnosis) own: Vec<f64>,
    /// Base equation.
    pub(in crate::diagnosis) base: Base,
}

/// A run of either kind under a model.
enum Simulated<'a> {
    Decay(Decay<'a>),
    Forced(Imposed<'a>),
}

/// Gives `then` the run as its kind is simulated.
fn simulated<T>(
    observation: &Observation,
    state: &RunState,
    terms: &[Term],
    then: impl Fn(&Simulated<'_>) -> T,
) -> T {
    let (own, base, run) = (&state.own, &state.base, &observation.at);
    let time_s = [&observation.roll_time_s[..], &observation.moment_time_s[..]];
    match run.kind {
        RunKind::Decay => {
            let start = [own[0], own[1]];
            let (lead, stirred) = (&observation.lead, &own[OFFSET_OF_DECAY + 1..]);
            then(&Simulated::Decay(Decay { run, base, terms, start, lead, stirred, time_s }))
        }
        RunKind::Forced => {
            let mut numbers = [0.0; N_COURSE];
            numbers.copy_from_slice(&own[..N_COURSE]);
            let course = &Course { numbers };
            let lead = &observation.lead;
            then(&Simulated::Forced(Imposed { run, base, terms, course, lead, time_s }))
        }
    }
}

/// What both channels should read, one after the other.
pub(in crate::diagnosis) fn predict(
    run: &Observation,
    state: &RunState,
    terms: &[Term],
) -> Vec<f64> {
    let mut readings = simulated(run, state, terms, |simulated| match simulated {
        Simulated::Decay(decay) => decay.readings(),
        Simulated::Forced(imposed) => imposed.readings(),
    });
    let offset = state.own[offset_place(run)];
    for reading in &mut readings[..run.roll_time_s.len()] {
        *reading += offset;
    }
    readings
}

/// What the channels read less what they should, one channel after the other.
pub(in crate::diagnosis) fn residual(run: &Observation, predicted: &[f64]) -> Vec<f64> {
    run.roll_rad.iter().chain(&run.moment_n_m).zip(predicted).map(|(m, p)| m - p).collect()
}

/// Divides by the noise and takes out its memory, channel by channel.
fn whiten(run: &Observation, noise: &ChannelNoise, values: &mut [f64]) {
    let (roll, moment) = values.split_at_mut(run.roll_rad.len());
    for (channel, part) in [roll, moment].into_iter().enumerate() {
        let (sd, rho) = (noise.sd[channel], noise.correlation[channel]);
        let innovation = (sd * (1.0 - rho * rho).sqrt()).recip();
        let remembered = rho * innovation;
        for i in (1..part.len()).rev() {
            part[i] = innovation * part[i] - remembered * part[i - 1];
        }
        if let Some(first) = part.first_mut() {
            *first /= sd;
        }
    }
}

/// Inner products of what the numbers do, the run's own ones eliminated.
#[derive(Debug, Clone)]
pub(in crate::diagnosis) struct Summary {
    /// Own numbers eliminated: base, parameters of the terms, record.
    pub(in crate::diagnosis) eliminated: Eliminated,
    /// The strengths of each candidate beside these.
    pub(in crate::diagnosis) candidates: Vec<Side>,
    /// Twice the negative logarithm of the likelihood where the run stands, up to a constant.
    pub(super) misfit: f64,
    /// What the run's own numbers would gain in misfit alone.
    pub(super) own_gain: f64,
    /// What the stirred states cost in evidence.
    pub(in crate::diagnosis) log_occam: f64,
}

impl Summary {
    /// The same run with readings that count nothing.
    pub(in crate::diagnosis) fn emptied(&self) -> Self {
        let mut empty = self.clone();
        empty.eliminated.rest = Products::zero(self.eliminated.rest.n());
        (empty.misfit, empty.own_gain) = (0.0, 0.0);
        empty
    }

    /// Lets the steps of the scale and of the terms' parameters count from where they were
    /// `moved_by` ago, the scale first.
    pub(in crate::diagnosis) fn refer_back(&mut self, moved_by: &[f64]) {
        self.eliminated.refer_back(N_BASE - 1, moved_by);
    }
}

/// Linearises a run about its state, a share of something taken off what was read.
pub(in crate::diagnosis) fn summarise(
    run: &Observation,
    state: &RunState,
    terms: &[Term],
    candidates: &[Term],
    noise: &ChannelNoise,
    less: Option<(&[f64], f64)>,
) -> Summary {
    let Columns { here, columns: mut changes } =
        simulated(run, state, terms, |simulated| match simulated {
            Simulated::Decay(decay) => decay.columns(candidates),
            Simulated::Forced(imposed) => imposed.columns(candidates),
        });
    let (place, n_roll) = (offset_place(run), run.roll_time_s.len());
    let (n_start, n_own) = (place + 1, n_own(run, terms));
    let offset = state.own[place];
    let mut of_offset = vec![0.0; here.len()];
    of_offset[..n_roll].fill(1.0);
    let mut left = residual(run, &here);
    left[..n_roll].iter_mut().for_each(|left| *left -= offset);
    if let Some((less, share)) = less {
        left.iter_mut().zip(less).for_each(|(left, less)| *left -= share * less);
    }
    changes.insert(place, of_offset);
    let n_candidates: usize = candidates.iter().map(|c| c.effect.strengths.len()).sum();
    let n_known = changes.len() - n_candidates;
    changes.insert(n_known, left);
    for column in &mut changes {
        whiten(run, noise, column);
    }
    let (known, tried) = changes.split_at(n_known + 1);
    let mut products = Products::of(known);
    // The offset's prior is one more reading of it.
    let last = products.n() - 1;
    let precision = OFFSET_SD_RAD.powi(-2);
    products.add(place, place, precision);
    products.add(place, last, -precision * offset);
    products.add(last, last, precision * offset * offset);
    let mut log_occam = 0.0;
    for (stirred, sd) in (n_start..n_own).zip(stirred_sds(run).cycle()) {
        let (now, precision) = (state.own.get(stirred).unwrap_or(&0.0), sd.powi(-2));
        products.add(stirred, stirred, precision);
        products.add(stirred, last, -precision * now);
        products.add(last, last, precision * now * now);
        log_occam -= sd.ln();
    }
    let misfit = products.at(last, last);
    if n_own > n_start {
        log_occam += 0.5 * products.clone().eliminate(n_start).log_determinant;
    }
    let eliminated = products.eliminate(n_own);
    if n_own > n_start {
        log_occam -= 0.5 * eliminated.log_determinant;
    }
    let own_gain = misfit - eliminated.rest.at(last - n_own, last - n_own);
    let mut next = 0;
    let candidates = candidates.iter().map(|candidate| {
        let first = next;
        next += candidate.effect.strengths.len();
        eliminated.beside(&Side::of(&tried[first..next], known))
    });
    let candidates = candidates.collect();
    Summary { eliminated, candidates, misfit, own_gain, log_occam }
}

/// Place of the offset of a decay among its own numbers, behind roll and rate.
const OFFSET_OF_DECAY: usize = 2;
/// What heeling the model may leave of states that it stirs, as a share of its amplitude, where
/// nobody knows how it was heeled, and beyond what is known of it; by judgement.
const STIRRED: [f64; 2] = [0.3, 0.01];

/// Place of a run's offset among its own numbers.
fn offset_place(run: &Observation) -> usize {
    match run.at.kind {
        RunKind::Decay => OFFSET_OF_DECAY,
        RunKind::Forced => N_COURSE,
    }
}

/// How many numbers of its own a run has under some terms.
fn n_own(run: &Observation, terms: &[Term]) -> usize {
    let n_stirred = if run.at.kind == RunKind::Decay { n_stirred(terms) } else { 0 };
    offset_place(run) + 1 + n_stirred
}

/// Prior standard deviations of a stirred state [rad] and of its rate [rad/s].
fn stirred_sds(run: &Observation) -> impl Iterator<Item = f64> + Clone {
    let sd = STIRRED[usize::from(run.lead.is_known())] * run.at.amplitude_rad;
    [sd, sd * run.at.natural_rad_s].into_iter()
}

/// Twice the negative logarithm of the likelihood, noise given, up to a constant.
pub(in crate::diagnosis) fn misfit(
    run: &Observation,
    state: &RunState,
    terms: &[Term],
    noise: &ChannelNoise,
) -> f64 {
    let mut left = residual(run, &predict(run, state, terms));
    let place = offset_place(run);
    let offset = state.own[place] / OFFSET_SD_RAD;
    whiten(run, noise, &mut left);
    let stirred = state.own[place + 1..n_own(run, terms).min(state.own.len())].iter();
    let stirred = stirred.zip(stirred_sds(run).cycle()).map(|(now, sd)| (now / sd).powi(2));
    product(&left, &left) + offset * offset + stirred.sum::<f64>()
}
