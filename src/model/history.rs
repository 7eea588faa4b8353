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

    /// Roll [rad], rate [rad/s] and acceleration [rad/s2] at a time [s]; nil before the start.
    pub fn at(&self, time_s: f64) -> [f64; 3] {
        if time_s <= 0.0 || self.states.len() < 2 {
            return [0.0; 3];
        }
        self.motion(time_s)
    }

    /// Roll, rate and acceleration at a time [s] by the quintic between two steps.
    pub(super) fn motion(&self, time_s: f64) -> [f64; 3] {
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

    /// Roll alone at the times of a [`Sampling`].
    pub(super) fn rolls<'a>(&'a self, sampling: &'a Sampling) -> impl Iterator<Item = f64> + 'a {
        sampling.places.iter().map(|(before, weights)| {
            let ([p0, v0, a0], [p1, v1, a1]) = (self.states[*before], self.states[*before + 1]);
            let [w0, w1, w2, w3, w4, w5] = weights;
            (w0 * p0 + w1 * v0) + (w2 * a0 + w3 * p1) + (w4 * v1 + w5 * a1)
        })
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
            let (x, y) = (place - before as f64, 1.0 - (place - before as f64));
            // Each weight is a cubic times what keeps the other end still.
            let (from_end, from_start) = (y * y * y, x * x * x);
            let weights = [
                from_end * (1.0 + x * (3.0 + 6.0 * x)),
                from_end * x * (1.0 + 3.0 * x) * h,
                from_end * x * x * 0.5 * h * h,
                from_start * (1.0 + y * (3.0 + 6.0 * y)),
                -from_start * y * (1.0 + 3.0 * y) * h,
                from_start * y * y * 0.5 * h * h,
            ];
            (before, weights)
        };
        Self { places: time_s.iter().map(place).collect() }
    }
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
