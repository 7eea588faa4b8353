//! A decay simulated: the model rolls freely from its initial state.

use super::effect::{Acts, Circumstances, Instant, MOST_LAGS, Past};
use super::term::{Base, Term};

/// Runge-Kutta steps a period: with the fifth-degree course between, the phase of a roll errs by
/// less than 1e-5 a period, which the natural frequency absorbs.
const STEPS_PER_PERIOD: f64 = 48.0;

/// Roll, rate and acceleration at equal steps.
#[derive(Debug, Clone, Default)]
pub struct History {
    step_s: f64,
    states: Vec<[f64; 3]>,
}

impl History {
    /// Roll [rad] and rate [rad/s] at a time [s]; nil before the start.
    pub fn at(&self, time_s: f64) -> [f64; 2] {
        if time_s <= 0.0 || self.states.len() < 2 {
            return [0.0, 0.0];
        }
        let [roll, rate, _] = self.motion(time_s);
        [roll, rate]
    }

    /// Roll, rate and acceleration at a time [s] by the quintic between two steps.
    fn motion(&self, time_s: f64) -> [f64; 3] {
        let h = self.step_s;
        let place = (time_s / h).clamp(0.0, (self.states.len() - 1) as f64);
        let before = (place as usize).min(self.states.len() - 2);
        let x = place - before as f64;
        let ([p0, v0, a0], [p1, v1, a1]) = (self.states[before], self.states[before + 1]);
        let (c1, c2) = (h * v0, 0.5 * h * h * a0);
        let (d, e, f) = (p1 - p0 - c1 - c2, h * v1 - c1 - 2.0 * c2, h * h * a1 - 2.0 * c2);
        let c3 = 10.0 * d - 4.0 * e + 0.5 * f;
        let c4 = -15.0 * d + 7.0 * e - f;
        let c5 = 6.0 * d - 3.0 * e + 0.5 * f;
        let roll = p0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))));
        let rate = (c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)))) / h;
        let acceleration = (2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5))) / (h * h);
        [roll, rate, acceleration]
    }
}

/// Most states: roll, rate, and those of up to six effects that remember.
const MOST_STATES: usize = 2 + 6 * MOST_LAGS;

/// The equation of one decay.
struct Equation<'a> {
    run: &'a Circumstances,
    base: &'a Base,
    terms: &'a [Term],
}

impl Equation<'_> {
    fn instant<'b>(&'b self, time_s: f64, roll: f64, rate: f64, past: Past<'b>) -> Instant<'b> {
        let Base { natural_rad_s: w, b1_per_s, b3_s, .. } = *self.base;
        Instant {
            time_s,
            roll_rad: roll,
            rate_rad_per_s: rate,
            acceleration_rad_per_s2: -b1_per_s * rate - b3_s * rate.powi(3) - w * w * roll,
            moment_n_m: 0.0,
            past,
            run: self.run,
        }
    }

    fn slope<const N: usize>(&self, time_s: f64, state: &[f64; N], history: &History) -> [f64; N] {
        let instant = self.instant(time_s, state[0], state[1], Past::Free(history));
        let mut moment = instant.acceleration_rad_per_s2;
        let mut inertia = 1.0;
        let mut slope = [0.0; N];
        let mut next = 2;
        for Term { effect, values } in self.terms {
            match effect.acts {
                Acts::Moment(law) => moment += law(&instant, values),
                Acts::Inertia(law) => inertia += law(&instant, values),
                Acts::Lagging(lag) if next + lag.n_states <= N => {
                    let own = &state[next..next + lag.n_states];
                    moment += (lag.moment)(&instant, values, own);
                    let slopes = (lag.slope)(&instant, values, own);
                    slope[next..next + lag.n_states].copy_from_slice(&slopes[..lag.n_states]);
                    next += lag.n_states;
                }
                _ => {}
            }
        }
        slope[0] = state[1];
        slope[1] = moment / inertia.max(0.1);
        slope
    }

    /// Runge-Kutta of the fourth order with `N` states, from a start to at least `last_s` [s].
    fn history<const N: usize>(&self, start: (f64, f64), last_s: f64) -> History {
        let step_s = std::f64::consts::TAU / (STEPS_PER_PERIOD * self.run.natural_rad_s);
        let n_steps = (last_s / step_s).ceil().max(1.0) as usize;
        let mut history = History { step_s, states: Vec::with_capacity(n_steps + 1) };
        let mut state = [0.0; N];
        (state[0], state[1]) = start;
        for step in 0..=n_steps {
            let time_s = step as f64 * step_s;
            let first = self.slope(time_s, &state, &history);
            history.states.push([state[0], state[1], first[1]]);
            let along = |slope: &[f64; N], share: f64| -> [f64; N] {
                std::array::from_fn(|i| state[i] + share * step_s * slope[i])
            };
            let middle_s = time_s + 0.5 * step_s;
            let second = self.slope(middle_s, &along(&first, 0.5), &history);
            let third = self.slope(middle_s, &along(&second, 0.5), &history);
            let fourth = self.slope(time_s + step_s, &along(&third, 1.0), &history);
            let mean: [f64; N] = std::array::from_fn(|i| {
                (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0
            });
            state = along(&mean, 1.0);
            if !state[0].is_finite() || state[0].abs() > 3.0 {
                // A model that capsizes reads what nobody measures; the fit turns away from it.
                state = [3.0; N];
            }
        }
        history
    }
}

