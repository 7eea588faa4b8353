//! A decay simulated: the model rolls freely from its initial state.

use super::channel::{self, Tangent};
use super::echo::{Echo, StepEcho};
use super::effect::{Acts, Circumstances, Instant, Lag, MOST_LAGS};
use super::free_changes::Changes;
use super::history::History;
use super::lead::Lead;
use super::term::{Base, Columns, Term};

/// Runge-Kutta steps a half period: with the fifth-degree course between, the phase of a roll errs
/// by less than 1e-5 a period, which the natural frequency absorbs. It is even, for two of them are
/// one step of a change.
pub(super) const STEPS_PER_HALF_PERIOD: usize = 24;

/// Most states: roll, rate, and those of up to six effects that remember.
const MOST_STATES: usize = 2 + 6 * MOST_LAGS;

/// One decay: its equation, its start, and when its channels are read.
#[derive(Debug, Clone, Copy)]
pub struct Decay<'a> {
    /// The run.
    pub run: &'a Circumstances,
    /// Base equation.
    pub base: &'a Base,
    /// Effects that extend it.
    pub terms: &'a [Term],
    /// Roll [rad] and rate [rad/s] at the start.
    pub start: [f64; 2],
    /// The roll before it, which what heeling stirs has followed.
    pub lead: &'a Lead,
    /// What stirred states hold beyond that, as [`n_stirred`] counts them; nil where they lack.
    pub stirred: &'a [f64],
    /// Times of the roll and of the moment [s].
    pub time_s: [&'a [f64]; 2],
}

/// The motion from step to step.
pub(super) struct Path<const N: usize> {
    pub(super) step_s: f64,
    pub(super) history: History,
    /// Roll, rate and what the effects remember, at every step; their number is even.
    pub(super) points: Vec<[f64; N]>,
}

