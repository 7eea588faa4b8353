//! One decay, from its samples to everything that they say.

use super::Setting;
use super::decay_fit::{self, B1, B3, DecayPosterior, K3, N_UNKNOWNS, OFFSET};
use super::estimate::Estimate;
use super::half_cycles::{self, Restoring};
use super::identification::{
    DampingFit, EquivalentDamping, HalfCycle, Identification, Method, MomentHistory, Resimulation,
};
use super::law_misfit;
use super::mixture;
use super::moment_history::{Reference, state_posterior};
use super::paper::{Convolution, least_squares};
use super::paper_method;
use super::record::Record;
use crate::roll::damping::cubic_weight;
use crate::roll::equation::Decay;
use crate::run::{Run, RunKind};

/// Amplitudes [deg] at which equivalent damping is reported, where the run comes near them.
pub(super) const AMPLITUDES_DEG: [f64; 11] =
    [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0];

/// Identifies a decay.
pub(super) fn identify(run: &Run, setting: &Setting) -> Result<Identification, String> {
    let record = Record::new(&run.roll)?;
    let (start, offset_rad) = first_guess(&record, run);
    let fit = decay_fit::fit(&record, start, offset_rad)?;
    let unknown = |position| mixture::estimate(&fit.unknown(position));
    let frequency = unknown(2);
    let zero = unknown(OFFSET);
    let tau = record.scaled_time(frequency.mean);
    let ordered = state_posterior(&tau, &record.roll_rad, 0.0);
    let restoring = Restoring {
        natural_frequency_rad_s: frequency.mean,
        cubic_per_rad2: unknown(K3).mean,
        zero_rad: zero.mean,
    };
    let cycles =
        half_cycles::half_cycles(record.origin_s, &record.time_s, &ordered.states, &restoring);
    if cycles.len() < 3 {
        return Err(format!("{} half cycles stand clear of the noise, 3 are needed", cycles.len()));
    }
    let law = Law::new(&fit, &cycles);
    let reference = Reference {
        natural_frequency_rad_s: frequency.mean,
        natural_frequency_sd_rad_s: frequency.sd,
        zero_rad: zero.mean,
        zero_sd_rad: zero.sd,
    };
    let mut moment = MomentHistory::of_decay(&record, &ordered.states, &reference);
    let initial = (unknown(0), unknown(1));
    let observable = |record: &Record| -> Result<(Convolution, Vec<f64>), String> {
        let convolution = Convolution::new(record.roll_rad.len(), record.time_s[1], frequency.mean)
            .map_err(|e| e.to_string())?;
        let roll: Vec<f64> = record.roll_rad.iter().map(|r| r - zero.mean).collect();
        let g = convolution.observable(&roll, initial.0.mean, initial.1.mean, None);
        Ok((convolution, g))
    };
    let mut least_squares_per_s2 = Vec::new();
    if record.is_even() {
        let (convolution, g) = observable(&record)?;
        least_squares_per_s2 = least_squares(&g, &convolution);
        moment.observable_rad = g;
    }
    let mut damping = law.damping();
    let mut chain = None;
    let mut remarks = remarks(&fit, &ordered.order, &law);
    if setting.method == Method::PaperMcmc {
        let short = record.at_most(paper_method::N_SAMPLES_MAX);
        let (convolution, g) = observable(&short)?;
        let drawn = paper_method::draw(&short, &convolution, &g, &moment, setting.seed)?;
        remarks.extend(drawn.remarks);
        (damping, moment, chain) = (drawn.damping, drawn.moment, Some(drawn.chain));
        least_squares_per_s2 = least_squares(&g, &convolution);
    }
    Ok(Identification {
        kind: RunKind::Decay,
        method: setting.method,
        natural_frequency_rad_s: frequency,
        initial_roll_rad: initial.0,
        initial_roll_rate_rad_per_s: initial.1,
        roll_offset_rad: zero,
        roll_noise_rad: Estimate::normal(
            ordered.states.noise_sd_rad,
            ordered.states.noise_sd_rad / (2.0 * record.roll_rad.len() as f64).sqrt(),
        ),
        damping,
        equivalent_damping: equivalent_damping(&law, &cycles, frequency.mean),
        half_cycles: cycles,
        moment,
        resimulation: resimulation(&record, &fit),
        inertia_kg_m2: None,
        forced: None,
        least_squares_per_s2,
        chain,
        remarks,
    })
}

