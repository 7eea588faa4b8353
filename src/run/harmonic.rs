//! Fits a decaying or steady sine by least squares; tells where the samples leave it.

use super::bins::Bin;

/// `exp(-k t) (a cos(w t) + b sin(w t)) + c`, `t` counted from an origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Harmonic {
    origin_s: f64,
    frequency_rad_s: f64,
    decay_per_s: f64,
    cosine: f64,
    sine: f64,
    mean: f64,
}

impl Harmonic {
    /// Fits amplitude, phase and mean to `bins` at a given frequency `w` and decay rate `k`;
    /// none with fewer than six bins or less than a quarter period of them.
    pub(super) fn fit(
        bins: impl Iterator<Item = Bin>,
        frequency_rad_s: f64,
        decay_per_s: f64,
    ) -> Option<Self> {
        let mut bins = bins.peekable();
        let origin_s = bins.peek()?.time_s;
        let mut normal = [[0.0; 4]; 3];
        let (mut n, mut last_s) = (0, origin_s);
        for bin in bins {
            let row = basis(bin.time_s - origin_s, frequency_rad_s, decay_per_s);
            for (i, left) in row.into_iter().enumerate() {
                for (j, right) in row.into_iter().enumerate() {
                    normal[i][j] += left * right;
                }
                normal[i][3] += left * bin.value;
            }
            (n, last_s) = (n + 1, bin.time_s);
        }
        if n < 6 || (last_s - origin_s) * frequency_rad_s < std::f64::consts::FRAC_PI_2 {
            return None;
        }
        let [cosine, sine, mean] = solve(normal)?;
        Some(Self { origin_s, frequency_rad_s, decay_per_s, cosine, sine, mean })
    }

    /// Amplitude at the origin.
    pub(super) fn amplitude(&self) -> f64 {
        self.cosine.hypot(self.sine)
    }

    /// Phase at `time_s` [rad]: the value is `amplitude cos(phase) + mean`.
    pub(super) fn phase_rad(&self, time_s: f64) -> f64 {
        self.frequency_rad_s * (time_s - self.origin_s) - self.sine.atan2(self.cosine)
    }

    /// Value at `time_s`.
    pub(super) fn at(&self, time_s: f64) -> f64 {
        let [c, s, one] = basis(time_s - self.origin_s, self.frequency_rad_s, self.decay_per_s);
        self.cosine * c + self.sine * s + self.mean * one
    }

    /// Time [s] from which the bins leave the sine for good: two in a row differ from it by more
    /// than `tolerance`, those before them more than a third of it.
    pub(super) fn departure_s(
        &self,
        bins: impl Iterator<Item = Bin>,
        tolerance: f64,
    ) -> Option<f64> {
        let (mut since_s, mut n_outside) = (None, 0);
        for bin in bins {
            let deviation = (bin.value - self.at(bin.time_s)).abs();
            if deviation <= tolerance / 3.0 {
                since_s = None;
            } else if since_s.is_none() {
                since_s = Some(bin.time_s);
            }
            n_outside = if deviation > tolerance { n_outside + 1 } else { 0 };
            if n_outside == 2 {
                return since_s;
            }
        }
        None
    }
}

fn basis(t: f64, frequency_rad_s: f64, decay_per_s: f64) -> [f64; 3] {
    let (sine, cosine) = (frequency_rad_s * t).sin_cos();
    let envelope = (-decay_per_s * t).exp();
    [envelope * cosine, envelope * sine, 1.0]
}

/// Solves three equations, each row with its right-hand side, by elimination with pivots.
fn solve(mut rows: [[f64; 4]; 3]) -> Option<[f64; 3]> {
    for k in 0..3 {
        let pivot = (k..3).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, pivot);
        if rows[k][k].abs() < 1e-12 {
            return None;
        }
        for i in (0..3).filter(|&i| i != k) {
            let pivot = rows[k];
            let factor = rows[i][k] / pivot[k];
            rows[i].iter_mut().zip(pivot).for_each(|(x, p)| *x -= factor * p);
        }
    }
    let x = [rows[0][3] / rows[0][0], rows[1][3] / rows[1][1], rows[2][3] / rows[2][2]];
    x.iter().all(|v| v.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decay(t: f64) -> f64 {
        0.2 * (-0.3 * t).exp() * (6.0 * t + 0.5).cos() + 0.01
    }

    #[test]
    fn a_decay_is_fitted_and_left_where_a_hand_holds_it() {
        let bins: Vec<Bin> = (0..60)
            .map(|k| f64::from(k) * 0.05)
            .map(|t| Bin { time_s: t, value: decay(t.min(2.0)) })
            .collect();
        let fit = Harmonic::fit(bins[..30].iter().copied(), 6.0, 0.3).unwrap();
        assert!((fit.amplitude() - 0.2).abs() < 1e-9);
        assert!((fit.at(1.0) - decay(1.0)).abs() < 1e-9);
        let departure_s = fit.departure_s(bins.iter().copied(), 0.02).unwrap();
        // The roll rate there is 0.4 rad/s or more: 0.02 rad within a twentieth of a second or two.
        assert!((2.0..2.25).contains(&departure_s), "{departure_s} s");
    }
}
