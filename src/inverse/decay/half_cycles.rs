//! Energy lost from peak to peak, without any law of damping.

use super::moment::MotionPosterior;
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::HalfCycle;

/// A peak of the smoothed roll about its zero.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Peak {
    /// The sample after it.
    sample: usize,
    /// Where it stands between the sample before and that one [-].
    share: f64,
    time_s: f64,
    amplitude_rad: f64,
    sd_rad: f64,
}

/// What turns roll into potential energy per unit inertia.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Restoring {
    /// Natural frequency `w` [rad/s].
    pub natural_frequency_rad_s: f64,
    /// Cubic part `k3` [1/rad2].
    pub cubic_per_rad2: f64,
}

impl Restoring {
    /// Potential energy `w^2 (A^2/2 + k3 A^4/4)` [1/s2] and its slope at amplitude `A` [rad].
    fn potential(&self, amplitude_rad: f64) -> (f64, f64) {
        let (square, k3) = (amplitude_rad.powi(2), self.cubic_per_rad2);
        let w2 = self.natural_frequency_rad_s.powi(2);
        (w2 * (0.5 * square + 0.25 * k3 * square.powi(2)), w2 * amplitude_rad * (1.0 + k3 * square))
    }
}

/// The half cycles of a decay, in order of time.
///
/// From peak to peak `int b phi' dt = V(A_k) - V(A_k+1)`, so the equivalent damping is that loss
/// over `int phi'^2 dt`, and its uncertainty that of the two peaks.
pub fn half_cycles(
    origin_s: f64,
    time_s: &[f64],
    motion: &MotionPosterior,
    restoring: &Restoring,
) -> Vec<HalfCycle> {
    let peaks = peaks(time_s, motion, restoring);
    peaks
        .windows(2)
        .filter(|pair| pair[0].amplitude_rad * pair[1].amplitude_rad < 0.0)
        .map(|pair| {
            let (first, last) = (&pair[0], &pair[1]);
            let balance = balance(time_s, motion, restoring, first, last);
            let span_s = last.time_s - first.time_s;
            HalfCycle {
                time_s: origin_s + 0.5 * (first.time_s + last.time_s),
                amplitude_rad: 0.5 * (first.amplitude_rad.abs() + last.amplitude_rad.abs()),
                frequency_rad_s: std::f64::consts::PI / span_s,
                equivalent_damping_per_s: balance,
            }
        })
        .collect()
}

/// Half cycles near an amplitude: theirs over it.
pub const NEAR: [f64; 2] = [0.8, 1.25];

/// Equivalent damping near one amplitude: the energy lost between the peaks that enclose it by a
/// quarter, moved to the amplitude with the slope `b3_s` [s] of the fitted law.
pub fn local_damping(half_cycles: &[HalfCycle], amplitude_rad: f64, b3_s: f64) -> Option<Estimate> {
    let near: Vec<&HalfCycle> = half_cycles
        .iter()
        .filter(|h| (NEAR[0]..=NEAR[1]).contains(&(h.amplitude_rad / amplitude_rad)))
        .collect();
    let reached = near.iter().any(|h| h.amplitude_rad >= amplitude_rad)
        && near.iter().any(|h| h.amplitude_rad <= amplitude_rad);
    if !reached {
        return None;
    }
    // Half cycles share peaks, so their errors alternate and their energies, not their ratios, add:
    // the weight of each is its kinetic share, proportional to A^2.
    let total: f64 = near.iter().map(|h| h.amplitude_rad.powi(2)).sum();
    let share = |h: &HalfCycle| h.amplitude_rad.powi(2) / total;
    let moved = |h: &HalfCycle| {
        let weight = crate::roll::damping::cubic_weight;
        h.equivalent_damping_per_s.mean
            + b3_s
                * (weight(h.frequency_rad_s, amplitude_rad)
                    - weight(h.frequency_rad_s, h.amplitude_rad))
    };
    let mean: f64 = near.iter().map(|h| share(h) * moved(h)).sum();
    // Only the outer peaks' errors survive the sum, half of the two outer half cycles' variances;
    // the scatter of the half cycles about their mean is added, for it is larger on real records.
    let (first, last) = (near[0], near[near.len() - 1]);
    let outer = [first, last]
        .iter()
        .map(|h| 0.5 * (share(h) * h.equivalent_damping_per_s.sd).powi(2))
        .sum::<f64>();
    let scatter = if near.len() > 2 {
        let spread: f64 = near.iter().map(|h| share(h) * (moved(h) - mean).powi(2)).sum();
        let noise: f64 =
            near.iter().map(|h| share(h) * h.equivalent_damping_per_s.sd.powi(2)).sum();
        (spread - noise).max(0.0) / (near.len() - 1) as f64
    } else {
        0.0
    };
    Some(Estimate::normal(mean, (outer + scatter).sqrt()))
}