/// A starting point for the fit: zero from the middle of the record, damping from how soon the
/// roll has fallen to a third.
fn first_guess(record: &Record, run: &Run) -> (Decay, f64) {
    let w = record.rough_frequency_rad_s;
    let period_s = std::f64::consts::TAU / w;
    // The last whole periods swing about the zero; the still stretch knows it where there is one.
    let from_s = record.span_s() - (record.span_s() / period_s).floor().clamp(1.0, 4.0) * period_s;
    let tail = record.time_s.iter().zip(&record.roll_rad).filter(|(t, _)| **t >= from_s);
    let (sum, count) = tail.fold((0.0, 0.0), |(sum, count), (_, r)| (sum + r, count + 1.0));
    let zero = run.still.map_or(sum / count, |s| s.roll_rad);
    let zero =
        if (zero - sum / count).abs() > 0.5 * record.scale_rad() { sum / count } else { zero };
    let largest = record
        .time_s
        .iter()
        .zip(&record.roll_rad)
        .filter(|(t, _)| **t <= 1.25 * period_s)
        .map(|(_, r)| (r - zero).abs())
        .fold(0.0, f64::max);
    let last_s = record
        .time_s
        .iter()
        .zip(&record.roll_rad)
        .filter(|(_, r)| (*r - zero).abs() > largest / 3.0)
        .map(|(t, _)| *t)
        .fold(0.25 * period_s, f64::max);
    let equivalent = 2.0 * 3.0_f64.ln() / last_s;
    let decay = Decay {
        initial_roll_rad: record.roll_rad[0] - zero,
        initial_roll_rate_rad_per_s: (record.roll_rad[1] - record.roll_rad[0]) / record.time_s[1],
        natural_frequency_rad_s: w,
        b1_per_s: 0.7 * equivalent,
        b3_s: 0.3 * equivalent / cubic_weight(w, largest),
        restoring_cubic_per_rad2: 0.0,
    };
    (decay, zero)
}

/// The fitted law with what its misfit adds to its covariance.
struct Law<'a> {
    fit: &'a DecayPosterior,
    misfit: [[f64; 2]; 2],
}

impl<'a> Law<'a> {
    fn new(fit: &'a DecayPosterior, cycles: &[HalfCycle]) -> Self {
        let probability: f64 =
            fit.solutions.iter().map(|s| s.weight * s.probability_of_misfit).sum();
        let mean = |position| mixture::estimate(&fit.unknown(position)).mean;
        let misfit = if probability > 0.5 {
            law_misfit::covariance(cycles, mean(B1), mean(B3))
        } else {
            [[0.0; 2]; 2]
        };
        Self { fit, misfit }
    }

    /// Estimate of `a b1 + c b3`.
    fn combination(&self, a: f64, c: f64) -> Estimate {
        let mut weights = [0.0; N_UNKNOWNS];
        (weights[B1], weights[B3]) = (a, c);
        let mut components = self.fit.combination(&weights);
        let m = &self.misfit;
        let added = a * a * m[0][0] + 2.0 * a * c * m[0][1] + c * c * m[1][1];
        for component in &mut components {
            component.sd = (component.sd.powi(2) + added.max(0.0)).sqrt();
        }
        mixture::estimate(&components)
    }

    fn damping(&self) -> DampingFit {
        let (b1_per_s, b3_s) = (self.combination(1.0, 0.0), self.combination(0.0, 1.0));
        // Scaled to unit deviations, the variance of the sum is 2 + 2 correlation.
        let sum = self.combination(b1_per_s.sd.recip(), b3_s.sd.recip());
        let correlation = (0.5 * sum.sd.powi(2) - 1.0).clamp(-1.0, 1.0);
        DampingFit { b1_per_s, b3_s, correlation }
    }
}

