//! Damping against Froude number: the law (4.3) over the runs of one condition.
//!
//! Runs of one Froude number differ by more than their own intervals (the paper's by 50 to 100
//! times), so the scatter from run to run is an unknown of the law, with the scale-free prior that
//! makes the intervals Student's when it dominates.

use faer::Mat;
use faer::linalg::solvers::{DenseSolveCore, Solve};
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use super::estimate::Estimate;
use super::identification::FroudeLaw;
use super::mixture::{self, Component};

/// What one run brings to the law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Froude number [-].
    pub froude: f64,
    /// Linear damping `b1` [1/s].
    pub b1_per_s: Estimate,
    /// Cubic damping `b3` [s].
    pub b3_s: Estimate,
}

/// One node of the scatter: what the coefficients are, given it.
struct Node {
    weight: f64,
    scatter: f64,
    mean: Vec<f64>,
    covariance: Mat<f64>,
}

/// Number of nodes of the scatter, evenly spaced in its logarithm.
const N_NODES: usize = 80;

/// Froude numbers at which the band is given.
const N_FROUDE: u32 = 21;

/// The law over the runs of `condition`; none unless there are three runs or more at two Froude
/// numbers or more.
pub fn froude_law(condition: &str, points: &[Point]) -> Option<FroudeLaw> {
    let distinct = points.iter().any(|p| (p.froude - points[0].froude).abs() > 1e-3);
    if points.len() < 3 || !distinct {
        return None;
    }
    let linear: Vec<(f64, f64)> = points.iter().map(|p| (p.b1_per_s.mean, p.b1_per_s.sd)).collect();
    let rows: Vec<Vec<f64>> = points.iter().map(|p| vec![1.0, p.froude.powi(2)]).collect();
    let nodes = nodes(&rows, &linear);
    let largest = points.iter().map(|p| p.froude.abs()).fold(0.0, f64::max);
    let froude: Vec<f64> =
        (0..N_FROUDE).map(|i| largest * f64::from(i) / f64::from(N_FROUDE - 1)).collect();
    let cubic: Vec<(f64, f64)> = points.iter().map(|p| (p.b3_s.mean, p.b3_s.sd)).collect();
    let cubic_nodes = self::nodes(&vec![vec![1.0]; points.len()], &cubic);
    Some(FroudeLaw {
        condition: condition.to_owned(),
        b0_per_s: combination(&nodes, &[1.0, 0.0]),
        kappa: kappa(&nodes),
        b3_s: combination(&cubic_nodes, &[1.0]),
        scatter_per_s: mixture::estimate(
            &nodes
                .iter()
                .map(|n| Component { weight: n.weight, mean: n.scatter, sd: 0.0 })
                .collect::<Vec<_>>(),
        ),
        b1_per_s: froude.iter().map(|fr| combination(&nodes, &[1.0, fr * fr])).collect(),
        froude,
    })
}

/// Estimate of a linear combination of the coefficients.
fn combination(nodes: &[Node], weights: &[f64]) -> Estimate {
    let component = |node: &Node| Component {
        weight: node.weight,
        mean: node.mean.iter().zip(weights).map(|(m, w)| m * w).sum(),
        sd: quadratic(&node.covariance, weights).sqrt(),
    };
    mixture::estimate(&nodes.iter().map(component).collect::<Vec<_>>())
}

