//! A motion kept at equal steps, and read at any time between them.

/// Roll, rate and acceleration at equal steps.
#[derive(Debug, Clone, Default)]
pub struct History {
    step_s: f64,
    states: Vec<[f64; 3]>,
}

impl History {
    /// Nothing yet, with room for so many steps.
    pub(super) fn new(step_s: f64, n_steps: usize) -> Self {
        Self { step_s, states: Vec::with_capacity(n_steps + 1) }
    }

    /// So many steps, all at rest.
    pub(super) fn still(step_s: f64, n_steps: usize) -> Self {
        Self { step_s, states: vec![[0.0; 3]; n_steps + 1] }
    }

    /// Starts anew.
    pub(super) fn clear(&mut self) {
        self.states.clear();
    }

    /// Where instants lie between these steps.
    pub(super) fn sampling(&self, time_s: &[f64]) -> Sampling {
        Sampling::new(time_s, self.step_s, self.states.len() - 1)
    }

    /// Adds one step.
    pub(super) fn push(&mut self, motion: [f64; 3]) {
        self.states.push(motion);
    }

    /// Roll with which it begins.
    pub(super) fn first_roll(&self) -> f64 {
        self.states.first().map_or(0.0, |[roll, ..]| *roll)
    }

    /// Roll, rate and acceleration at a time [s] by the quintic between two steps.
    pub(super) fn motion(&self, time_s: f64) -> [f64; 3] {
        let place = (time_s / self.step_s).clamp(0.0, (self.states.len() - 1) as f64);
        let before = (place as usize).min(self.states.len() - 2);
        let weights = quintic(place - before as f64, self.step_s);
        weights.map(|weights| self.weighed(before, &weights))
    }

    /// Sum of two neighbouring states under the weights of a quintic between them.
    pub(super) fn weighed(&self, before: usize, weights: &[f64; 6]) -> f64 {
        let ([p0, v0, a0], [p1, v1, a1]) = (self.states[before], self.states[before + 1]);
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
        let h = step_s;
        let place = |t: &f64| {
            let place = (t / h).clamp(0.0, n_steps as f64);
            let before = (place as usize).min(n_steps - 1);
            let [of_roll, ..] = quintic(place - before as f64, h);
            (before, of_roll)
        };
        Self { places: time_s.iter().map(place).collect() }
    }
}

/// The quintic through roll, rate and acceleration at both ends of a step: what each of the six
/// weighs in roll, rate and acceleration at a share `x` of the step.
pub(super) fn quintic(x: f64, step_s: f64) -> [[f64; 6]; 3] {
    const POWERS: [[f64; 6]; 6] = [
        [1.0, 0.0, 0.0, -10.0, 15.0, -6.0],
        [0.0, 1.0, 0.0, -6.0, 8.0, -3.0],
        [0.0, 0.0, 0.5, -1.5, 1.5, -0.5],
        [0.0, 0.0, 0.0, 10.0, -15.0, 6.0],
        [0.0, 0.0, 0.0, -4.0, 7.0, -3.0],
        [0.0, 0.0, 0.0, 0.5, -1.0, 0.5],
    ];
    let h = step_s;
    let units = [1.0, h, h * h, 1.0, h, h * h];
    let mut weights = [[0.0; 6]; 3];
    for (i, c) in POWERS.iter().enumerate() {
        // Horner's scheme for the polynomial and its first two derivatives.
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
