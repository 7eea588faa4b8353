//! What each number does to a decay: the variational equations of its motion.

use std::ops::Range;

use super::echo::{Echo, StepEcho};
use super::effect::{Acts, Instant, MOST_LAGS};
use super::free::{Decay, LEAST_INERTIA, N_START, Path, STEPS_PER_HALF_PERIOD};
use super::history::History;
use super::lagging::follow;
use super::linear::{Matrix, Transition, times};
use super::number::{Sloped, slope};
use super::slopes;
use super::term::Term;

/// Frequency, linear and cubic damping: the numbers of the base equation that move a decay.
const N_MOVING: usize = 3;
/// The first of them, which effects' equations name.
const N_NAMED: usize = slope::PARAMETER - slope::BASE;

/// The equation about a motion at every step; two steps of the motion are one of its changes.
pub(super) struct Changes<const N: usize> {
    step_s: f64,
    jacobians: Vec<Matrix<N>>,
    transitions: Vec<Transition<N>>,
    /// Which states the first columns start.
    started: Vec<usize>,
    /// Number of columns that the equation's own numbers have.
    n_forced: usize,
    /// What these did to the stirred states before the release.
    begun: Vec<[f64; N]>,
    /// What these do to the slopes, point by point.
    forcing: Vec<[f64; N]>,
    /// What the motion some time ago does to the acceleration now.
    echoes: Vec<StepEcho>,
    /// What each candidate strength does to the acceleration; nothing where it does not move it.
    candidates: Vec<Option<Vec<f64>>>,
}

/// The acceleration at one point, and the inertia that it is a quotient of.
struct Quotient {
    acceleration: f64,
    inertia: f64,
}

impl<const N: usize> Changes<N> {
    /// About a path.
    pub(super) fn new(decay: &Decay<'_>, path: &Path<N>, candidates: &[Term]) -> Self {
        let (step_s, n_points) = (path.step_s, path.points.len());
        let n_forced = N_MOVING + decay.terms.iter().map(|term| term.values.len()).sum::<usize>();
        let heard = Heard::of(decay, &path.history);
        let mut jacobians = Vec::with_capacity(n_points);
        let mut forcing = vec![[0.0; N]; n_points * n_forced];
        let mut quotients = Vec::with_capacity(n_points);
        let at = |k: usize| {
            let state = &path.points[k];
            decay.instant(step_s * k as f64, [state[0], state[1]])
        };
        for (k, state) in path.points.iter().enumerate() {
            let mut about = About {
                jacobian: [[0.0; N]; N],
                forcing: &mut forcing[k * n_forced..(k + 1) * n_forced],
            };
            quotients.push(about.fill(decay, &at(k), state, &heard.at(k)));
            jacobians.push(about.jacobian);
        }
        let transitions = (0..n_points - 2)
            .step_by(2)
            .map(|k| {
                Transition::new(&jacobians[k], &jacobians[k + 1], &jacobians[k + 2], 2.0 * step_s)
            })
            .collect();
        let instants: Vec<Instant<'_>> =
            if candidates.is_empty() { Vec::new() } else { (0..n_points).map(at).collect() };
        let candidates = candidates
            .iter()
            .flat_map(|term| pushes(decay, term, (&instants, &path.history), &quotients, step_s))
            .collect();
        let echoes = decay.echoes(STEPS_PER_HALF_PERIOD / 2);
        let begun = begun(decay, n_forced);
        let started = (0..N_START).chain(decay.stirred_places()).collect();
        Self {
            step_s,
            jacobians,
            transitions,
            started,
            n_forced,
            begun,
            forcing,
            echoes,
            candidates,
        }
    }

    /// Number of columns: start and stirred states, base, parameters of the terms, candidates.
    pub(super) fn n_columns(&self) -> usize {
        self.started.len() + self.n_forced + 1 + self.candidates.len()
    }

    /// Room for the change of the motion with a number.
    pub(super) fn nothing_yet(&self) -> History {
        History::still(2.0 * self.step_s, self.transitions.len())
    }

    /// Change of the motion with the number of a column; false where it does not move.
    pub(super) fn fill(&self, column: usize, change: &mut History) -> bool {
        let still = [0.0; N];
        if let Some(place) = self.started.get(column) {
            let mut start = still;
            start[*place] = 1.0;
            self.respond(start, |_| still, change);
            return true;
        }
        // The moment's scale does not move a decay.
        let own = match column - self.started.len() {
            N_MOVING => return false,
            scaled if scaled > N_MOVING => scaled - 1,
            moving => moving,
        };
        if own < self.n_forced {
            let at = |k: usize| self.forcing[k * self.n_forced + own];
            let begun = self.begun[own];
            let is_moved = |of: &[f64; N]| of.iter().any(|f| *f != 0.0);
            let moves = is_moved(&begun) || (0..self.jacobians.len()).any(|k| is_moved(&at(k)));
            if moves {
                self.respond(begun, at, change);
            }
            return moves;
        }
        let Some(push) = self.candidates[own - self.n_forced].as_ref() else { return false };
        let at = |k: usize| {
            let mut forcing = still;
            forcing[1] = push[k];
            forcing
        };
        self.respond(still, at, change);
        true
    }

