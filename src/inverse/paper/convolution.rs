//! The kernel of (2.2) as a discrete convolution, and the observable `g` of (2.4).
//!
//! The matrix `H` is Toeplitz, and its kernel is the impulse response of an undamped oscillator.
//! So `H u` is that oscillator kicked by `dt u[j]` at every sample: a rotation of two numbers per
//! sample instead of `n^2` products, with no digits lost however small the step.

use super::PaperError;

/// The matrix `H` of (2.5) and (2.6) per unit inertia, never formed.
///
/// `H[i][j] = dt sin(w (t_i - t_j))/w` for `t_j < t_i`, else 0. The paper prints (2.2) without the
/// minus sign of `-B`; here `g = H U` with `U = -B/(I+dI)`, as its Sec. 4.1 uses it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convolution {
    n: usize,
    step_s: f64,
    natural_frequency_rad_s: f64,
}

impl Convolution {
    /// The convolution over `n` samples every `step_s` [s], for a natural frequency [rad/s].
    ///
    /// # Errors
    /// [`PaperError::TooFewSamples`]; [`PaperError::StepTooLong`] unless `0 < w dt < pi`, because
    /// at `w dt = pi` the samples no longer see the moment.
    pub fn new(n: usize, step_s: f64, natural_frequency_rad_s: f64) -> Result<Self, PaperError> {
        const N_MIN: usize = 4;
        if n < N_MIN {
            return Err(PaperError::TooFewSamples { n, n_min: N_MIN });
        }
        let angle_rad = step_s * natural_frequency_rad_s;
        let in_range = step_s > 0.0 && angle_rad > 0.0 && angle_rad < std::f64::consts::PI;
        if !in_range || !natural_frequency_rad_s.is_finite() {
            return Err(PaperError::StepTooLong { step_s, natural_frequency_rad_s });
        }
        Ok(Self { n, step_s, natural_frequency_rad_s })
    }

    /// Number of samples `n`.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Time between samples `dt` [s].
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// Natural frequency `w` [rad/s].
    pub fn natural_frequency_rad_s(&self) -> f64 {
        self.natural_frequency_rad_s
    }

    /// `H u` [rad] of a moment history `u` [rad/s2], shape `(n)` to `(n)`.
    ///
    /// # Panics
    /// When `u` has not `n` entries.
    pub fn apply(&self, u: &[f64]) -> Vec<f64> {
        assert_eq!(u.len(), self.n, "one moment per sample");
        self.ring(u.iter().copied()).collect()
    }

    /// `H' r`, shape `(n)` to `(n)`.
    ///
    /// A Toeplitz matrix is its own transpose read backwards.
    ///
    /// # Panics
    /// When `r` has not `n` entries.
    pub fn apply_transposed(&self, r: &[f64]) -> Vec<f64> {
        assert_eq!(r.len(), self.n, "one residual per sample");
        let mut z: Vec<f64> = self.ring(r.iter().rev().copied()).collect();
        z.reverse();
        z
    }

    /// The observable `g` [rad] of (2.4) and (2.7).
    ///
    /// `g = phi - phi0 cos(w t) - phi0' sin(w t)/w - H m`, with `m = M/(I+dI)` [rad/s2] in a forced
    /// run; `roll` and `initial_roll` in [rad], `initial_rate` in [rad/s], `t = 0` at the first
    /// sample.
    ///
    /// # Panics
    /// When `roll` or `moment_over_inertia` has not `n` entries.
    pub fn observable(
        &self,
        roll: &[f64],
        initial_roll: f64,
        initial_rate: f64,
        moment_over_inertia: Option<&[f64]>,
    ) -> Vec<f64> {
        assert_eq!(roll.len(), self.n, "one roll angle per sample");
        let w = self.natural_frequency_rad_s;
        let free = roll.iter().enumerate().map(|(i, phi)| {
            let (sin, cos) = (w * self.step_s * i as f64).sin_cos();
            phi - initial_roll * cos - initial_rate * sin / w
        });
        match moment_over_inertia {
            None => free.collect(),
            Some(m) => free.zip(self.apply(m)).map(|(g, response)| g - response).collect(),
        }
    }

    /// The oscillator's turn over one step.
    pub(super) fn turn(&self) -> Turn {
        let (sin, cos) = (self.natural_frequency_rad_s * self.step_s).sin_cos();
        Turn { sin, cos, natural_frequency_rad_s: self.natural_frequency_rad_s }
    }

