//! The paper's own route from the observable to the damping law: chains, scatter, plain fit.

use super::identification::{Chain, DampingFit, MomentHistory};
use super::paper::{ChainSettings, Convolution, Hyperpriors, plain_fit, sample};
use super::record::Record;

/// Samples of a record that the chains see: as many as the paper's runs have, more where a period
/// would have fewer than twenty, for its impulses (2.6) need them close.
pub(super) fn n_samples_max(record: &Record) -> usize {
    const LIKE_THE_PAPER: usize = 500;
    /// Beyond this the single-site sampler takes minutes and does not converge.
    const TOO_MANY: usize = 2000;
    let n_periods = record.span_s() * record.rough_frequency_rad_s / std::f64::consts::TAU;
    ((20.0 * n_periods) as usize).clamp(LIKE_THE_PAPER, TOO_MANY)
}

/// What the chains say.
pub(super) struct Drawn {
    pub(super) moment: MomentHistory,
    pub(super) damping: DampingFit,
    pub(super) chain: Chain,
    pub(super) remarks: Vec<String>,
}

/// Draws the posterior of the moment and fits the law to its mean, point by point (Sec. 4.1).
///
/// `smoothed` supplies the motion, which the paper takes from the record.
pub(super) fn draw(
    record: &Record,
    convolution: &Convolution,
    g: &[f64],
    smoothed: &MomentHistory,
    seed: u64,
) -> Result<Drawn, String> {
    let result = sample(g, convolution, &Hyperpriors::PAPER, &ChainSettings::paper(seed))
        .map_err(|error| error.to_string())?;
    let time_s: Vec<f64> = record.time_s.iter().map(|t| record.origin_s + t).collect();
    let at = |values: &[f64]| -> Vec<f64> {
        time_s.iter().map(|&t| interpolated(&smoothed.time_s, values, t)).collect()
    };
    let moment = MomentHistory {
        roll_rad: at(&smoothed.roll_rad),
        roll_rate_rad_per_s: at(&smoothed.roll_rate_rad_per_s),
        mean_per_s2: result.mean,
        sd_per_s2: result.sd,
        lo95_per_s2: result.lo95,
        hi95_per_s2: result.hi95,
        observable_rad: g.to_vec(),
        time_s,
    };
    let damping = plain_fit(&moment.roll_rate_rad_per_s, &moment.mean_per_s2);
    let chain = result.chain;
    let mut remarks = vec![
        "hyperpriors as printed (all 0.1) are not scale free: sigma and the band follow the \
         prior, not the record; b1 and b3 are a plain fit of the scatter, as in the paper, and \
         their intervals are not calibrated"
            .to_owned(),
    ];
    if !chain.converged {
        remarks.push(format!("not converged: split R-hat {:.3}, limit 1.05", chain.r_hat_max));
    }
    Ok(Drawn { moment, damping, chain, remarks })
}

fn interpolated(time_s: &[f64], values: &[f64], at_s: f64) -> f64 {
    let after = time_s.partition_point(|t| *t < at_s).clamp(1, time_s.len() - 1);
    let share = (at_s - time_s[after - 1]) / (time_s[after] - time_s[after - 1]);
    values[after - 1] + share.clamp(0.0, 1.0) * (values[after] - values[after - 1])
}
