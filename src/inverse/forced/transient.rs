//! A forced run whose excitation does not repeat: swept, irregular, or the model free to answer.
//!
//! The roll that the measured moment makes is fitted to the measured roll. The moment's own noise
//! acts on the way as a noise of the process, so both channels may be noisy, and whether the rod
//! imposes the motion or the model answers a moment makes no difference to the equation.

use super::driven::{B1, B3, Driven, INERTIA, N_DRIVEN, Sensitive};
use super::moment::{Moment, rough_noise};
use super::response::add_square;
use super::skew;
use crate::inverse::Setting;
use crate::inverse::amplitudes::{AMPLITUDES_DEG, is_compared};
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::{
    DampingFit, EquivalentDamping, Identification, Method, MomentHistory, Skew,
};
use crate::inverse::mixture::{self, Component};
use crate::inverse::plausible;
use crate::inverse::record::Record;
use crate::inverse::state_space::damped::Damped;
use crate::inverse::state_space::filter::{Column, Filtered, filter};
use crate::inverse::state_space::triangle::Triangle;
use crate::roll::damping::{cubic_weight, equivalent_per_s};
use crate::run::{Run, RunKind};

/// Samples a period of the record that is fitted.
const SAMPLES_PER_PERIOD: f64 = 40.0;
/// Unknowns: those of the driven model, then the zero offset of the roll channel.
const N: usize = N_DRIVEN + 1;
/// Intensities of a wandering moment that are weighed against none.
const WALKS: [f64; 6] = [0.03, 0.1, 0.3, 1.0, 3.0, 10.0];
/// Prior probability of any of them: the record must show that the law leaves a moment.
const UNLAWFUL: f64 = 0.05;

/// Share of the roll beyond which a fit explains nothing.
const MOST_LEFT: f64 = 0.4;

const LOST: &str = "the roll equation cannot be fitted to the record under its measured moment";

/// The run as it is fitted.
struct Fit<'a> {
    record: &'a Record,
    moment: &'a Moment,
    /// Noise of one value of the record [rad].
    noise_rad: f64,
    /// Standard uncertainty of the time between roll and moment [s].
    skew_sd_s: f64,
}

/// Where the fit stands.
#[derive(Clone, Copy)]
struct Point {
    driven: Driven,
    zero_rad: f64,
}

/// One linearised posterior.
struct Solution {
    log_evidence: f64,
    mean: [f64; N],
    covariance: [[f64; N]; N],
    /// Change of the unknowns by a second by which the moment is late.
    by_s: [f64; N],
    noise_rad: f64,
}

/// Identifies the run.
pub(super) fn identify(run: &Run, setting: &Setting) -> Result<Identification, String> {
    let record = Record::new(&run.roll)?.per_period(SAMPLES_PER_PERIOD);
    let moment = Moment::of(run, setting.exciter.as_ref(), record.origin_s)?;
    let averaged = (record.n_averaged as f64).sqrt();
    let noise_rad = (rough_noise(&run.roll.value) / averaged).max(1e-7 * record.scale_rad());
    let skew_sd_s = skew::sd_s(&run.timing);
    let fit = Fit { record: &record, moment: &moment, noise_rad, skew_sd_s };
    let point = fit.settle(fit.first_guess(run, setting.restoring_n_m_per_rad)?)?;
    let solutions = fit.solutions(&point);
    let unknown = |position: usize| {
        let mut weights = [0.0; N];
        weights[position] = 1.0;
        mixture::estimate(&components(&solutions, &weights))
    };
    let inertia = unknown(INERTIA);
    let natural = (setting.restoring_n_m_per_rad / inertia.mean).sqrt();
    if !(inertia.sd.is_finite() && natural.is_finite()) {
        return Err(LOST.into());
    }
    let motion = point.driven.motion(&moment, &record.time_s);
    let (amplitude_rad, rate) = rms(&motion);
    let swinging_rad_s = rate / amplitude_rad;
    plausible::driven(
        inertia.mean,
        setting.restoring_n_m_per_rad,
        swinging_rad_s,
        &at_amplitude(&solutions, swinging_rad_s, amplitude_rad),
    )?;
    let fitted: Vec<f64> = motion.iter().map(|m| m.roll_rad + point.zero_rad).collect();
    let resimulation = record.resimulation(fitted);
    let left = resimulation.rmse_rad / record.scale_rad();
    if left > MOST_LEFT {
        return Err(format!(
            "the measured moment leaves {:.0} % of the roll unexplained, more than {:.0} % (hint: \
             the units and signs of force and roll, moment_arm_m, gm_m)",
            100.0 * left,
            100.0 * MOST_LEFT
        ));
    }
    let noise = solutions[0].noise_rad * averaged;
    let (weights_b1, weights_b3) = (unknown(B1), unknown(B3));
    let sum = mixture::estimate(&components(&solutions, &{
        let mut weights = [0.0; N];
        (weights[B1], weights[B3]) = (weights_b1.sd.recip(), weights_b3.sd.recip());
        weights
    }));
    let [.., b1_by_per_s2, b3_by, _] = solutions[0].by_s;
    let skew = run.timing.skew_sd_s().map(|sd_s| Skew { sd_s, b1_by_per_s2, b3_by });
    let largest_rad = motion.iter().map(|m| m.roll_rad.abs()).fold(0.0, f64::max);
    Ok(Identification {
        kind: RunKind::Forced,
        method: Method::Exact,
        natural_frequency_rad_s: Estimate::normal(
            natural,
            0.5 * natural * inertia.sd / inertia.mean,
        ),
        initial_roll_rad: unknown(0),
        initial_roll_rate_rad_per_s: unknown(1),
        roll_offset_rad: unknown(N - 1),
        roll_noise_rad: Estimate::normal(noise, noise / (2.0 * motion.len() as f64).sqrt()),
        damping: DampingFit {
            b1_per_s: weights_b1,
            b3_s: weights_b3,
            correlation: (0.5 * sum.sd.powi(2) - 1.0).clamp(-1.0, 1.0),
        },
        equivalent_damping: equivalent_damping(&solutions, swinging_rad_s, largest_rad),
        half_cycles: Vec::new(),
        damping_curve: Vec::new(),
        beliefs: None,
        moment: history(&record, &motion, &solutions),
        resimulation,
        inertia_kg_m2: Some(inertia),
        skew,
        forced: None,
        least_squares_per_s2: Vec::new(),
        chain: None,
        remarks: remarks(&solutions, setting, skew.is_some()),
    })
}

