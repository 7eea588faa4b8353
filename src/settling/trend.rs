//! The logarithm of the level as a line whose slope wanders, and when it crosses a limit.

use super::ToGo;
use super::window::Level;

/// Scatter of the logarithm from window to window: beats, a sine cut in mid-swing.
const SCATTER: [f64; 6] = [0.02, 0.04, 0.08, 0.16, 0.32, 0.64];
/// Wandering of the slope [1/window] over one window. Waves that die by a tenth a window do not
/// change that by much more; what falls otherwise is told too late rather than wrongly.
const WANDER: [f64; 6] = [0.0005, 0.001, 0.002, 0.004, 0.008, 0.016];
/// Slope before anything is known: a fall to 1/e within a window is a steep one.
const SLOPE_SD: f64 = 0.3;
/// Steps of the forecast to a window, and how far it looks [windows].
const STEPS: usize = 8;
const HORIZON: usize = 200;
/// An upper end above four times the median, or four times this [s], tells nobody when to be back.
const SOON_S: f64 = 10.0;

/// One belief about scatter and wandering: the line as filtered up to the last window.
#[derive(Debug, Clone, Copy)]
struct Node {
    log_weight: f64,
    wander: f64,
    /// Logarithm of the level and its slope [1/window].
    mean: [f64; 2],
    /// Their variances, and the covariance between.
    level_variance: f64,
    slope_variance: f64,
    covariance: f64,
}

/// The beliefs together, weighted by how well each foretold the windows.
#[derive(Debug)]
pub(super) struct Trend {
    nodes: Vec<Node>,
    window_s: f64,
    last_s: f64,
}

impl Trend {
    /// The trend of two levels or more.
    pub(super) fn of(levels: &[Level]) -> Self {
        let (first, last) = (levels[0], levels[levels.len() - 1]);
        let window_s = (last.time_s - first.time_s) / (levels.len() - 1) as f64;
        let both = SCATTER.iter().flat_map(|scatter| WANDER.iter().map(move |w| (*scatter, *w)));
        let mut nodes: Vec<Node> =
            both.map(|(scatter, wander)| filtered(levels, window_s, scatter, wander)).collect();
        let top = nodes.iter().map(|node| node.log_weight).fold(f64::NEG_INFINITY, f64::max);
        let total: f64 = nodes.iter().map(|node| (node.log_weight - top).exp()).sum();
        for node in &mut nodes {
            node.log_weight -= top + total.ln();
        }
        Self { nodes, window_s, last_s: last.time_s }
    }

    /// Slope of the logarithm [1/s].
    pub(super) fn slope_per_s(&self) -> f64 {
        let weighted = self.nodes.iter().map(|node| node.log_weight.exp() * node.mean[1]);
        weighted.sum::<f64>() / self.window_s
    }

    /// When the level falls below `log_limit`, counted from `now_s`; none when that is too unsure.
    pub(super) fn crossing(&self, log_limit: f64, now_s: f64) -> Option<ToGo> {
        let steps = 0..=STEPS * HORIZON;
        let mut ahead = steps.map(|step| step as f64 / STEPS as f64);
        let mut when = |probability: f64| {
            let k = ahead.find(|k| self.below(log_limit, *k) >= probability)?;
            Some((self.last_s + k * self.window_s - now_s).max(0.0))
        };
        // The three come in this order, so that one sweep finds them all.
        let (lo95_s, median_s, hi95_s) = (when(0.025)?, when(0.5)?, when(0.975)?);
        if hi95_s <= 0.0 {
            return Some(ToGo::Calm);
        }
        let told = hi95_s <= 4.0 * median_s.max(SOON_S);
        told.then_some(ToGo::Seconds { median_s, lo95_s, hi95_s })
    }

    /// Probability that the level is below the limit `k` windows ahead.
    fn below(&self, log_limit: f64, k: f64) -> f64 {
        let each = self.nodes.iter().map(|node| {
            let mean = node.mean[0] + k * node.mean[1];
            let wandered = node.wander.powi(2) * k.powi(3) / 3.0;
            let variance =
                node.level_variance + k * (2.0 * node.covariance + k * node.slope_variance);
            let sd = (variance.max(0.0) + wandered).sqrt().max(1e-9);
            node.log_weight.exp() * standard_normal_cdf((log_limit - mean) / sd)
        });
        each.sum()
    }
}

/// The Kalman filter of an integrated random walk over the windows.
fn filtered(levels: &[Level], window_s: f64, scatter: f64, wander: f64) -> Node {
    let mut node = Node {
        log_weight: 0.0,
        wander,
        mean: [levels[0].log(), 0.0],
        level_variance: scatter.powi(2) + levels[0].log_variance(),
        slope_variance: SLOPE_SD.powi(2),
        covariance: 0.0,
    };
    for (before, level) in levels.iter().zip(levels.iter().skip(1)) {
        let k = (level.time_s - before.time_s) / window_s;
        let q = wander.powi(2);
        node.mean[0] += k * node.mean[1];
        node.level_variance += k * (2.0 * node.covariance + k * node.slope_variance);
        node.level_variance += q * k.powi(3) / 3.0;
        node.covariance += k * node.slope_variance + q * k * k / 2.0;
        node.slope_variance += q * k;
        let residual = level.log() - node.mean[0];
        let total = node.level_variance + scatter.powi(2) + level.log_variance();
        node.log_weight -= 0.5 * (total.ln() + residual * residual / total);
        let gain = [node.level_variance / total, node.covariance / total];
        node.mean[0] += gain[0] * residual;
        node.mean[1] += gain[1] * residual;
        node.slope_variance -= gain[1] * node.covariance;
        node.covariance -= gain[0] * node.covariance;
        node.level_variance -= gain[0] * node.level_variance;
    }
    node
}

/// The normal distribution function to 1e-7 (Abramowitz and Stegun 26.2.17).
fn standard_normal_cdf(z: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.231_641_9 * z.abs());
    let polynomial = [1.330_274_429, -1.821_255_978, 1.781_477_937, -0.356_563_782, 0.319_381_53]
        .iter()
        .fold(0.0, |sum, coefficient| (sum + coefficient) * t);
    let tail = (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt() * polynomial;
    if z >= 0.0 { 1.0 - tail } else { tail }
}