fn peaks(time_s: &[f64], motion: &MotionPosterior, restoring: &Restoring) -> Vec<Peak> {
    let mut peaks: Vec<Peak> = Vec::new();
    for i in 1..time_s.len() {
        let (before, after) = (motion.mean[i - 1][1], motion.mean[i][1]);
        if before * after > 0.0 || (before - after).abs() < f64::MIN_POSITIVE {
            continue;
        }
        let swing = Swing::new(time_s, motion, restoring, i);
        let share = swing.turning_share();
        let peak = Peak {
            sample: i,
            share,
            time_s: time_s[i - 1] + share * swing.width_s,
            amplitude_rad: swing.roll_rad(share),
            sd_rad: motion.sd[i - 1][0] + share * (motion.sd[i][0] - motion.sd[i - 1][0]),
        };
        // A wiggle on one side of the zero is not a new peak; the larger one stands.
        match peaks.last_mut() {
            Some(last) if last.amplitude_rad * peak.amplitude_rad > 0.0 => {
                if peak.amplitude_rad.abs() > last.amplitude_rad.abs() {
                    *last = peak;
                }
            }
            _ => peaks.push(peak),
        }
    }
    peaks.retain(|p| p.amplitude_rad.abs() > 4.0 * p.sd_rad);
    peaks
}

fn balance(
    time_s: &[f64],
    motion: &MotionPosterior,
    restoring: &Restoring,
    first: &Peak,
    last: &Peak,
) -> Estimate {
    let mut kinetic = 0.0;
    for i in first.sample..=last.sample {
        let from = if i == first.sample { first.share } else { 0.0 };
        let to = if i == last.sample { last.share } else { 1.0 };
        kinetic += Swing::new(time_s, motion, restoring, i).squared_rate(from, to);
    }
    let (start, start_slope) = restoring.potential(first.amplitude_rad.abs());
    let (end, end_slope) = restoring.potential(last.amplitude_rad.abs());
    let sd = (start_slope * first.sd_rad).hypot(end_slope * last.sd_rad);
    Estimate::normal((start - end) / kinetic, sd / kinetic)
}

/// The motion from one sample to the next: the rate a cubic through its values and slopes.
struct Swing {
    width_s: f64,
    roll_rad: f64,
    /// Coefficients of the rate [rad/s] over the share of the interval, the constant first.
    rate: [f64; 4],
}

impl Swing {
    /// The motion that leads to sample `to`.
    fn new(time_s: &[f64], motion: &MotionPosterior, restoring: &Restoring, to: usize) -> Self {
        let width_s = time_s[to] - time_s[to - 1];
        let w2 = restoring.natural_frequency_rad_s.powi(2);
        let slope = |i: usize| width_s * (motion.mean[i][2] - w2 * motion.mean[i][0]);
        let (start, end) = (motion.mean[to - 1][1], motion.mean[to][1]);
        let (leaving, arriving) = (slope(to - 1), slope(to));
        let rise = end - start;
        let rate = [
            start,
            leaving,
            3.0 * rise - 2.0 * leaving - arriving,
            leaving + arriving - 2.0 * rise,
        ];
        Self { width_s, roll_rad: motion.mean[to - 1][0], rate }
    }

    fn rate_rad_per_s(&self, share: f64) -> f64 {
        self.rate.iter().rev().fold(0.0, |sum, c| sum * share + c)
    }

    fn roll_rad(&self, share: f64) -> f64 {
        let terms = self.rate.iter().zip(1..).map(|(c, n)| c * share.powi(n) / f64::from(n));
        self.roll_rad + self.width_s * terms.sum::<f64>()
    }

    /// Where the rate changes its sign.
    fn turning_share(&self) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        let start = self.rate[0];
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if self.rate_rad_per_s(middle) * start > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Integral of the squared rate [rad2/s] between two shares of the interval.
    fn squared_rate(&self, from: f64, to: f64) -> f64 {
        // Gauss's rule of four points is exact for the square of a cubic.
        const NODES: [(f64, f64); 4] = [
            (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
            (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
            (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
            (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
        ];
        let sum: f64 = NODES
            .iter()
            .map(|(node, weight)| weight * self.rate_rad_per_s(from + node * (to - from)).powi(2))
            .sum();
        sum * (to - from) * self.width_s
    }
}