    /// Displacement before each kick of an oscillator at rest.
    fn ring(&self, kicks: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
        let (turn, step_s) = (self.turn(), self.step_s);
        kicks.scan((0.0, 0.0), move |(y, rate), kick| {
            let before = *y;
            (*y, *rate) = turn.advance(before, *rate + step_s * kick);
            Some(before)
        })
    }
}

/// Exact motion of the undamped oscillator over one step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    sin: f64,
    cos: f64,
    natural_frequency_rad_s: f64,
}

impl Turn {
    /// Displacement and rate one step later.
    pub(super) fn advance(self, y: f64, rate: f64) -> (f64, f64) {
        let w = self.natural_frequency_rad_s;
        (self.cos * y + self.sin * rate / w, self.cos * rate - self.sin * w * y)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The sum of (2.5) written out.
    fn dense(convolution: &Convolution, u: &[f64], transposed: bool) -> Vec<f64> {
        let (n, dt, w) = (convolution.n, convolution.step_s, convolution.natural_frequency_rad_s);
        let h = |i: usize, j: usize| {
            if j < i { dt * (w * dt * (i - j) as f64).sin() / w } else { 0.0 }
        };
        (0..n)
            .map(|i| (0..n).map(|j| u[j] * if transposed { h(j, i) } else { h(i, j) }).sum())
            .collect()
    }

    fn assert_close(a: &[f64], b: &[f64], tolerance: f64) {
        for (i, (a, b)) in a.iter().zip(b).enumerate() {
            assert!((a - b).abs() <= tolerance, "entry {i}: {a} against {b}");
        }
    }

    fn histories() -> impl Strategy<Value = (Vec<f64>, f64, f64)> {
        (prop::collection::vec(-3.0..3.0, 4..120), 2e-4..0.2, 0.5..12.0)
    }

    proptest! {
        #[test]
        fn the_oscillator_is_the_printed_sum((u, dt, w) in histories()) {
            let convolution = Convolution::new(u.len(), dt, w).unwrap();
            // Rounding of n products, each below dt * 3 / w.
            let tolerance = 1e-13 * u.len() as f64 * dt * 3.0 / w;
            assert_close(&convolution.apply(&u), &dense(&convolution, &u, false), tolerance);
            let transposed = convolution.apply_transposed(&u);
            assert_close(&transposed, &dense(&convolution, &u, true), tolerance);
        }

        #[test]
        fn the_output_obeys_the_three_term_recurrence((u, dt, w) in histories()) {
            let convolution = Convolution::new(u.len(), dt, w).unwrap();
            let y = convolution.apply(&u);
            let (sin, cos) = (w * dt).sin_cos();
            let size = y.iter().fold(0.0_f64, |size, y| size.max(y.abs()));
            for i in 1..u.len() - 1 {
                let kick = y[i + 1] - 2.0 * cos * y[i] + y[i - 1];
                // The three terms cancel down to the kick, so the error is of their size.
                prop_assert!((kick - dt * sin / w * u[i]).abs() <= 1e-13 * (size + dt / w));
            }
        }
    }

    #[test]
    fn an_undamped_roll_leaves_nothing_to_explain() {
        let (n, dt, w, m) = (400, 0.02, 6.136, 0.7);
        let convolution = Convolution::new(n, dt, w).unwrap();
        let forcing = vec![m; n];
        let response = convolution.apply(&forcing);
        let roll: Vec<f64> = (0..n)
            .map(|i| {
                let (sin, cos) = (w * dt * i as f64).sin_cos();
                0.17 * cos - 0.4 * sin / w + response[i]
            })
            .collect();
        let g = convolution.observable(&roll, 0.17, -0.4, Some(&forcing));
        assert!(g.iter().all(|g| g.abs() < 1e-14), "rounding only");
        let unforced = convolution.observable(&roll, 0.17, -0.4, None);
        // The rectangle rule of (2.5) tends to m (1 - cos w t)/w^2; half a step of lag at most.
        for (i, g) in unforced.iter().enumerate() {
            let exact = m * (1.0 - (w * dt * i as f64).cos()) / (w * w);
            assert!((g - exact).abs() < 0.5 * dt * m / w + 1e-4, "sample {i}");
        }
    }

    #[test]
    fn a_step_that_hides_the_moment_is_refused() {
        let error = Convolution::new(100, 0.6, 6.136).unwrap_err().to_string();
        assert!(error.contains("0.6 s") && error.contains("0.512 s"), "{error}");
        assert!(error.contains("hint:"), "{error}");
        assert!(Convolution::new(100, f64::NAN, 6.0).is_err());
        assert!(Convolution::new(100, 0.02, f64::INFINITY).is_err());
        assert!(Convolution::new(3, 0.02, 6.0).is_err());
    }
}
