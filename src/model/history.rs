//! A motion kept at equal steps, and read at any time between them.

/// Roll, rate and acceleration at equal steps.
#[derive(Debug, Clone, Default)]
pub struct History {
    step_s: f64,
    roll: Vec<f64>,
    rate: Vec<f64>,
    acceleration: Vec<f64>,
}

impl History {
    /// Nothing yet, with room for so many steps.
    pub(super) fn new(step_s: f64, n_steps: usize) -> Self {
        let room = || Vec::with_capacity(n_steps + 1);
        Self { step_s, roll: room(), rate: room(), acceleration: room() }
    }

    /// So many steps, all at rest.
    pub(super) fn still(step_s: f64, n_steps: usize) -> Self {
        let still = || vec![0.0; n_steps + 1];
        Self { step_s, roll: still(), rate: still(), acceleration: still() }
    }

    /// Starts anew.
    pub(super) fn clear(&mut self) {
        self.roll.clear();
        self.rate.clear();
        self.acceleration.clear();
    }

    /// Number of states, one more than of steps.
    pub(super) fn len(&self) -> usize {
        self.roll.len()
    }

    /// Roll, rate and acceleration, each at every step.
    pub(super) fn series(&self) -> [&[f64]; 3] {
        [&self.roll, &self.rate, &self.acceleration]
    }

    /// Where instants lie between these steps.
    pub(super) fn sampling(&self, time_s: &[f64]) -> Sampling {
        Sampling::new(time_s, self.step_s, self.len() - 1)
    }

    /// Adds one step.
    pub(super) fn push(&mut self, [roll, rate, acceleration]: [f64; 3]) {
        self.roll.push(roll);
        self.rate.push(rate);
        self.acceleration.push(acceleration);
    }

    /// Roll, rate and acceleration at a time [s] by the quintic between two steps.
    pub(super) fn motion(&self, time_s: f64) -> [f64; 3] {
        let place = (time_s / self.step_s).clamp(0.0, (self.len() - 1) as f64);
        let before = (place as usize).min(self.len() - 2);
        let weights = quintic(place - before as f64, self.step_s);
        weights.map(|weights| self.weighed(before, &weights))
    }

    /// Sum of two neighbouring states under the weights of a quintic between them.
    fn weighed(&self, before: usize, weights: &[f64; 6]) -> f64 {
        let pair = |of: &[f64]| [of[before], of[before + 1]];
        let [[p0, p1], [v0, v1], [a0, a1]] = self.series().map(pair);
        let [w0, w1, w2, w3, w4, w5] = weights;
        (w0 * p0 + w1 * v0) + (w2 * a0 + w3 * p1) + (w4 * v1 + w5 * a1)
    }

    /// Roll alone at the times of a [`Sampling`].
    pub(super) fn rolls<'a>(&'a self, sampling: &'a Sampling) -> impl Iterator<Item = f64> + 'a {
        sampling.places.iter().map(|(before, weights)| self.weighed(*before, weights))
    }
}

/// Where instants lie between the steps of histories, and the quintic's weights there.
#[derive(Debug, Clone)]
pub(super) struct Sampling {
    places: Vec<(usize, [f64; 6])>,
}

impl Sampling {
    /// For `n_steps` steps.
    fn new(time_s: &[f64], step_s: f64, n_steps: usize) -> Self {
        let place = |t: &f64| {
            let place = (t / step_s).clamp(0.0, n_steps as f64);
            let before = (place as usize).min(n_steps - 1);
            (before, quintic_roll(place - before as f64, step_s))
        };
        Self { places: time_s.iter().map(place).collect() }
    }
}

/// The quintic through roll, rate and acceleration at both ends of a step, a row for each of the
/// six: what it weighs in the roll at a share `x` of the step is the row's polynomial.
const QUINTIC: [[f64; 6]; 6] = [
    [1.0, 0.0, 0.0, -10.0, 15.0, -6.0],
    [0.0, 1.0, 0.0, -6.0, 8.0, -3.0],
    [0.0, 0.0, 0.5, -1.5, 1.5, -0.5],
    [0.0, 0.0, 0.0, 10.0, -15.0, 6.0],
    [0.0, 0.0, 0.0, -4.0, 7.0, -3.0],
    [0.0, 0.0, 0.0, 0.5, -1.0, 0.5],
];

/// What each of the six weighs in the roll at a share `x` of the step, by Horner's scheme: the roll
/// alone is what nearly every reading asks for.
fn quintic_roll(x: f64, step_s: f64) -> [f64; 6] {
    let h = step_s;
    let units = [1.0, h, h * h, 1.0, h, h * h];
    let value = |c: &[f64; 6]| c.iter().rev().fold(0.0, |sum, c| sum * x + c);
    std::array::from_fn(|i| units[i] * value(&QUINTIC[i]))
}

/// What each of the six weighs in roll, rate and acceleration at a share `x` of the step, by
/// Horner's scheme for the polynomials and their first two derivatives.
fn quintic(x: f64, step_s: f64) -> [[f64; 6]; 3] {
    let h = step_s;
    let units = [1.0, h, h * h, 1.0, h, h * h];
    let mut weights = [[0.0; 6]; 3];
    for (i, c) in QUINTIC.iter().enumerate() {
        let (mut value, mut first, mut half_second) = (c[5], 0.0, 0.0);
        for k in (0..5).rev() {
            half_second = half_second * x + first;
            first = first * x + value;
            value = value * x + c[k];
        }
        weights[0][i] = units[i] * value;
        weights[1][i] = units[i] * first / h;
        weights[2][i] = units[i] * 2.0 * half_second / (h * h);
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fifth_degree_is_read_exactly_between_steps() {
        let motion = |t: f64| [t.powi(5) - t, 5.0 * t.powi(4) - 1.0, 20.0 * t.powi(3)];
        let mut history = History::new(0.5, 4);
        (0..=4).for_each(|k| history.push(motion(0.5 * f64::from(k))));
        let times = [0.0, 0.1, 0.77, 1.5, 2.0];
        let sampling = Sampling::new(&times, 0.5, 4);
        for (t, roll) in times.iter().zip(history.rolls(&sampling)) {
            assert!((roll - motion(*t)[0]).abs() < 1e-12, "{t}: {roll}");
            let read = history.motion(*t);
            assert!((0..3).all(|i| (read[i] - motion(*t)[i]).abs() < 1e-11), "{t}: {read:?}");
        }
    }
}
