//! Posteriors that are weighted sums of normal posteriors, one for each node of a quadrature.

use statrs::distribution::{ContinuousCDF, Normal};

use super::estimate::Estimate;

/// One node's contribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Component {
    /// Posterior weight; the weights need not sum to one.
    pub weight: f64,
    /// Mean given the node.
    pub mean: f64,
    /// Standard deviation given the node.
    pub sd: f64,
}

/// Mean, standard deviation and central 95 % interval of a mixture of normals.
pub fn estimate(components: &[Component]) -> Estimate {
    let total: f64 = components.iter().map(|c| c.weight).sum();
    let mean = components.iter().map(|c| c.weight * c.mean).sum::<f64>() / total;
    let variance =
        components.iter().map(|c| c.weight * (c.sd.powi(2) + (c.mean - mean).powi(2))).sum::<f64>()
            / total;
    let sd = variance.sqrt();
    if sd <= 0.0 {
        return Estimate { mean, sd: 0.0, lo95: mean, hi95: mean };
    }
    Estimate { mean, sd, lo95: quantile(components, 0.025), hi95: quantile(components, 0.975) }
}

/// The value below which the mixture has probability `level`.
pub fn quantile(components: &[Component], level: f64) -> f64 {
    let total: f64 = components.iter().map(|c| c.weight).sum();
    let reach = |sign: f64| components.iter().map(move |c| c.mean + sign * 9.0 * c.sd);
    let mut low = reach(-1.0).fold(f64::INFINITY, f64::min);
    let mut high = reach(1.0).fold(f64::NEG_INFINITY, f64::max);
    let mean = components.iter().map(|c| c.weight * c.mean).sum::<f64>() / total;
    let spread = |c: &Component| c.weight * (c.sd.powi(2) + (c.mean - mean).powi(2));
    let sd = (components.iter().map(spread).sum::<f64>() / total).sqrt();
    let mut x = mean + sd * Normal::standard().inverse_cdf(level);
    // Newton's steps where they stay inside the bracket, halvings where they do not.
    for _ in 0..60 {
        let (below, density) = probability_below(components, total, x);
        *(if below < level { &mut low } else { &mut high }) = x;
        let step = (below - level) / density;
        let next = x - step;
        let safe = if next > low && next < high { next } else { 0.5 * (low + high) };
        if (safe - x).abs() < 1e-7 * sd {
            return safe;
        }
        x = safe;
    }
    x
}

/// Probability that the mixture lies below `x`, and its density there.
fn probability_below(components: &[Component], total: f64, x: f64) -> (f64, f64) {
    let unit = Normal::standard();
    let (mut below, mut density) = (0.0, 0.0);
    for c in components {
        if c.sd > 0.0 {
            let z = (x - c.mean) / c.sd;
            below += c.weight * unit.cdf(z);
            density += c.weight * (-0.5 * z * z).exp() / (c.sd * std::f64::consts::TAU.sqrt());
        } else {
            below += c.weight * f64::from(u8::from(x >= c.mean));
        }
    }
    (below / total, density / total)
}

/// Probability that the mixture lies below `x`.
pub fn cdf(components: &[Component], x: f64) -> f64 {
    probability_below(components, components.iter().map(|c| c.weight).sum(), x).0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_component_gives_its_own_interval() {
        let one = estimate(&[Component { weight: 0.3, mean: 2.0, sd: 0.5 }]);
        let normal = Estimate::normal(2.0, 0.5);
        assert!((one.lo95 - normal.lo95).abs() < 1e-9 && (one.hi95 - normal.hi95).abs() < 1e-9);
    }

    #[test]
    fn two_far_components_keep_both_in_the_interval() {
        let far = estimate(&[
            Component { weight: 1.0, mean: 0.0, sd: 0.1 },
            Component { weight: 1.0, mean: 10.0, sd: 0.1 },
        ]);
        assert!(far.covers(0.0) && far.covers(10.0) && (far.mean - 5.0).abs() < 1e-12);
    }
}