/// What both channels of a decay read: roll [rad] at `roll_time_s` and moment [N m] at
/// `moment_time_s`, from an initial roll and rate.
pub fn readings(
    run: &Circumstances,
    base: &Base,
    terms: &[Term],
    start: (f64, f64),
    roll_time_s: &[f64],
    moment_time_s: &[f64],
) -> (Vec<f64>, Vec<f64>) {
    let equation = Equation { run, base, terms };
    let last_s = [roll_time_s, moment_time_s]
        .iter()
        .filter_map(|t| t.last())
        .fold(0.0, |a: f64, b| a.max(*b));
    let n_lags: usize = terms
        .iter()
        .map(|term| if let Acts::Lagging(lag) = term.effect.acts { lag.n_states } else { 0 })
        .sum();
    let history = match n_lags {
        0 => equation.history::<2>(start, last_s),
        1..=2 => equation.history::<4>(start, last_s),
        3..=4 => equation.history::<6>(start, last_s),
        _ => equation.history::<MOST_STATES>(start, last_s),
    };
    let roll = roll_readings(&equation, &history, roll_time_s);
    let moment = moment_time_s
        .iter()
        .map(|&time_s| {
            let [roll, rate, _] = history.motion(time_s);
            let instant = equation.instant(time_s, roll, rate, Past::Free(&history));
            terms
                .iter()
                .map(|Term { effect, values }| match effect.acts {
                    Acts::Drive(law) => law(&instant, values),
                    _ => 0.0,
                })
                .sum()
        })
        .collect();
    (roll, moment)
}

fn roll_readings(equation: &Equation<'_>, history: &History, time_s: &[f64]) -> Vec<f64> {
    let mut readings: Vec<f64> = time_s.iter().map(|&t| history.motion(t)[0]).collect();
    let chain = |term: &Term| matches!(term.effect.acts, Acts::Roll(_));
    if !equation.terms.iter().any(chain) {
        return readings;
    }
    let instants: Vec<Instant<'_>> = time_s
        .iter()
        .map(|&t| {
            let [roll, rate, acceleration] = history.motion(t);
            let instant = equation.instant(t, roll, rate, Past::Free(history));
            Instant { acceleration_rad_per_s2: acceleration, ..instant }
        })
        .collect();
    for Term { effect, values } in equation.terms {
        if let Acts::Roll(adds) = effect.acts {
            let added = adds(&instants, values);
            readings.iter_mut().zip(added).for_each(|(reading, more)| *reading += more);
        }
    }
    readings
}