    fn respond(&self, start: [f64; N], forcing: impl Fn(usize) -> [f64; N], change: &mut History) {
        change.clear();
        let mut echoes = self.echoes.clone();
        for echo in &mut echoes {
            echo.begin(start[0]);
        }
        let mut at = |point: usize, change: &History| {
            let mut forcing = forcing(point);
            // Two points of the motion are one step of its change.
            let step = point / 2;
            for echo in &mut echoes {
                let is_midway = point % 2 == 1;
                forcing[1] +=
                    if is_midway { echo.midway(change, step) } else { echo.at(change, step) };
            }
            forcing
        };
        let mut state = start;
        let mut first = at(0, change);
        for step in 0..=self.transitions.len() {
            let slope = times(&self.jacobians[2 * step], &state)[1] + first[1];
            change.push([state[0], state[1], slope]);
            if let Some(transition) = self.transitions.get(step) {
                let (middle, last) = (at(2 * step + 1, change), at(2 * step + 2, change));
                state = transition.step(&state, [&first, &middle, &last]);
                first = last;
            }
        }
    }
}

/// What the numbers of the equation did to the states that were stirred before a decay.
fn begun<const N: usize>(decay: &Decay<'_>, n_forced: usize) -> Vec<[f64; N]> {
    let mut begun = vec![[0.0; N]; n_forced];
    let (mut first, mut state) = (N_MOVING, N_START);
    for Term { effect, values } in decay.terms {
        let columns = first..first + values.len();
        first = columns.end;
        let Acts::Lagging(lag) = effect.acts else { continue };
        let states = state..state + lag.n_states;
        state = states.end;
        if lag.is_stirred && states.end <= N {
            let changes = decay.lead.changes(&lag, values, decay.run, decay.base);
            for (column, change) in (0..N_NAMED).chain(columns).zip(changes) {
                let own = &mut begun[column][states.clone()];
                own.iter_mut().zip(change).for_each(|(own, change)| *own += change);
            }
        }
    }
    begun
}

/// The echoes of a decay's terms at every step, and what each of their parameters does to them.
struct Heard(Vec<(Vec<f64>, Vec<Vec<f64>>)>);

impl Heard {
    fn of(decay: &Decay<'_>, history: &History) -> Self {
        let whole = |echo: &Echo| echo.of_steps(STEPS_PER_HALF_PERIOD).whole(history);
        let heard = decay.terms.iter().filter_map(|Term { effect, values }| match effect.acts {
            Acts::Echo(taps) => {
                let slopes = Echo::slopes(&taps, decay.run, values);
                let echo = whole(&Echo::new(&taps, decay.run, values));
                Some((echo, slopes.iter().map(whole).collect()))
            }
            _ => None,
        });
        Self(heard.collect())
    }

    /// Each echo at one step with its slopes.
    fn at(&self, step: usize) -> Vec<Sloped> {
        let at = |(echo, slopes): &(Vec<f64>, Vec<Vec<f64>>)| {
            let mut sloped = Sloped::from(echo[step]);
            let places = sloped.slopes[slope::PARAMETER..].iter_mut();
            places.zip(slopes).for_each(|(place, slope)| *place = slope[step]);
            sloped
        };
        self.0.iter().map(at).collect()
    }
}

/// The equation about one point.
struct About<'p, const N: usize> {
    jacobian: Matrix<N>,
    forcing: &'p mut [[f64; N]],
}

/// What roll, rate and the numbers of the base equation do to its acceleration.
struct OfBase {
    motion: [f64; 2],
    numbers: [f64; N_MOVING],
}

