//! The same judgement of the paper's own bands: hyperpriors as printed, plain fit of the scatter.

use statrs::distribution::{ContinuousCDF, Normal};

use super::calibration::AMPLITUDES;
use super::drawn_run::DrawnRun;
use crate::inverse::decay::Solved;
use crate::inverse::estimate::Estimate;
use crate::inverse::froude_law::Point;
use crate::inverse::paper::exact::exact;
use crate::inverse::paper::{Convolution, Hyperpriors, PriorPower, plain_fit};
use crate::inverse::record::Record;
use crate::inverse::state_space::posterior::Quadrature;
use crate::roll::damping::cubic_weight;

/// What the paper says of a run.
pub(super) struct PaperTold {
    /// Probability below the truth of each quantity.
    pub(super) below: Vec<(&'static str, f64)>,
    /// Its coefficients, for the speed law.
    pub(super) point: Point,
}

/// Probabilities below the truth by the paper's posterior (2.13), computed without its chain.
///
/// Frequency, zero and initial state, which the paper takes as known, are the true ones.
pub(super) fn of_run(drawn: &DrawnRun, solved: &Solved, instant: f64) -> Option<PaperTold> {
    let record = evened(&solved.thinned);
    let truth = &drawn.truth;
    let w = truth.natural_frequency_rad_s;
    let step_s = record.time_s[1];
    let convolution = Convolution::new(record.roll_rad.len(), step_s, w).ok()?;
    let fit = &solved.posterior.linearised;
    let zero_rad = fit.point.zero_rad;
    let roll: Vec<f64> = record.roll_rad.iter().map(|r| r - zero_rad).collect();
    let start = &fit.point.decay;
    let g = convolution.observable(
        &roll,
        start.initial_roll_rad,
        start.initial_roll_rate_rad_per_s,
        None,
    );
    let posterior =
        exact(&g, &convolution, &Hyperpriors::PAPER, PriorPower::Printed, Quadrature::BAND);
    let sample = (instant * posterior.mean.len() as f64) as usize;
    let moment = Estimate::normal(posterior.mean[sample], posterior.sd[sample]);
    let rates: Vec<f64> = fit.motion.iter().map(|m| m.roll_rate_rad_per_s).collect();
    let law = plain_fit(&rates, &posterior.mean);
    let time_s = record.origin_s + record.time_s[sample];
    let mut told = vec![("U(t)", below(&moment, drawn.moment_per_s2(time_s)))];
    for (share, name) in AMPLITUDES {
        let amplitude_rad = share * drawn.amplitude_rad;
        let equivalent = law.combination(1.0, cubic_weight(w, amplitude_rad));
        told.push((name, below(&equivalent, drawn.equivalent_per_s(amplitude_rad))));
    }
    told.push(("b1", below(&law.b1_per_s, truth.b1_per_s)));
    told.push(("b3", below(&law.b3_s, truth.b3_s)));
    let point = Point { froude: drawn.froude, b1_per_s: law.b1_per_s, b3_s: law.b3_s };
    Some(PaperTold { below: told, point })
}

/// The record on an even grid, which drawn runs are but for rounding.
fn evened(record: &Record) -> Record {
    let n = record.time_s.len();
    let step_s = record.span_s() / (n - 1) as f64;
    Record { time_s: (0..n).map(|i| step_s * i as f64).collect(), ..record.clone() }
}

fn below(estimate: &Estimate, truth: f64) -> f64 {
    Normal::standard().cdf((truth - estimate.mean) / estimate.sd)
}