fn equivalent_damping(
    law: &Law<'_>,
    cycles: &[HalfCycle],
    frequency_rad_s: f64,
) -> Vec<EquivalentDamping> {
    let smallest = cycles.iter().map(|c| c.amplitude_rad).fold(f64::INFINITY, f64::min);
    let largest = cycles.iter().map(|c| c.amplitude_rad).fold(0.0, f64::max);
    let b3_s = law.combination(0.0, 1.0).mean;
    AMPLITUDES_DEG
        .iter()
        .map(|&amplitude_deg| {
            let amplitude_rad = amplitude_deg.to_radians();
            EquivalentDamping {
                amplitude_deg,
                fitted_per_s: law.combination(1.0, cubic_weight(frequency_rad_s, amplitude_rad)),
                local_per_s: half_cycles::local_damping(cycles, amplitude_rad, b3_s),
                extrapolated: !(smallest..=largest).contains(&amplitude_rad),
            }
        })
        // Five degrees are compared across all runs; others only where the run comes near them.
        .filter(|e| {
            let near = (0.8 * smallest..=1.25 * largest).contains(&e.amplitude_deg.to_radians());
            near || e.amplitude_deg == 5.0
        })
        .collect()
}

/// The run simulated with linear restoring and the fitted law, as in the paper's Fig. 13.
fn resimulation(record: &Record, fit: &DecayPosterior) -> Resimulation {
    let (decay, offset_rad) = fit.linear;
    let simulated_rad: Vec<f64> =
        decay.solve(&record.time_s).iter().map(|m| m.roll_rad + offset_rad).collect();
    let square: f64 =
        simulated_rad.iter().zip(&record.roll_rad).map(|(s, m)| (m - s).powi(2)).sum();
    Resimulation {
        time_s: record.time_s.iter().map(|t| record.origin_s + t).collect(),
        measured_rad: record.roll_rad.clone(),
        rmse_rad: (square / simulated_rad.len() as f64).sqrt(),
        simulated_rad,
    }
}

fn remarks(fit: &DecayPosterior, order: &usize, law: &Law<'_>) -> Vec<String> {
    let mut remarks = vec![format!("the evidence favours a moment prior of order {order}")];
    let cubic = fit.probability_of_cubic_restoring();
    let k3 = mixture::estimate(&fit.unknown(K3));
    let rms_deg = |residual: &[f64]| {
        let square: f64 = residual.iter().map(|r| r * r).sum();
        (square / residual.len() as f64).sqrt().to_degrees()
    };
    if cubic > 0.95 {
        let mut weights = [0.0; N_UNKNOWNS];
        weights[2] = 1.0;
        let small = mixture::estimate(&fit.combination(&weights)).mean;
        let at_ten = small * (1.0 + 0.375 * k3.mean * 10_f64.to_radians().powi(2));
        let best = fit.solutions.iter().find(|s| s.cubic_restoring);
        let left = best.map_or(0.0, |s| rms_deg(&s.residual_rad));
        remarks.push(format!(
            "linear restoring does not capture that the frequency changes with amplitude, from \
             {small:.3} rad/s at small angles to {at_ten:.3} rad/s at 10 deg: a restoring moment \
             K (phi + k3 phi^3) with k3 = {:.2} [{:.2}, {:.2}] 1/rad2 leaves {left:.3} deg rms",
            k3.mean, k3.lo95, k3.hi95
        ));
    }
    let misfit: f64 = fit.solutions.iter().map(|s| s.weight * s.probability_of_misfit).sum();
    if misfit > 0.5 {
        let plain: [[f64; 2]; 2] = law.misfit;
        remarks.push(format!(
            "b1 phi' + b3 phi'^3 leaves more than noise; the half cycles' scatter about it widens \
             the standard deviations of b1 and b3 by {:.4} 1/s and {:.4} s",
            plain[0][0].max(0.0).sqrt(),
            plain[1][1].max(0.0).sqrt()
        ));
    }
    remarks
}