impl<const N: usize> About<'_, N> {
    fn fill(
        &mut self,
        decay: &Decay<'_>,
        instant: &Instant<'_>,
        state: &[f64; N],
        heard: &[Sloped],
    ) -> Quotient {
        let (roll, rate) = (instant.roll_rad, instant.rate_rad_per_s);
        let (w, b1, b3) = (decay.base.natural_rad_s, decay.base.b1_per_s, decay.base.b3_s);
        let of_base = OfBase {
            motion: [-w * w, -b1 - 3.0 * b3 * rate * rate],
            numbers: [-2.0 * w * roll, -rate, -rate.powi(3)],
        };
        self.jacobian[0][1] = 1.0;
        self.jacobian[1][..2].copy_from_slice(&of_base.motion);
        (0..N_MOVING).for_each(|k| self.forcing[k][1] = of_base.numbers[k]);
        let sloped = slopes::inputs(instant);
        let (mut moment, mut inertia) = (instant.acceleration_rad_per_s2, 1.0);
        let (mut first, mut lag_state, mut heard) = (N_MOVING, N_START, heard.iter());
        for Term { effect, values } in decay.terms {
            let columns = first..first + values.len();
            first = columns.end;
            match effect.acts {
                Acts::Moment(law) => {
                    let of = slopes::of_law(&law, &sloped, values);
                    moment += of.value;
                    self.enter(1, &of, 1.0, &of_base, columns);
                }
                Acts::Echo(_) => {
                    if let Some(of) = heard.next() {
                        moment += of.value;
                        self.enter(1, of, 1.0, &of_base, columns.clone());
                    }
                }
                Acts::Inertia(law) => inertia += (law.plain)(instant, values),
                Acts::Lagging(lag) if lag_state + lag.n_states <= N => {
                    let states = lag_state..lag_state + lag.n_states;
                    let (rows, of) = slopes::of_lag(&lag, &sloped, values, &state[states.clone()]);
                    moment += of.value;
                    for (row, of) in states.clone().zip(&rows).chain([(1, &of)]) {
                        self.enter(row, of, 1.0, &of_base, columns.clone());
                        for (k, state) in states.clone().enumerate() {
                            self.jacobian[row][state] += of.slopes[slope::REMEMBERED + k];
                        }
                    }
                    lag_state = states.end;
                }
                _ => {}
            }
        }
        let is_held = inertia < LEAST_INERTIA;
        let inertia = inertia.max(LEAST_INERTIA);
        let acceleration = moment / inertia;
        if !is_held {
            self.weigh(decay, &sloped, acceleration, &of_base);
        }
        self.jacobian[1].iter_mut().for_each(|v| *v /= inertia);
        self.forcing.iter_mut().for_each(|column| column[1] /= inertia);
        Quotient { acceleration, inertia }
    }

    /// A change of the inertia acts with the acceleration.
    fn weigh(
        &mut self,
        decay: &Decay<'_>,
        sloped: &Instant<'_, Sloped>,
        acceleration: f64,
        of_base: &OfBase,
    ) {
        let mut first = N_MOVING;
        for Term { effect, values } in decay.terms {
            let columns = first..first + values.len();
            first = columns.end;
            if let Acts::Inertia(law) = effect.acts {
                let of = slopes::of_law(&law, sloped, values);
                self.enter(1, &of, -acceleration, of_base, columns);
            }
        }
    }

    /// Enters an equation's slopes in a row, weighed; the columns are those of its parameters.
    fn enter(&mut self, row: usize, of: &Sloped, by: f64, of_base: &OfBase, columns: Range<usize>) {
        let of_acceleration = by * of.slopes[slope::ACCELERATION];
        let [of_roll, of_rate] = of_base.motion;
        self.jacobian[row][0] += by * of.slopes[slope::ROLL] + of_acceleration * of_roll;
        self.jacobian[row][1] += by * of.slopes[slope::RATE] + of_acceleration * of_rate;
        for (column, of_number) in self.forcing.iter_mut().zip(of_base.numbers) {
            column[row] += of_acceleration * of_number;
        }
        for (k, column) in self.forcing[..N_NAMED].iter_mut().enumerate() {
            column[row] += by * of.slopes[slope::BASE + k];
        }
        for (k, column) in columns.enumerate() {
            self.forcing[column][row] += by * of.slopes[slope::PARAMETER + k];
        }
    }
}

/// What each strength of a candidate does to the acceleration at every point, where it moves it.
fn pushes(
    decay: &Decay<'_>,
    term: &Term,
    (instants, history): (&[Instant<'_>], &History),
    quotients: &[Quotient],
    step_s: f64,
) -> Vec<Option<Vec<f64>>> {
    let shows = (term.effect.shows)(instants[0].run);
    let remembered = match term.effect.acts {
        Acts::Lagging(lag) if shows => {
            let start = decay.begun(&lag, &term.values);
            follow(&lag, &term.values, start, instants, step_s)
        }
        _ => Vec::new(),
    };
    term.nudged_each()
        .into_iter()
        .map(|(values, by)| {
            let all = instants.iter().zip(quotients);
            match term.effect.acts {
                _ if !shows => None,
                Acts::Moment(law) => {
                    Some(all.map(|(i, p)| (law.plain)(i, &values) / (by * p.inertia)).collect())
                }
                Acts::Echo(taps) => {
                    let echo = Echo::new(&taps, instants[0].run, &values);
                    let heard = echo.of_steps(STEPS_PER_HALF_PERIOD).whole(history);
                    let points = heard.iter().zip(quotients);
                    Some(points.map(|(heard, p)| heard / (by * p.inertia)).collect())
                }
                Acts::Inertia(law) => {
                    let push = |i, p: &Quotient| -p.acceleration * (law.plain)(i, &values);
                    Some(all.map(|(i, p)| push(i, p) / (by * p.inertia)).collect())
                }
                Acts::Lagging(lag) => {
                    let moment = |i, z: &[f64; MOST_LAGS]| (lag.moment.plain)(i, &values, z);
                    Some(
                        all.zip(&remembered)
                            .map(|((i, p), z)| moment(i, z) / (by * p.inertia))
                            .collect(),
                    )
                }
                Acts::Roll(_) | Acts::Drive(_) | Acts::Chain(..) | Acts::Record(_) => None,
            }
        })
        .collect()
}