impl Fit<'_> {
    /// A start from differences of the record: `M - K phi = I phi'' + B phi'`.
    fn first_guess(&self, run: &Run, restoring: f64) -> Result<Point, String> {
        let coarse = self.record.per_period(20.0);
        let (time_s, roll) = (&coarse.time_s, &coarse.roll_rad);
        let later_s = coarse.origin_s - self.record.origin_s;
        let zero_rad = run
            .still
            .map_or_else(|| roll.iter().sum::<f64>() / roll.len() as f64, |still| still.roll_rad);
        let mut triangle = Triangle::new(4);
        for i in 1..roll.len() - 1 {
            let (back_s, ahead_s) = (time_s[i] - time_s[i - 1], time_s[i + 1] - time_s[i]);
            if (ahead_s / back_s - 1.0).abs() > 0.5 {
                continue;
            }
            let rate = (roll[i + 1] - roll[i - 1]) / (back_s + ahead_s);
            let bend = (roll[i + 1] - roll[i]) / ahead_s - (roll[i] - roll[i - 1]) / back_s;
            let acceleration = 2.0 * bend / (back_s + ahead_s);
            let moment = self.moment.at_n_m(time_s[i] + later_s);
            triangle.push([acceleration, rate, 1.0, moment - restoring * (roll[i] - zero_rad)]);
        }
        triangle.settle();
        let weights = triangle.explained_by(3, 3);
        let (inertia, damping) = (-weights[0], -weights[1]);
        if inertia <= 0.0 || !inertia.is_finite() {
            return Err(format!(
                "the inertia comes out at {inertia:.3} kg m2: restoring, arm and force do not \
                 belong together (hint: gm_m, moment_arm_m, and the unit of the force)"
            ));
        }
        let start = &self.record.roll_rad;
        let values = [
            start[0] - zero_rad,
            (start[1] - start[0]) / self.record.time_s[1],
            inertia,
            (damping / inertia).max(1e-3),
            0.0,
        ];
        Ok(Point { driven: Driven { values, restoring_n_m_per_rad: restoring }, zero_rad })
    }

    /// Gauss-Newton steps until they are far below the noise.
    fn settle(&self, start: Point) -> Result<Point, String> {
        let (mut here, mut last) = (start, (start, [0.0; N]));
        let (mut best, mut share) = (f64::INFINITY, 1.0);
        for _ in 0..60 {
            let filtered = self.whiten(&here, 0.0);
            let triangle = &filtered.triangle;
            let total: f64 = (0..=N).map(|i| triangle.at(i, N).powi(2)).sum::<f64>().sqrt();
            if !total.is_finite() || total > best * (1.0 + 1e-6) {
                // Too far: go back half of the way.
                share *= 0.5;
                if share < 1e-3 {
                    break;
                }
                here = moved(&last.0, &last.1, share);
                continue;
            }
            best = total;
            let step = std::array::from_fn(|p| -triangle.explained_by(N, N)[p]);
            last = (here, step);
            share = 1.0;
            here = moved(&here, &step, 1.0);
            let residual = triangle.at(N, N).abs();
            let gain = (total * total - residual * residual).max(0.0).sqrt();
            if gain < 0.1 * residual / (filtered.n_samples as f64).sqrt() {
                return Ok(here);
            }
        }
        if best.is_finite() && last.0.driven.values[INERTIA] > 0.0 {
            Ok(last.0)
        } else {
            Err(LOST.into())
        }
    }

    /// Sensitivities, residual and the effect of a delay, whitened under the moment's noise and a
    /// wandering moment.
    fn whiten(&self, point: &Point, walk: f64) -> Filtered {
        let motion = point.driven.motion(self.moment, &self.record.time_s);
        let mut columns: Vec<Vec<f64>> =
            (0..N_DRIVEN).map(|p| motion.iter().map(|m| m.roll_by[p]).collect()).collect();
        columns.push(vec![1.0; motion.len()]);
        // Each value of the record is a mean over some instants.
        let half = 0.5 * self.record.spread_s2;
        let residual = |(roll, m): (&f64, &Sensitive)| {
            roll - point.zero_rad - m.roll_rad - half * m.acceleration_rad_per_s2
        };
        columns.push(self.record.roll_rad.iter().zip(&motion).map(residual).collect());
        // A moment that is read late by d has the whole roll simulated late: by -d times its rate.
        columns.push(motion.iter().map(|m| m.rate_rad_per_s).collect());
        let columns: Vec<Column<'_>> = columns.iter().map(|c| Column::Record(c)).collect();
        let w = point.driven.natural_rad_s();
        let [.., inertia, b1, b3] = point.driven.values;
        let (amplitude_rad, _) = rms(&motion);
        let prior = Damped {
            damping: equivalent_per_s(b1, b3, w, amplitude_rad).max(0.0) / w,
            walk,
            moment_noise: self.moment.noise_intensity() / (inertia * w.powf(1.5) * self.noise_rad),
        };
        filter::<3>(&prior, &self.record.scaled_time(w), &columns, None)
    }

    /// The posterior under the moment's noise alone and with a wandering moment, by their evidence.
    fn solutions(&self, point: &Point) -> Vec<Solution> {
        let mut solutions = vec![self.solution(point, 0.0, (1.0 - UNLAWFUL).ln())];
        let each = (UNLAWFUL / WALKS.len() as f64).ln();
        solutions.extend(WALKS.iter().map(|&walk| self.solution(point, walk, each)));
        let top = solutions.iter().map(|s| s.log_evidence).fold(f64::NEG_INFINITY, f64::max);
        solutions.retain(|s| s.log_evidence > top - 9.0);
        solutions.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
        solutions
    }

    fn solution(&self, point: &Point, walk: f64, log_prior: f64) -> Solution {
        let filtered = self.whiten(point, walk);
        let triangle = &filtered.triangle;
        let shape = 0.5 * (filtered.n_samples - N) as f64;
        let scale = 0.5 * triangle.at(N, N).powi(2);
        let log_flat: f64 = (0..N).map(|i| triangle.at(i, i).abs().ln()).sum();
        let variance = scale / (shape - 1.0);
        let mut covariance = [[0.0; N]; N];
        for column in triangle.inverse_columns(N) {
            add_square(&mut covariance, &column, variance.sqrt());
        }
        // The residual grows by the rate times the delay, and with it the step.
        let by_s: [f64; N] = std::array::from_fn(|p| -triangle.explained_by(N, N + 1)[p]);
        add_square(&mut covariance, &by_s, self.skew_sd_s);
        let step = triangle.explained_by(N, N);
        let values = &point.driven.values;
        let mean =
            std::array::from_fn(|p| values.get(p).copied().unwrap_or(point.zero_rad) - step[p]);
        let log_evidence =
            log_prior - shape * scale.ln() - 0.5 * filtered.log_determinant - log_flat;
        Solution { log_evidence, mean, covariance, by_s, noise_rad: variance.sqrt() }
    }
}

