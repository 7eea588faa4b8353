//! Echoes: the motion of a run at earlier times, each time with its weight.

use super::course::{Course, N_COURSE, N_HARMONICS};
use super::effect::Circumstances;
use super::history::History;
use super::number::{Number, Sloped, slope};

/// Share that the motion some time ago has in a moment now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tap<N = f64> {
    /// How many half periods of the natural frequency ago, whatever the parameters; not nil.
    pub half_periods: usize,
    /// Moment per unit inertia and roll [1/s2].
    pub of_roll: N,
    /// Moment per unit inertia and roll rate [1/s].
    pub of_rate: N,
    /// Moment per unit inertia and roll acceleration [-].
    pub of_acceleration: N,
}

/// The shares that an echo is made of under its parameters, the same all along a run.
#[derive(Debug, Clone, Copy)]
pub struct Taps {
    /// For their values.
    pub plain: fn(&Circumstances, &[f64]) -> Vec<Tap>,
    /// For their slopes as well.
    pub sloped: fn(&Circumstances, &[Sloped]) -> Vec<Tap<Sloped>>,
}

/// Earlier times, so many half periods ago, with the weights of roll, rate and acceleration.
#[derive(Debug, Clone)]
pub(super) struct Echo {
    half_period_s: f64,
    taps: Vec<(usize, [f64; 3])>,
}

impl Echo {
    /// The echo under some parameters.
    pub(super) fn new(taps: &Taps, run: &Circumstances, values: &[f64]) -> Self {
        let taps = (taps.plain)(run, values);
        let of = |tap: &Tap| (tap.half_periods, [tap.of_roll, tap.of_rate, tap.of_acceleration]);
        Self { half_period_s: half_period_s(run), taps: taps.iter().map(of).collect() }
    }

    /// What each parameter does to it.
    pub(super) fn slopes(taps: &Taps, run: &Circumstances, values: &[f64]) -> Vec<Self> {
        let place = |k: usize| slope::PARAMETER + k;
        let inputs: Vec<Sloped> =
            values.iter().enumerate().map(|(k, v)| Sloped::input(*v, place(k))).collect();
        let taps = (taps.sloped)(run, &inputs);
        let along = |k: usize| {
            let of = |tap: &Tap<Sloped>| {
                let weights = [tap.of_roll, tap.of_rate, tap.of_acceleration];
                (tap.half_periods, weights.map(|weight| weight.slopes[place(k)]))
            };
            Self { half_period_s: half_period_s(run), taps: taps.iter().map(of).collect() }
        };
        (0..values.len()).map(along).collect()
    }

    /// Ready for a motion that is kept at so many equal steps each half period.
    pub(super) fn of_steps(&self, steps_per_half_period: usize) -> StepEcho {
        let of = |(half_periods, weights): &(usize, [f64; 3])| {
            (half_periods * steps_per_half_period, *weights)
        };
        let taps = self.taps.iter().map(of).collect();
        StepEcho { taps, held_rad: 0.0, heard: Vec::new() }
    }

    /// Ready for a course that a rod has imposed for some time [s] at time zero.
    pub(super) fn of_course(&self, course: &Course, imposed_for_s: f64) -> CourseEcho {
        let w = course.frequency_rad_s();
        let mut heard = vec![Heard::default()];
        let delay_s = |half_periods: usize| half_periods as f64 * self.half_period_s;
        for (half_periods, [of_roll, of_rate, of_acceleration]) in &self.taps {
            let delay_s = delay_s(*half_periods);
            let mut sum = heard[heard.len() - 1];
            sum.of_mean += of_roll;
            for h in 0..N_HARMONICS {
                let n = (h + 1) as f64;
                let (sin, cos) = (n * w * delay_s).sin_cos();
                let weight = [of_roll - n * n * w * w * of_acceleration, n * w * of_rate];
                let share = times(weight, [cos, -sin]);
                let of_weight =
                    times([-2.0 * n * n * w * of_acceleration, n * of_rate], [cos, -sin]);
                // The derivative of exp(-i n w s) is -i n s of it.
                let of_delay = [n * delay_s * share[1], -n * delay_s * share[0]];
                for i in 0..2 {
                    sum.transfer[h][i] += share[i];
                    sum.of_frequency[h][i] += of_weight[i] + of_delay[i];
                }
            }
            heard.push(sum);
        }
        let delays_s = self.taps.iter().map(|(half_periods, _)| delay_s(*half_periods)).collect();
        CourseEcho { frequency_rad_s: w, imposed_for_s, delays_s, heard }
    }
}

fn half_period_s(run: &Circumstances) -> f64 {
    std::f64::consts::PI / run.natural_rad_s
}

/// An echo on equal steps, worked out as far ahead as the motion until now reaches.
#[derive(Debug, Clone)]
pub(super) struct StepEcho {
    /// How many steps ago, and the weights of roll, rate and acceleration there.
    taps: Vec<(usize, [f64; 3])>,
    /// Roll at which the model was held before the motion [rad].
    held_rad: f64,
    /// The echo at every step so far.
    heard: Vec<f64>,
}

