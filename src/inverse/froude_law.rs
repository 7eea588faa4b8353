//! Damping against Froude number: the law (4.3) over the runs of one condition.

use statrs::distribution::{ContinuousCDF, Normal};

use super::estimate::Estimate;
use super::identification::FroudeLaw;
use super::mixture::{self, Component};
use super::scattered::{Node, combination, nodes, quadratic};

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
    let linear_nodes = nodes(&rows, &linear);
    let largest = points.iter().map(|p| p.froude.abs()).fold(0.0, f64::max);
    let froude: Vec<f64> =
        (0..N_FROUDE).map(|i| largest * f64::from(i) / f64::from(N_FROUDE - 1)).collect();
    let cubic: Vec<(f64, f64)> = points.iter().map(|p| (p.b3_s.mean, p.b3_s.sd)).collect();
    let cubic_nodes = nodes(&vec![vec![1.0]; points.len()], &cubic);
    Some(FroudeLaw {
        condition: condition.to_owned(),
        b0_per_s: combination(&linear_nodes, &[1.0, 0.0]),
        kappa: kappa(&linear_nodes),
        b3_s: combination(&cubic_nodes, &[1.0]),
        scatter_per_s: mixture::estimate(
            &linear_nodes
                .iter()
                .map(|n| Component { weight: n.weight, mean: n.scatter, sd: 0.0 })
                .collect::<Vec<_>>(),
        ),
        b1_per_s: froude.iter().map(|fr| combination(&linear_nodes, &[1.0, fr * fr])).collect(),
        froude,
    })
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