/// Estimate of the ratio of the slope to `b0`.
///
/// A ratio has no moments when its denominator may be nil: mean and standard deviation are those of
/// its central 90 %.
fn kappa(nodes: &[Node]) -> Estimate {
    const N_LEVELS: u32 = 18;
    let below = |kappa: f64| below(nodes, kappa);
    let quantile = |level: f64| {
        let (mut low, mut high) = (-1.0, 1.0);
        while below(high) < level && high < 1e9 {
            high *= 2.0;
        }
        while below(low) > level && low > -1e9 {
            low *= 2.0;
        }
        // Each halving gains one bit of the bracket.
        for _ in 0..45 {
            let middle = 0.5 * (low + high);
            if below(middle) < level { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    };
    let levels: Vec<f64> = (0..N_LEVELS)
        .map(|i| quantile(0.05 + 0.9 * (f64::from(i) + 0.5) / f64::from(N_LEVELS)))
        .collect();
    let mean = levels.iter().sum::<f64>() / f64::from(N_LEVELS);
    let square = levels.iter().map(|q| (q - mean).powi(2)).sum::<f64>();
    let sd = (square / f64::from(N_LEVELS)).sqrt();
    Estimate { mean, sd, lo95: quantile(0.025), hi95: quantile(0.975) }
}

/// Probability that the ratio lies below `kappa`.
fn below(nodes: &[Node], kappa: f64) -> f64 {
    let unit = Normal::standard();
    // It does where slope - kappa b0 is negative, b0 being positive.
    nodes
        .iter()
        .map(|node| {
            let mean = node.mean[1] - kappa * node.mean[0];
            let sd = quadratic(&node.covariance, &[-kappa, 1.0]).sqrt();
            node.weight * unit.cdf(-mean / sd)
        })
        .sum()
}

/// Posterior probability that the speed coefficient over these runs lies below `kappa` [-].
pub fn probability_below(points: &[Point], kappa: f64) -> f64 {
    let linear: Vec<(f64, f64)> = points.iter().map(|p| (p.b1_per_s.mean, p.b1_per_s.sd)).collect();
    let rows: Vec<Vec<f64>> = points.iter().map(|p| vec![1.0, p.froude.powi(2)]).collect();
    below(&nodes(&rows, &linear), kappa)
}

fn quadratic(matrix: &Mat<f64>, x: &[f64]) -> f64 {
    let mut sum = 0.0;
    for i in 0..x.len() {
        for j in 0..x.len() {
            sum += x[i] * matrix[(i, j)] * x[j];
        }
    }
    sum.max(0.0)
}

/// Posterior of `y_i = x_i c + scatter + noise_i`, node by node of the scatter.
fn nodes(rows: &[Vec<f64>], values: &[(f64, f64)]) -> Vec<Node> {
    let n = rows.len();
    let (p, freedom) = (rows[0].len(), n - rows[0].len());
    let size = typical(values);
    let noise = values.iter().map(|v| v.1).sum::<f64>() / n as f64;
    // Below a tenth of the runs' own noise a scatter changes nothing; above the Student tail of the
    // fewest degrees of freedom nothing is left.
    let tail = StudentsT::new(0.0, 1.0, freedom as f64).map_or(100.0, |t| t.inverse_cdf(0.9999));
    let low = (0.1 * noise).max(1e-6 * size).ln();
    let high = (size * tail.min(1e3)).ln();
    let mut nodes: Vec<Node> = (0..N_NODES)
        .map(|i| {
            let scatter = (low + (high - low) * i as f64 / (N_NODES - 1) as f64).exp();
            node(rows, values, scatter, p)
        })
        .collect();
    let top = nodes.iter().map(|n| n.weight).fold(f64::NEG_INFINITY, f64::max);
    let total: f64 = nodes.iter().map(|n| (n.weight - top).exp()).sum();
    for node in &mut nodes {
        node.weight = (node.weight - top).exp() / total;
    }
    nodes.retain(|n| n.weight > 1e-9);
    nodes
}

/// Spread of the values, or their size when they are all alike.
fn typical(values: &[(f64, f64)]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().map(|v| v.0).sum::<f64>() / n;
    let spread = (values.iter().map(|v| (v.0 - mean).powi(2)).sum::<f64>() / n).sqrt();
    spread.max(1e-3 * mean.abs()).max(f64::MIN_POSITIVE)
}

fn node(rows: &[Vec<f64>], values: &[(f64, f64)], scatter: f64, p: usize) -> Node {
    let mut normal = Mat::<f64>::zeros(p, p);
    let mut right = Mat::<f64>::zeros(p, 1);
    let mut weight = 0.0;
    for (row, (value, sd)) in rows.iter().zip(values) {
        let variance = scatter.powi(2) + sd.powi(2);
        weight -= 0.5 * variance.ln();
        for i in 0..p {
            right[(i, 0)] += row[i] * value / variance;
            for j in 0..p {
                normal[(i, j)] += row[i] * row[j] / variance;
            }
        }
    }
    let factor = normal.partial_piv_lu();
    let mean = factor.solve(&right);
    let covariance = factor.inverse();
    for (row, (value, sd)) in rows.iter().zip(values) {
        let fitted: f64 = (0..p).map(|i| row[i] * mean[(i, 0)]).sum();
        weight -= 0.5 * (value - fitted).powi(2) / (scatter.powi(2) + sd.powi(2));
    }
    weight -= 0.5 * normal.determinant().ln();
    Node { weight, scatter, mean: (0..p).map(|i| mean[(i, 0)]).collect(), covariance }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(mean: f64) -> Estimate {
        Estimate::normal(mean, 1e-4)
    }

    #[test]
    fn runs_on_the_law_give_its_coefficients_back() {
        let points: Vec<Point> = [0.0, 0.1, 0.2, 0.3, 0.4]
            .map(|fr| Point {
                froude: fr,
                b1_per_s: exact(0.4 * (1.0 + 12.0 * fr * fr)),
                b3_s: exact(0.14),
            })
            .to_vec();
        let law = froude_law("bare hull", &points).expect("five runs");
        assert!((law.b0_per_s.mean - 0.4).abs() < 1e-3, "{:?}", law.b0_per_s);
        assert!((law.kappa.mean - 12.0).abs() < 0.05, "{:?}", law.kappa);
        assert!(law.kappa.covers(12.0) && law.b0_per_s.covers(0.4) && law.b3_s.covers(0.14));
    }

    #[test]
    fn scatter_alone_gives_the_interval_of_student() {
        // Five values of one Froude number pair: the mean's interval must be t with n - p freedom.
        let values = [(0.0, 0.30), (0.0, 0.42), (0.0, 0.36), (0.4, 0.9), (0.4, 1.1), (0.4, 1.0)];
        let points: Vec<Point> = values
            .map(|(froude, b1)| Point {
                froude,
                b1_per_s: Estimate::normal(b1, 1e-6),
                b3_s: exact(0.1),
            })
            .to_vec();
        let law = froude_law("bare hull", &points).expect("six runs");
        // Least squares: residual sum of squares 0.0072 + 0.02 with four degrees of freedom.
        let sd = (0.0272_f64 / 4.0 / 3.0).sqrt();
        let half = 2.776_445 * sd;
        assert!((law.b0_per_s.hi95 - law.b0_per_s.lo95 - 2.0 * half).abs() < 0.02 * half);
    }

    #[test]
    fn one_froude_number_gives_no_law() {
        let point = Point { froude: 0.2, b1_per_s: exact(0.4), b3_s: exact(0.1) };
        assert!(froude_law("bare hull", &[point; 4]).is_none());
    }
}