impl Decay<'_> {
    /// What both channels read: roll [rad], then moment [N m].
    pub fn readings(&self) -> Vec<f64> {
        match self.n_lags() {
            0 => self.read(&self.path::<2>(false)),
            1..=2 => self.read(&self.path::<4>(false)),
            3..=4 => self.read(&self.path::<6>(false)),
            _ => self.read(&self.path::<MOST_STATES>(false)),
        }
    }

    /// The same with what each number does to them: initial roll and rate, stirred states, base
    /// equation, parameters of the terms, strengths of the candidates.
    pub fn columns(&self, candidates: &[Term]) -> Columns {
        match self.n_lags() {
            0 => self.changed::<2>(candidates),
            1..=2 => self.changed::<4>(candidates),
            3..=4 => self.changed::<6>(candidates),
            _ => self.changed::<MOST_STATES>(candidates),
        }
    }

    fn n_lags(&self) -> usize {
        self.terms.iter().map(|term| states(term).0).sum()
    }

    /// Lets the stirred states begin where they are at the release.
    fn begin(&self, state: &mut [f64]) {
        let mut next = N_START;
        for term in self.terms {
            let Acts::Lagging(lag) = term.effect.acts else { continue };
            let own = next..next + lag.n_states;
            next = own.end;
            state[own].copy_from_slice(&self.begun(&lag, &term.values)[..lag.n_states]);
        }
        self.stirred_places().zip(self.stirred).for_each(|(place, value)| state[place] += value);
    }

    /// Where the states of an effect are at the release.
    pub(super) fn begun(&self, lag: &Lag, values: &[f64]) -> [f64; MOST_LAGS] {
        if lag.is_stirred {
            self.lead.states(lag, values, self.run, self.base)
        } else {
            [0.0; MOST_LAGS]
        }
    }

    /// Places of the stirred states among all.
    pub(super) fn stirred_places(&self) -> impl Iterator<Item = usize> {
        let mut next = N_START;
        self.terms.iter().flat_map(move |term| {
            let (n_states, n_stirred) = states(term);
            next += n_states;
            next - n_states..next - n_states + n_stirred
        })
    }

    /// The motion at one instant; the acceleration is that of the base equation.
    pub(super) fn instant(&self, time_s: f64, [roll, rate]: [f64; 2]) -> Instant<'_> {
        let Base { natural_rad_s: w, b1_per_s, b3_s, .. } = *self.base;
        Instant {
            time_s,
            roll_rad: roll,
            rate_rad_per_s: rate,
            acceleration_rad_per_s2: -b1_per_s * rate - b3_s * rate.powi(3) - w * w * roll,
            moment_n_m: 0.0,
            natural_rad_s: w,
            b1_per_s,
            run: self.run,
        }
    }

    /// The echoes of its terms on so many steps of a motion each half period.
    pub(super) fn echoes(&self, steps_per_half_period: usize) -> Vec<StepEcho> {
        let echo = |term: &Term| match term.effect.acts {
            Acts::Echo(taps) => {
                Some(Echo::new(&taps, self.run, &term.values).of_steps(steps_per_half_period))
            }
            _ => None,
        };
        self.terms.iter().filter_map(echo).collect()
    }

    /// Slopes of a state under what the echoes bring.
    fn slope<const N: usize>(&self, time_s: f64, state: &[f64; N], echo: f64) -> [f64; N] {
        let instant = self.instant(time_s, [state[0], state[1]]);
        let mut moment = instant.acceleration_rad_per_s2 + echo;
        let mut inertia = 1.0;
        let mut slope = [0.0; N];
        let mut next = 2;
        for Term { effect, values } in self.terms {
            match effect.acts {
                Acts::Moment(law) => moment += (law.plain)(&instant, values),
                Acts::Inertia(law) => inertia += (law.plain)(&instant, values),
                Acts::Lagging(lag) if next + lag.n_states <= N => {
                    let own = &state[next..next + lag.n_states];
                    moment += (lag.moment.plain)(&instant, values, own);
                    let slopes = (lag.slope.plain)(&instant, values, own);
                    slope[next..next + lag.n_states].copy_from_slice(&slopes[..lag.n_states]);
                    next += lag.n_states;
                }
                _ => {}
            }
        }
        slope[0] = state[1];
        slope[1] = moment / inertia.max(LEAST_INERTIA);
        slope
    }

    /// Runge-Kutta of the fourth order with `N` states, to the last reading.
    fn path<const N: usize>(&self, with_points: bool) -> Path<N> {
        let half_period_s = std::f64::consts::PI / self.run.natural_rad_s;
        let step_s = half_period_s / STEPS_PER_HALF_PERIOD as f64;
        let last_s = self.time_s.iter().filter_map(|t| t.last()).fold(0.0_f64, |a, b| a.max(*b));
        let n_steps = 2 * (0.5 * last_s / step_s).ceil().max(1.0) as usize;
        let mut history = History::new(step_s, n_steps);
        let mut points: Vec<[f64; N]> = Vec::new();
        let mut state = [0.0; N];
        state[..N_START].copy_from_slice(&self.start);
        self.begin(&mut state);
        let mut echoes = self.echoes(STEPS_PER_HALF_PERIOD);
        for echo in &mut echoes {
            echo.begin(state[0]);
        }
        for step in 0..=n_steps {
            let time_s = step as f64 * step_s;
            let heard: f64 = echoes.iter_mut().map(|echo| echo.at(&history, step)).sum();
            let first = self.slope(time_s, &state, heard);
            history.push([state[0], state[1], first[1]]);
            if with_points {
                points.push(state);
            }
            if step == n_steps {
                break;
            }
            let along = |slope: &[f64; N], share: f64| -> [f64; N] {
                std::array::from_fn(|i| state[i] + share * step_s * slope[i])
            };
            let middle_s = time_s + 0.5 * step_s;
            let midway: f64 = echoes.iter_mut().map(|echo| echo.midway(&history, step)).sum();
            let next: f64 = echoes.iter_mut().map(|echo| echo.at(&history, step + 1)).sum();
            let second = self.slope(middle_s, &along(&first, 0.5), midway);
            let third = self.slope(middle_s, &along(&second, 0.5), midway);
            let fourth = self.slope(time_s + step_s, &along(&third, 1.0), next);
            let mean: [f64; N] = std::array::from_fn(|i| {
                (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0
            });
            state = along(&mean, 1.0);
            if !state[0].is_finite() || state[0].abs() > 3.0 {
                // A model that capsizes reads what nobody measures; the fit turns away from it.
                state = [3.0; N];
            }
        }
        Path { step_s, history, points }
    }

    /// The motion at the times of a channel.
    fn instants<'b>(&'b self, channel: usize, history: &'b History) -> Vec<Instant<'b>> {
        let at = |t: &f64| {
            let [roll, rate, acceleration] = history.motion(*t);
            let instant = self.instant(*t, [roll, rate]);
            Instant { acceleration_rad_per_s2: acceleration, ..instant }
        };
        self.time_s[channel].iter().map(at).collect()
    }

    fn read<const N: usize>(&self, path: &Path<N>) -> Vec<f64> {
        let mut readings: Vec<f64> =
            path.history.rolls(&path.history.sampling(self.time_s[0])).collect();
        if channel::is_read_through(self.terms, 0) {
            channel::add(self.terms, 0, &self.instants(0, &path.history), &mut readings);
        }
        let mut moment = vec![0.0; self.time_s[1].len()];
        if channel::is_read_through(self.terms, 1) {
            channel::add(self.terms, 1, &self.instants(1, &path.history), &mut moment);
        }
        readings.extend(moment);
        readings
    }

    fn changed<const N: usize>(&self, candidates: &[Term]) -> Columns {
        let path = self.path::<N>(true);
        let here = self.read(&path);
        let changes = Changes::new(self, &path, candidates);
        let n_roll = self.time_s[0].len();
        let is_through = [0, 1].map(|channel| channel::is_read_through(self.terms, channel));
        let mut tangents: [Vec<Option<Vec<Tangent>>>; 2] = [Vec::new(), Vec::new()];
        let mut columns = Vec::with_capacity(changes.n_columns() + 2);
        let mut change = changes.nothing_yet();
        let sampling = change.sampling(self.time_s[0]);
        for number in 0..changes.n_columns() {
            let moves = changes.fill(number, &mut change);
            let mut column = Vec::with_capacity(here.len());
            if moves {
                column.extend(change.rolls(&sampling));
            }
            column.resize(here.len(), 0.0);
            columns.push(column);
            for channel in (0..2).filter(|channel| is_through[*channel]) {
                let motion = |t: &f64| -> Tangent {
                    let [roll, rate, acceleration] = change.motion(*t);
                    [roll, rate, acceleration, 0.0]
                };
                let all = self.time_s[channel].iter().map(motion);
                tangents[channel].push(moves.then(|| all.collect()));
            }
        }
        for channel in 0..2 {
            if !is_through[channel] && !channel::is_read_through(candidates, channel) {
                continue;
            }
            let instants = self.instants(channel, &path.history);
            let first = if channel == 0 { 0 } else { n_roll };
            channel::add_candidates(candidates, channel, &instants, &mut columns, first);
            if is_through[channel] {
                let (terms, tangents) = (self.terms, &tangents[channel]);
                let columns = &mut columns;
                let n_start = N_START + n_stirred(terms);
                channel::add_tangents(terms, n_start, channel, &instants, tangents, columns, first);
            }
        }
        Columns { here, columns }
    }
}

/// Number of states of the terms of a decay that heeling the model stirs.
pub fn n_stirred(terms: &[Term]) -> usize {
    terms.iter().map(|term| states(term).1).sum()
}

/// Number of states of a term, and of those among them that are stirred.
fn states(term: &Term) -> (usize, usize) {
    match term.effect.acts {
        Acts::Lagging(lag) => (lag.n_states, if lag.is_stirred { lag.n_states } else { 0 }),
        _ => (0, 0),
    }
}

/// Initial roll and rate.
pub(super) const N_START: usize = 2;
/// Share of the inertia below which no effect can bring it.
pub(super) const LEAST_INERTIA: f64 = 0.1;
