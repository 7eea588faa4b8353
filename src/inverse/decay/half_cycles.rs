//! Energy lost from peak to peak, without any law of damping.

use crate::inverse::estimate::Estimate;
use crate::inverse::identification::HalfCycle;
use crate::inverse::state_space::posterior::StatePosterior;

/// A peak of the smoothed roll about its zero.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Peak {
    sample: usize,
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
    /// Roll at rest [rad].
    pub zero_rad: f64,
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
    states: &StatePosterior,
    restoring: &Restoring,
) -> Vec<HalfCycle> {
    let peaks = peaks(time_s, states, restoring);
    peaks
        .windows(2)
        .filter(|pair| pair[0].amplitude_rad * pair[1].amplitude_rad < 0.0)
        .map(|pair| {
            let (first, last) = (&pair[0], &pair[1]);
            let balance = balance(time_s, states, restoring, first, last);
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

/// Equivalent damping near one amplitude: the energy lost between the peaks that enclose it by a
/// quarter, moved to the amplitude with the slope `b3_s` [s] of the fitted law.
pub fn local_damping(half_cycles: &[HalfCycle], amplitude_rad: f64, b3_s: f64) -> Option<Estimate> {
    let near: Vec<&HalfCycle> = half_cycles
        .iter()
        .filter(|h| (0.8..=1.25).contains(&(h.amplitude_rad / amplitude_rad)))
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

fn peaks(time_s: &[f64], states: &StatePosterior, restoring: &Restoring) -> Vec<Peak> {
    let (frequency_rad_s, zero_rad) = (restoring.natural_frequency_rad_s, restoring.zero_rad);
    let mut peaks: Vec<Peak> = Vec::new();
    for i in 1..time_s.len() {
        let (before, after) = (states.mean[i - 1][1], states.mean[i][1]);
        if before * after > 0.0 || (before - after).abs() < f64::MIN_POSITIVE {
            continue;
        }
        let share = before / (before - after);
        let between = |a: f64, b: f64| a + share * (b - a);
        // The rate falls evenly to zero on the way to the peak.
        let tau = frequency_rad_s * (time_s[i] - time_s[i - 1]);
        let roll = states.mean[i - 1][0] + 0.5 * before * share * tau;
        let sd = between(states.sd[i - 1][0], states.sd[i][0]);
        let peak = Peak {
            sample: i,
            time_s: between(time_s[i - 1], time_s[i]),
            amplitude_rad: roll - zero_rad,
            sd_rad: sd,
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
    states: &StatePosterior,
    restoring: &Restoring,
    first: &Peak,
    last: &Peak,
) -> Estimate {
    let w2 = restoring.natural_frequency_rad_s.powi(2);
    let rate2 = |i: usize| w2 * states.mean[i][1].powi(2);
    // The rate is zero at both peaks, so the cut intervals beside them are triangles.
    let mut kinetic = 0.0;
    let inner = first.sample..last.sample;
    for i in inner.clone().skip(1) {
        kinetic += 0.5 * (rate2(i - 1) + rate2(i)) * (time_s[i] - time_s[i - 1]);
    }
    kinetic += rate2(first.sample) * (time_s[first.sample] - first.time_s) / 3.0;
    kinetic += rate2(last.sample - 1) * (last.time_s - time_s[last.sample - 1]) / 3.0;
    let (start, start_slope) = restoring.potential(first.amplitude_rad.abs());
    let (end, end_slope) = restoring.potential(last.amplitude_rad.abs());
    let sd = (start_slope * first.sd_rad).hypot(end_slope * last.sd_rad);
    Estimate::normal((start - end) / kinetic, sd / kinetic)
}