/// Weights of the steps about the middle between two of them: a fifth degree through six.
const MIDWAY: [f64; 6] = [3.0, -25.0, 150.0, 150.0, -25.0, 3.0];
/// Steps that are worked out at once where no tap says how far ahead that may be.
const AHEAD: usize = 64;

impl StepEcho {
    /// Begins with a motion of a model that was held at a roll [rad].
    pub(super) fn begin(&mut self, held_rad: f64) {
        self.held_rad = held_rad;
        self.heard.clear();
    }

    /// The echo of a motion at one of its steps, or at one of those that come next.
    pub(super) fn at(&mut self, history: &History, step: usize) -> f64 {
        if self.heard.len() <= step {
            self.work_out(history);
        }
        self.heard[step]
    }

    /// The same half a step after.
    pub(super) fn midway(&mut self, history: &History, step: usize) -> f64 {
        self.at(history, step + 3);
        let at = |k: usize| self.heard[(step + k).saturating_sub(2)];
        MIDWAY.iter().enumerate().map(|(k, weight)| weight / 256.0 * at(k)).sum()
    }

    /// The echo at every step of a motion that is known to its end.
    pub(super) fn whole(mut self, history: &History) -> Vec<f64> {
        self.begin(history.series()[0][0]);
        self.work_out(history);
        self.heard
    }

    /// One stretch more, which ends where the first tap hears of the last step that is known.
    fn work_out(&mut self, history: &History) {
        let first_tap = self.taps.iter().map(|(steps, _)| *steps).min().unwrap_or(AHEAD);
        let (from, to) = (self.heard.len(), history.len() + first_tap);
        self.heard.resize(to, 0.0);
        let series = history.series();
        for (steps, weights) in &self.taps {
            let begins = (*steps).clamp(from, to);
            let [of_roll, of_rate, of_acceleration] = weights;
            self.heard[from..begins].iter_mut().for_each(|heard| *heard += of_roll * self.held_rad);
            let earlier = begins - steps.min(&begins)..to - steps.min(&to);
            let [roll, rate, acceleration] = series.map(|of| &of[earlier.clone()]);
            let motion = roll.iter().zip(rate).zip(acceleration);
            for (heard, ((roll, rate), acceleration)) in self.heard[begins..].iter_mut().zip(motion)
            {
                *heard += of_roll * roll + of_rate * rate + of_acceleration * acceleration;
            }
        }
    }
}

/// An echo of a periodic course: `Re sum_h T_h (a_h - i b_h) exp(i h w t)`.
#[derive(Debug, Clone)]
pub(super) struct CourseEcho {
    frequency_rad_s: f64,
    imposed_for_s: f64,
    /// After how long [s] each tap is heard, the first one first.
    delays_s: Vec<f64>,
    /// What is heard when none, one, two and so on of them are.
    heard: Vec<Heard>,
}

/// Taps together.
#[derive(Debug, Clone, Copy, Default)]
struct Heard {
    of_mean: f64,
    /// `T_h`, real and imaginary.
    transfer: [[f64; 2]; N_HARMONICS],
    /// Its derivative with `w`.
    of_frequency: [[f64; 2]; N_HARMONICS],
}

impl CourseEcho {
    /// The echo at a time [s].
    pub(super) fn at(&self, course: &Course, time_s: f64) -> f64 {
        let of = self.changes(course, time_s);
        course.numbers[..N_COURSE - 1].iter().zip(of).map(|(number, of)| number * of).sum()
    }

    /// What each number of the course does to it at a time [s].
    pub(super) fn changes(&self, course: &Course, time_s: f64) -> [f64; N_COURSE] {
        let n_heard = self.delays_s.partition_point(|s| *s <= time_s + self.imposed_for_s);
        let Heard { of_mean, transfer, of_frequency } = &self.heard[n_heard];
        let (sin, cos) = (self.frequency_rad_s * time_s).sin_cos();
        let mut turned = [cos, sin];
        let mut changes = [0.0; N_COURSE];
        changes[0] = *of_mean;
        for h in 0..N_HARMONICS {
            let (a, b) = (course.numbers[1 + 2 * h], course.numbers[2 + 2 * h]);
            let [re, im] = times(transfer[h], turned);
            changes[1 + 2 * h] = re;
            changes[2 + 2 * h] = im;
            let [of_re, of_im] = times(of_frequency[h], turned);
            let along = (h + 1) as f64 * time_s;
            changes[N_COURSE - 1] += (of_re - along * im) * a + (of_im + along * re) * b;
            turned = times(turned, [cos, sin]);
        }
        changes
    }
}

/// Product of two complex numbers, real and imaginary parts.
pub fn times<N: Number>(a: [N; 2], b: [N; 2]) -> [N; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}
