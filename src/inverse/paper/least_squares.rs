//! The unregularised least-squares solution of (2.5), shown by the paper in Fig. 9.

use super::convolution::Convolution;

/// The minimum-norm least-squares solution `U` [rad/s2] of `g = H U`, shape `(n)` to `(n)`.
///
/// `H` is strictly lower triangular, so it is solved by its own recurrence,
/// `U[i] = (y[i+1] - 2 cos(w dt) y[i] + y[i-1])/s` with `s = dt sin(w dt)/w`. The first row of `H`
/// is zero, so `g[0]` cannot be explained and `y[0] = 0`, else `y = g`. The last column is zero, so
/// the record says nothing about `U[n-1]`; the minimum norm puts it at 0.
///
/// # Panics
/// When `g` has not `n` entries.
pub fn least_squares(g: &[f64], convolution: &Convolution) -> Vec<f64> {
    let n = convolution.n();
    assert_eq!(g.len(), n, "one observable per sample");
    let (w, dt) = (convolution.natural_frequency_rad_s(), convolution.step_s());
    let (sin, cos) = (w * dt).sin_cos();
    let s = dt * sin / w;
    let y = |i: usize| if i == 0 { 0.0 } else { g[i] };
    let mut u: Vec<f64> = (0..n - 1)
        .map(|i| {
            let before = if i == 0 { 0.0 } else { y(i - 1) };
            (y(i + 1) - 2.0 * cos * y(i) + before) / s
        })
        .collect();
    u.push(0.0);
    u
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_noise_free_record_gives_the_moment_back(
            u in prop::collection::vec(-3.0..3.0, 4..300),
            dt in 2e-3..0.2,
            w in 0.5..12.0,
        ) {
            let convolution = Convolution::new(u.len(), dt, w).unwrap();
            let g = convolution.apply(&u);
            let solved = least_squares(&g, &convolution);
            // Rounding of g is magnified by 4/s: the instability of Fig. 9, at 1e-16.
            let size = g.iter().fold(0.0_f64, |size, g| size.max(g.abs()));
            let s = dt * (w * dt).sin() / w;
            let tolerance = 1e-14 * (1.0 + u.len() as f64 * size / s);
            for i in 0..u.len() - 1 {
                prop_assert!((solved[i] - u[i]).abs() <= tolerance, "entry {}", i);
            }
            prop_assert!(solved[u.len() - 1].abs() <= 0.0, "the last moment leaves no trace");
        }

        #[test]
        fn no_other_moment_fits_better(
            g in prop::collection::vec(-0.1..0.1, 5..60),
            dt in 0.02..0.2,
            w in 0.5..12.0,
        ) {
            let convolution = Convolution::new(g.len(), dt, w).unwrap();
            let fitted = convolution.apply(&least_squares(&g, &convolution));
            // All of the residual sits in the first sample, which no moment can reach.
            prop_assert!(fitted[0].abs() <= 0.0);
            for i in 1..g.len() {
                prop_assert!((fitted[i] - g[i]).abs() < 1e-10, "sample {}", i);
            }
        }
    }

    #[test]
    fn noise_of_a_twentieth_of_a_degree_drowns_the_moment_at_fifty_hertz() {
        let (n, dt, w) = (500, 0.02, 6.905);
        let convolution = Convolution::new(n, dt, w).unwrap();
        let u: Vec<f64> = (0..n).map(|i| 0.3 * (w * dt * i as f64).sin()).collect();
        let noise = |i: usize| 0.05_f64.to_radians() * if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let g: Vec<f64> =
            convolution.apply(&u).iter().enumerate().map(|(i, g)| g + noise(i)).collect();
        let solved = least_squares(&g, &convolution);
        // Alternating noise e comes back as 4 e/s, s = 3.97e-4: 8.8 rad/s2 against a moment of 0.3.
        let error = (solved[100] - u[100]).abs();
        assert!((8.5..9.0).contains(&error), "error {error}");
    }
}
