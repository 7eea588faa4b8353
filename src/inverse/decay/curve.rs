//! The damping moment as a function of the roll rate alone, of any odd shape.
//!
//! `b(phi') = s phi' sum_k c_k P_k(|phi'|/R)` with `P_k` the Legendre polynomials on `[0, 1]`, `R`
//! the largest rate of the run and `s` its size: every law that the field uses is a line or a plane
//! in the space of the `c_k`.

use std::f64::consts::FRAC_PI_2;

/// Number of polynomials: enough for a law that changes its power once within the run.
pub const N_CURVE: usize = 6;

/// What makes the coefficients of a curve numbers of order one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Size of the damping `s` [1/s].
    pub damping_per_s: f64,
    /// Largest rate `R` [rad/s].
    pub rate_rad_per_s: f64,
}

impl Scale {
    /// Moment per unit inertia [rad/s2] of a unit of each coefficient at a roll rate [rad/s].
    pub fn moments(&self, rate_rad_per_s: f64) -> [f64; N_CURVE] {
        let linear = self.damping_per_s * rate_rad_per_s;
        legendre(rate_rad_per_s.abs() / self.rate_rad_per_s).map(|p| linear * p)
    }

    /// Equivalent damping [1/s] of a unit of each coefficient where the rate swings by
    /// `rate_rad_per_s`: equal work over a cycle.
    pub fn equivalents(&self, rate_rad_per_s: f64) -> [f64; N_CURVE] {
        // The mean of g sin^2 over a quarter cycle, by the midpoint rule, which is exact for
        // trigonometric polynomials but for the sign of the sine.
        const N_POINTS: u32 = 64;
        let mut sum = [0.0; N_CURVE];
        for i in 0..N_POINTS {
            let sine = (FRAC_PI_2 * (f64::from(i) + 0.5) / f64::from(N_POINTS)).sin();
            let p = legendre(rate_rad_per_s * sine / self.rate_rad_per_s);
            for (sum, p) in sum.iter_mut().zip(p) {
                *sum += 2.0 * sine * sine * p / f64::from(N_POINTS);
            }
        }
        sum.map(|s| s * self.damping_per_s)
    }
}

/// The Legendre polynomials on `[0, 1]` at `x`.
fn legendre(x: f64) -> [f64; N_CURVE] {
    let argument = 2.0 * x - 1.0;
    let mut p = [1.0; N_CURVE];
    p[1] = argument;
    for k in 1..N_CURVE - 1 {
        let order = k as f64;
        p[k + 1] = ((2.0 * order + 1.0) * argument * p[k] - order * p[k - 1]) / (order + 1.0);
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_equivalents_are_those_of_the_linear_quadratic_and_cubic_law() {
        let scale = Scale { damping_per_s: 1.0, rate_rad_per_s: 2.0 };
        let of = |c: [f64; N_CURVE], rate: f64| -> f64 {
            scale.equivalents(rate).iter().zip(c).map(|(e, c)| e * c).sum()
        };
        // |phi'|/R = (P0 + P1)/2 and (phi'/R)^2 = (2 P0 + 3 P1 + P2)/6.
        let quadratic = of([0.5, 0.5, 0.0, 0.0, 0.0, 0.0], 1.4);
        let cubic = of([2.0 / 6.0, 3.0 / 6.0, 1.0 / 6.0, 0.0, 0.0, 0.0], 1.4);
        assert!((of([1.0, 0.0, 0.0, 0.0, 0.0, 0.0], 1.4) - 1.0).abs() < 1e-12);
        assert!((quadratic - 8.0 / (3.0 * std::f64::consts::PI) * 0.7).abs() < 1e-4);
        assert!((cubic - 0.75 * 0.49).abs() < 1e-12);
    }
}