fn moved(from: &Point, step: &[f64; N], share: f64) -> Point {
    let mut point = *from;
    for (value, step) in point.driven.values.iter_mut().zip(step) {
        *value += share * step;
    }
    point.zero_rad += share * step[N - 1];
    point
}

/// Root mean square of the roll times the root of two [rad], and of the rate [rad/s]: the
/// amplitudes of the harmonic motion that is as large.
fn rms(motion: &[Sensitive]) -> (f64, f64) {
    let n = motion.len() as f64;
    let mean = motion.iter().map(|m| m.roll_rad).sum::<f64>() / n;
    let roll = motion.iter().map(|m| (m.roll_rad - mean).powi(2)).sum::<f64>();
    let rate = motion.iter().map(|m| m.rate_rad_per_s.powi(2)).sum::<f64>();
    ((2.0 * roll / n).sqrt(), (2.0 * rate / n).sqrt())
}

fn components(solutions: &[Solution], weights: &[f64; N]) -> Vec<Component> {
    let dot = |x: &[f64; N]| x.iter().zip(weights).map(|(x, w)| x * w).sum::<f64>();
    let top = solutions[0].log_evidence;
    solutions
        .iter()
        .map(|s| {
            let square: f64 = s.covariance.iter().zip(weights).map(|(row, w)| w * dot(row)).sum();
            let weight = (s.log_evidence - top).exp();
            Component { weight, mean: dot(&s.mean), sd: square.max(0.0).sqrt() }
        })
        .collect()
}

