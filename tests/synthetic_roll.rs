//! Roll of known coefficients, as the synthetic results need it.

/// Time step of the records [s].
pub(crate) const STEP_S: f64 = 0.01;

/// The coefficients a run is made from.
#[derive(Clone, Copy)]
pub(crate) struct Truth {
    /// Natural frequency [rad/s].
    pub(crate) w: f64,
    /// Linear damping [1/s].
    pub(crate) b1: f64,
    /// Cubic damping [s].
    pub(crate) b3: f64,
    /// Amplitude of the exciting moment per unit inertia [rad/s2], zero in a decay.
    pub(crate) moment_amplitude_per_s2: f64,
    /// Frequency of the exciting moment [rad/s].
    pub(crate) excitation_rad_s: f64,
}

impl Truth {
    /// Whether a moment excites the roll.
    pub(crate) fn forced(&self) -> bool {
        self.moment_amplitude_per_s2 > 0.0
    }

    /// `b1 phi' + b3 phi'^3` [rad/s2].
    pub(crate) fn damping(&self, rate: f64) -> f64 {
        self.b1 * rate + self.b3 * rate.powi(3)
    }

    fn acceleration(&self, t: f64, roll: f64, rate: f64) -> f64 {
        let moment = self.moment_amplitude_per_s2 * (self.excitation_rad_s * t).cos();
        moment - self.damping(rate) - self.w * self.w * roll
    }

    /// Roll and rate at every step, by Heun's rule at a tenth of the step.
    pub(crate) fn motion(&self, n: usize) -> Vec<(f64, f64)> {
        let (mut roll, mut rate) = (if self.forced() { 0.0 } else { 0.26 }, 0.0);
        let (h, mut motion) = (STEP_S / 10.0, Vec::with_capacity(n));
        // A forced run is kept once its transient has died away.
        let n_skipped = if self.forced() { 40 * n / 10 } else { 0 };
        for k in 0..(n_skipped + n) * 10 {
            if k % 10 == 0 && k / 10 >= n_skipped {
                motion.push((roll, rate));
            }
            let t = (k as f64 - n_skipped as f64 * 10.0) * h;
            let a = self.acceleration(t, roll, rate);
            let (roll_end, rate_end) = (roll + h * rate, rate + h * a);
            let a_end = self.acceleration(t + h, roll_end, rate_end);
            roll += 0.5 * h * (rate + rate_end);
            rate += 0.5 * h * (a + a_end);
        }
        motion
    }

    /// Equivalent damping [1/s] at a roll amplitude [rad].
    pub(crate) fn equivalent(&self, amplitude_rad: f64) -> f64 {
        self.b1 + 0.75 * (self.w * amplitude_rad).powi(2) * self.b3
    }
}
