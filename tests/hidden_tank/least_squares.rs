//! Levenberg and Marquardt's least squares for the few dozen unknowns of a campaign.

/// Residuals and, one row per unknown, their derivatives, of one part of the data; each derivative
/// names its unknown.
pub(crate) struct Part {
    /// Model less data, by its standard deviation.
    pub(crate) residuals: Vec<f64>,
    /// Unknown, and the derivative of every residual with respect to it.
    pub(crate) slopes: Vec<(usize, Vec<f64>)>,
}

/// What the search ended with.
pub(crate) struct Minimum {
    /// Sum of squares with the priors.
    pub(crate) sum: f64,
    /// Where it is.
    pub(crate) x: Vec<f64>,
    /// The normal matrix of the last round, row by row.
    pub(crate) matrix: Vec<f64>,
}

/// Minimises the sum of squares of `parts(x, true)` and of `(x - mean)/sd` of every unknown.
///
/// `parts` is asked for slopes only where the search goes on from.
pub(crate) fn minimise(
    mut x: Vec<f64>,
    priors: &[(f64, f64)],
    rounds: usize,
    parts: impl Fn(&[f64], bool) -> Vec<Part>,
) -> Minimum {
    let prior_sum = |x: &[f64]| {
        x.iter().zip(priors).map(|(x, (mean, sd))| ((x - mean) / sd).powi(2)).sum::<f64>()
    };
    let data_sum =
        |parts: &[Part]| parts.iter().flat_map(|part| &part.residuals).map(|r| r * r).sum::<f64>();
    let mut sum = f64::INFINITY;
    let mut damping = 1e-3;
    let mut last = Vec::new();
    for _ in 0..rounds {
        let now = parts(&x, true);
        let before = data_sum(&now) + prior_sum(&x);
        sum = sum.min(before);
        let (matrix, gradient) = normal_equations(&x, priors, &now);
        let mut moved = false;
        for _ in 0..8 {
            let trial = solve(&matrix, &gradient, damping)
                .map(|change| x.iter().zip(change).map(|(x, d)| x - d).collect::<Vec<f64>>());
            let Some(trial) = trial else {
                damping *= 10.0;
                continue;
            };
            let after = data_sum(&parts(&trial, false)) + prior_sum(&trial);
            if after.is_finite() && after <= before {
                (x, sum, moved) = (trial, after, true);
                damping = (damping / 10.0).max(1e-9);
                break;
            }
            damping *= 10.0;
        }
        last = matrix;
        // A tenth of a unit of the sum is far below what anything is decided by.
        if !moved || before - sum < 0.1 + 1e-3 * sum {
            break;
        }
    }
    Minimum { sum, x, matrix: last }
}

/// `J'J + P` and `J'r + P (x - mean)`, the priors' precisions `P` on the diagonal.
fn normal_equations(x: &[f64], priors: &[(f64, f64)], parts: &[Part]) -> (Vec<f64>, Vec<f64>) {
    let n = x.len();
    let mut matrix = vec![0.0; n * n];
    let mut gradient = vec![0.0; n];
    for (i, (mean, sd)) in priors.iter().enumerate() {
        matrix[i * n + i] = sd.powi(-2);
        gradient[i] = (x[i] - mean) * sd.powi(-2);
    }
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for part in parts {
        for (i, slope) in &part.slopes {
            gradient[*i] += dot(slope, &part.residuals);
            for (j, other) in &part.slopes {
                matrix[i * n + j] += dot(slope, other);
            }
        }
    }
    (matrix, gradient)
}

/// Solves `(A + damping diag A) d = g` by Cholesky's factor; none if that is not positive.
pub(crate) fn solve(matrix: &[f64], gradient: &[f64], damping: f64) -> Option<Vec<f64>> {
    let n = gradient.len();
    let mut lower = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let mut value = matrix[i * n + j] * if i == j { 1.0 + damping } else { 1.0 };
            value -= (0..j).map(|k| lower[i * n + k] * lower[j * n + k]).sum::<f64>();
            if i == j {
                if value <= 0.0 {
                    return None;
                }
                lower[i * n + i] = value.sqrt();
            } else {
                lower[i * n + j] = value / lower[j * n + j];
            }
        }
    }
    let mut y = gradient.to_vec();
    for i in 0..n {
        let known: f64 = (0..i).map(|k| lower[i * n + k] * y[k]).sum();
        y[i] = (y[i] - known) / lower[i * n + i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| lower[k * n + i] * y[k]).sum();
        y[i] = (y[i] - known) / lower[i * n + i];
    }
    Some(y)
}