/// Equivalent damping [1/s] at a frequency [rad/s] and an amplitude [rad].
fn at_amplitude(solutions: &[Solution], frequency_rad_s: f64, amplitude_rad: f64) -> Estimate {
    let mut weights = [0.0; N];
    (weights[B1], weights[B3]) = (1.0, cubic_weight(frequency_rad_s, amplitude_rad));
    mixture::estimate(&components(solutions, &weights))
}

fn equivalent_damping(
    solutions: &[Solution],
    frequency_rad_s: f64,
    largest_rad: f64,
) -> Vec<EquivalentDamping> {
    AMPLITUDES_DEG
        .into_iter()
        .filter(|a| a.to_radians() <= 1.25 * largest_rad || is_compared(*a))
        .map(|amplitude_deg| EquivalentDamping {
            amplitude_deg,
            fitted_per_s: at_amplitude(solutions, frequency_rad_s, amplitude_deg.to_radians()),
            local_per_s: None,
            extrapolated: amplitude_deg.to_radians() > largest_rad,
        })
        .collect()
}

/// The damping moment of the fitted law along the motion, with the band of its coefficients.
fn history(record: &Record, motion: &[Sensitive], solutions: &[Solution]) -> MomentHistory {
    let mut history = MomentHistory {
        time_s: record.time_s.iter().map(|t| record.origin_s + t).collect(),
        ..MomentHistory::default()
    };
    let [.., b1, b3, _] = solutions[0].mean;
    for m in motion {
        let rate = m.rate_rad_per_s;
        let slope = b1 + 3.0 * b3 * rate * rate;
        let mut weights: [f64; N] =
            std::array::from_fn(|p| m.rate_by.get(p).map_or(0.0, |by| -slope * by));
        weights[B1] -= rate;
        weights[B3] -= rate.powi(3);
        let spread: Vec<Component> = components(solutions, &weights);
        let total: f64 = spread.iter().map(|c| c.weight).sum();
        let variance = spread.iter().map(|c| c.weight * c.sd * c.sd).sum::<f64>() / total;
        let band = Estimate::normal(-b1 * rate - b3 * rate.powi(3), variance.sqrt());
        history.roll_rad.push(m.roll_rad);
        history.roll_rate_rad_per_s.push(rate);
        history.mean_per_s2.push(band.mean);
        history.sd_per_s2.push(band.sd);
        history.lo95_per_s2.push(band.lo95);
        history.hi95_per_s2.push(band.hi95);
    }
    history
}

fn remarks(solutions: &[Solution], setting: &Setting, knows_skew: bool) -> Vec<String> {
    let mut remarks = vec![
        "the excitation does not repeat: inertia and damping are those with which the measured \
         moment makes the measured roll"
            .to_owned(),
        format!(
            "restoring K = {:.3} N m/rad from displacement and GM, taken as exact",
            setting.restoring_n_m_per_rad
        ),
    ];
    if setting.method == Method::PaperMcmc {
        remarks.push("the paper's chain needs a steady excitation: done by the default".to_owned());
    }
    if !knows_skew {
        remarks.push(skew::NOT_STATED.to_owned());
    }
    let [.., b1, b3, _] = solutions[0].mean;
    if b1 < 0.0 && b3 < 0.0 {
        remarks.push("the damping comes out negative in both parts".to_owned());
    }
    remarks
}
