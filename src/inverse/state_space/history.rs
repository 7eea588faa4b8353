//! From a roll record to the posterior of its moment history, smoothness order by evidence.

use super::posterior::{Hyperprior, MomentProblem, Quadrature, StatePosterior};
use super::transition::IntegratedWiener;
use crate::inverse::identification::MomentHistory;
use crate::inverse::record::Record;

/// A posterior of the state with the order of its prior.
#[derive(Debug, Clone, PartialEq)]
pub struct OrderedPosterior {
    /// Which derivative of the moment is a white noise: 1, 2 or 3.
    pub order: usize,
    /// Roll, rate and moment in scaled time.
    pub states: StatePosterior,
}

/// What turns the state posterior into moments: where the restoring acts from, and how well known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// Natural frequency `w` [rad/s] at which time was scaled.
    pub natural_frequency_rad_s: f64,
    /// Its standard deviation [rad/s].
    pub natural_frequency_sd_rad_s: f64,
    /// Zero offset of the roll channel [rad].
    pub zero_rad: f64,
    /// Its standard deviation [rad].
    pub zero_sd_rad: f64,
}

/// The posterior of the best of three orders, by evidence; `record_rad` holds the roll [rad], less
/// the response to a measured moment where there is one.
///
/// `moment_noise` is the intensity of the measured moment's noise in scaled time, in units of the
/// roll noise.
pub fn state_posterior(tau: &[f64], record_rad: &[f64], moment_noise: f64) -> OrderedPosterior {
    let n = record_rad.len() as f64;
    let roll_scale_rad = (record_rad.iter().map(|r| r * r).sum::<f64>() / n).sqrt();
    let prior = |intensity: f64| IntegratedWiener { intensity, moment_noise };
    let hyperprior = Hyperprior::ScaleFree { roll_scale_rad };
    let problem = |free_components| MomentProblem {
        tau,
        record: record_rad,
        free_components,
        prior,
        hyperprior,
        quadrature: Quadrature::BAND,
    };
    let (first, second, third) =
        (problem(&[0, 1, 2]), problem(&[0, 1, 2, 3]), problem(&[0, 1, 2, 3, 4]));
    let weighed = [
        first.weigh::<3, IntegratedWiener>(),
        second.weigh::<4, IntegratedWiener>(),
        third.weigh::<5, IntegratedWiener>(),
    ];
    let evidence = |order: usize| weighed[order - 1].log_evidence;
    let order = [2, 3].into_iter().fold(1, |a, b| if evidence(b) > evidence(a) { b } else { a });
    // Only the best order is worth running back.
    let states = match (order, weighed) {
        (1, [nodes, _, _]) => first.smooth::<3, IntegratedWiener>(nodes),
        (2, [_, nodes, _]) => second.smooth::<4, IntegratedWiener>(nodes),
        (_, [_, _, nodes]) => third.smooth::<5, IntegratedWiener>(nodes),
    };
    OrderedPosterior { order, states }
}

impl MomentHistory {
    /// The history of a free decay: `U = phi'' + w^2 (phi - zero)`, with the uncertainty that the
    /// natural frequency and the zero add.
    pub fn of_decay(record: &Record, states: &StatePosterior, reference: &Reference) -> Self {
        const Z_975: f64 = 1.959_963_984_540_054;
        let w = reference.natural_frequency_rad_s;
        let mut history = Self {
            time_s: record.time_s.iter().map(|t| record.origin_s + t).collect(),
            ..Self::default()
        };
        for (mean, sd) in states.mean.iter().zip(&states.sd) {
            let roll_rad = mean[0] - reference.zero_rad;
            let moment = w * w * (mean[2] - reference.zero_rad);
            let from_frequency = 2.0 * w * roll_rad * reference.natural_frequency_sd_rad_s;
            let from_zero = w * w * reference.zero_sd_rad;
            let spread = (w * w * sd[2]).hypot(from_frequency).hypot(from_zero);
            history.roll_rad.push(roll_rad);
            history.roll_rate_rad_per_s.push(w * mean[1]);
            history.mean_per_s2.push(moment);
            history.sd_per_s2.push(spread);
            history.lo95_per_s2.push(moment - Z_975 * spread);
            history.hi95_per_s2.push(moment + Z_975 * spread);
        }
        history
    }
}
