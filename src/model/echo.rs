//! Echoes: the motion of a run at earlier times, each time with its weight.

use super::course::{Course, N_COURSE, N_HARMONICS};
use super::effect::Circumstances;
use super::history::{History, quintic};
use super::number::{Number, Sloped, slope};

/// Share that the motion some time ago has in a moment now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tap<N = f64> {
    /// How long ago [s], whatever the parameters; longer than a step of any motion.
    pub delay_s: f64,
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

/// Weights of roll, rate and acceleration some time [s] ago.
type Earlier = (f64, [f64; 3]);

/// Earlier times with their weights.
#[derive(Debug, Clone)]
pub(super) struct Echo(Vec<Earlier>);

impl Echo {
    /// The echo under some parameters.
    pub(super) fn new(taps: &Taps, run: &Circumstances, values: &[f64]) -> Self {
        let taps = (taps.plain)(run, values);
        let of = |tap: &Tap| (tap.delay_s, [tap.of_roll, tap.of_rate, tap.of_acceleration]);
        Self(taps.iter().map(of).collect())
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
                (tap.delay_s, weights.map(|weight| weight.slopes[place(k)]))
            };
            Self(taps.iter().map(of).collect())
        };
        (0..values.len()).map(along).collect()
    }

    /// Ready for a motion kept at equal steps.
    pub(super) fn of_steps(&self, step_s: f64) -> StepEcho {
        let at = |offset: f64| -> Vec<(usize, [f64; 6])> {
            let taps = self.0.iter().map(|(delay_s, of)| {
                let place = offset - delay_s / step_s;
                let before = place.floor();
                let weights = quintic(place - before, step_s);
                let sum = |i: usize| (0..3).map(|m| of[m] * weights[m][i]).sum();
                (-before as usize, std::array::from_fn(sum))
            });
            taps.collect()
        };
        StepEcho { at_step: at(0.0), between: at(0.5) }
    }

    /// Ready for a course that a rod has imposed for some time [s] at time zero.
    pub(super) fn of_course(&self, course: &Course, imposed_for_s: f64) -> CourseEcho {
        let w = course.frequency_rad_s();
        let mut heard = vec![Heard::default()];
        for (delay_s, [of_roll, of_rate, of_acceleration]) in &self.0 {
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
        let delays_s = self.0.iter().map(|(delay_s, _)| *delay_s).collect();
        CourseEcho { frequency_rad_s: w, imposed_for_s, delays_s, heard }
    }
}

/// An echo on equal steps: how many steps before, and the weights of the quintic from there on.
#[derive(Debug, Clone)]
pub(super) struct StepEcho {
    at_step: Vec<(usize, [f64; 6])>,
    between: Vec<(usize, [f64; 6])>,
}

impl StepEcho {
    /// The echo at a step, or half a step after it; before the motion began the model was held.
    pub(super) fn at(&self, history: &History, step: usize, is_half_after: bool) -> f64 {
        let taps = if is_half_after { &self.between } else { &self.at_step };
        let held_rad = history.first_roll();
        let heard = taps.iter().map(|(before, weights)| match step.checked_sub(*before) {
            Some(place) => history.weighed(place, weights),
            None => (weights[0] + weights[3]) * held_rad,
        });
        heard.sum()
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
