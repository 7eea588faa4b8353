//! A forced run simulated: the rod imposes a periodic course, and the moment follows from it.

use super::effect::{Acts, Circumstances, Instant, Lag, MOST_LAGS, Past};
use super::term::{Base, Term};

/// Harmonics of the imposed course.
pub const N_HARMONICS: usize = 3;
/// Numbers of a course: mean, pairs of each harmonic, frequency.
pub const N_COURSE: usize = 2 + 2 * N_HARMONICS;

/// `phi = c0 + sum_h a_h cos(h w t) + b_h sin(h w t)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// `c0`, then `a_h, b_h` with the fundamental first, then `w` [rad/s].
    pub numbers: [f64; N_COURSE],
}

impl Course {
    /// Roll, rate and acceleration at a time [s].
    pub fn at(&self, time_s: f64) -> [f64; 3] {
        let w = self.numbers[N_COURSE - 1];
        let (sin, cos) = (w * time_s).sin_cos();
        let (mut s, mut c) = (sin, cos);
        let mut motion = [self.numbers[0], 0.0, 0.0];
        for h in 0..N_HARMONICS {
            let hw = (h + 1) as f64 * w;
            let (a, b) = (self.numbers[1 + 2 * h], self.numbers[2 + 2 * h]);
            let value = a * c + b * s;
            motion[0] += value;
            motion[1] += hw * (b * c - a * s);
            motion[2] -= hw * hw * value;
            (s, c) = (s * cos + c * sin, c * cos - s * sin);
        }
        motion
    }
}

/// Periods before the start over which effects that remember settle.
const PERIODS_BEFORE: f64 = 8.0;
const STEPS_PER_PERIOD: f64 = 48.0;

/// What both channels read: roll [rad] and moment [N m].
pub fn readings(
    run: &Circumstances,
    base: &Base,
    terms: &[Term],
    course: &Course,
    roll_time_s: &[f64],
    moment_time_s: &[f64],
) -> (Vec<f64>, Vec<f64>) {
    let lagging: Vec<Lagged> = terms
        .iter()
        .filter_map(|term| match term.effect.acts {
            Acts::Lagging(lag) => Some(lagged(run, course, &lag, &term.values)),
            _ => None,
        })
        .collect();
    let Base { natural_rad_s: w, b1_per_s, b3_s, log_scale } = *base;
    let scale = log_scale.exp() * run.inertia_kg_m2 * (run.natural_rad_s / w).powi(2);
    let instant = |time_s: f64| {
        let [roll, rate, acceleration] = course.at(time_s);
        let mut instant = Instant {
            time_s,
            roll_rad: roll,
            rate_rad_per_s: rate,
            acceleration_rad_per_s2: acceleration,
            moment_n_m: 0.0,
            past: Past::Imposed(course),
            run,
        };
        let mut inertia = 1.0;
        let mut moment = b1_per_s * rate + b3_s * rate.powi(3) + w * w * roll;
        for Term { effect, values } in terms {
            match effect.acts {
                Acts::Moment(law) => moment -= law(&instant, values),
                Acts::Inertia(law) => inertia += law(&instant, values),
                _ => {}
            }
        }
        moment -= lagging.iter().map(|lagged| lagged.at(time_s)).sum::<f64>();
        instant.moment_n_m = scale * (inertia * acceleration + moment);
        instant
    };
    let moment = moment_time_s
        .iter()
        .map(|&time_s| {
            let instant = instant(time_s);
            let read = |Term { effect, values }: &Term| match effect.acts {
                Acts::Drive(law) => law(&instant, values),
                _ => 0.0,
            };
            instant.moment_n_m + terms.iter().map(read).sum::<f64>()
        })
        .collect();
    let mut roll: Vec<f64> = roll_time_s.iter().map(|&t| course.at(t)[0]).collect();
    if terms.iter().any(|term| matches!(term.effect.acts, Acts::Roll(_))) {
        let instants: Vec<Instant<'_>> = roll_time_s.iter().map(|&t| instant(t)).collect();
        for Term { effect, values } in terms {
            if let Acts::Roll(adds) = effect.acts {
                let added = adds(&instants, values);
                roll.iter_mut().zip(added).for_each(|(reading, more)| *reading += more);
            }
        }
    }
    (roll, moment)
}

/// The moment of an effect that remembers, over one period of a settled course.
struct Lagged {
    from_s: f64,
    step_s: f64,
    moment_per_s2: Vec<f64>,
}

impl Lagged {
    /// Moment per unit inertia [rad/s2] by a parabola through the nearest three steps; the course
    /// repeats, and so does what follows it.
    fn at(&self, time_s: f64) -> f64 {
        let n = self.moment_per_s2.len();
        let place = ((time_s - self.from_s) / self.step_s).rem_euclid(n as f64);
        let middle = place.round();
        let x = place - middle;
        let value = |k: f64| self.moment_per_s2[(k + n as f64) as usize % n];
        let (a, b, c) = (value(middle - 1.0), value(middle), value(middle + 1.0));
        b + 0.5 * x * (c - a) + 0.5 * x * x * (a - 2.0 * b + c)
    }
}

fn lagged(run: &Circumstances, course: &Course, lag: &Lag, values: &[f64]) -> Lagged {
    let period_s = std::f64::consts::TAU / course.numbers[N_COURSE - 1];
    let step_s = period_s / STEPS_PER_PERIOD;
    let instant = |time_s: f64| {
        let [roll_rad, rate_rad_per_s, acceleration_rad_per_s2] = course.at(time_s);
        Instant {
            time_s,
            roll_rad,
            rate_rad_per_s,
            acceleration_rad_per_s2,
            moment_n_m: 0.0,
            past: Past::Imposed(course),
            run,
        }
    };
    let from_s = -PERIODS_BEFORE * period_s;
    let n_steps = (PERIODS_BEFORE * STEPS_PER_PERIOD) as usize;
    let mut state = [0.0; MOST_LAGS];
    let mut moment_per_s2 = Vec::new();
    for step in 0..n_steps + STEPS_PER_PERIOD as usize {
        let time_s = from_s + step as f64 * step_s;
        let [start, middle, end] = [0.0, 0.5, 1.0].map(|share| instant(time_s + share * step_s));
        if step >= n_steps {
            moment_per_s2.push((lag.moment)(&start, values, &state[..lag.n_states]));
        }
        let along = |slope: &[f64; MOST_LAGS], share: f64| -> [f64; MOST_LAGS] {
            std::array::from_fn(|i| state[i] + share * step_s * slope[i])
        };
        let first = (lag.slope)(&start, values, &state);
        let second = (lag.slope)(&middle, values, &along(&first, 0.5));
        let third = (lag.slope)(&middle, values, &along(&second, 0.5));
        let fourth = (lag.slope)(&end, values, &along(&third, 1.0));
        let mean: [f64; MOST_LAGS] =
            std::array::from_fn(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0);
        state = along(&mean, 1.0);
    }
    Lagged { from_s: 0.0, step_s, moment_per_s2 }
}
