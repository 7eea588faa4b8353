//! Least squares of the roll equation on a decay, and the equation linearised there.
//!
//! The law of Sec. 4.1 projected on `U` through the likelihood is the law fitted to the roll, so
//! that 500 correlated moments are not counted as 500 observations.

use super::curve::{N_CURVE, Scale};
use super::form::power_curve;
use crate::inverse::record::Record;
use crate::inverse::state_space::triangle::Triangle;
use crate::roll::damping::equivalent_per_s;
use crate::roll::equation::{Decay, Motion};
use crate::roll::response::{Path, Response};

/// Position of the initial roll among the unknowns.
pub const ROLL: usize = 0;
/// Position of the initial roll rate.
pub const RATE: usize = 1;
/// Position of the natural frequency.
pub const FREQUENCY: usize = 2;
/// Position of the zero offset of the roll channel.
pub const ZERO: usize = 3;
/// Position of the cubic restoring.
pub const CUBIC_RESTORING: usize = 4;
/// Position of the first coefficient of the damping curve.
pub const CURVE: usize = 5;
/// Number of unknowns.
pub const N_UNKNOWNS: usize = CURVE + N_CURVE;

/// Prior standard deviation of the cubic restoring [1/rad2]: wall-sided hulls reach +0.6, hulls
/// that lose stability -1.
pub const CUBIC_RESTORING_SD: f64 = 1.0;

/// A decay and the zero offset of its roll channel [rad].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The decay.
    pub decay: Decay,
    /// What the roll channel reads at rest [rad].
    pub zero_rad: f64,
}

/// The roll equation linearised at its least-squares point.
pub struct Linearised {
    /// Where.
    pub point: Point,
    /// Scale of the damping curve.
    pub scale: Scale,
    /// Damping curve and cubic restoring of the fit, among the unknowns; the others are nil.
    pub fitted: [f64; N_UNKNOWNS],
    /// The motion at each sample.
    pub motion: Vec<Motion>,
    /// Response to each unknown at each sample; the zero offset does not move the model.
    pub responses: Vec<Vec<Response>>,
    /// What a unit of each unknown changes in the record [rad], sample by sample.
    pub columns: Vec<Vec<f64>>,
    /// The record less the fit [rad].
    pub residual_rad: Vec<f64>,
}

impl Linearised {
    /// Linearises at `point`.
    pub fn new(record: &Record, point: Point) -> Self {
        let path = Path::new(&point.decay, &record.time_s);
        let motion: Vec<Motion> = path.motion().collect();
        let largest = |of: fn(&Motion) -> f64| motion.iter().map(of).fold(0.0, f64::max);
        let rate_rad_per_s = largest(|m| m.roll_rate_rad_per_s.abs());
        let amplitude_rad = largest(|m| m.roll_rad.abs());
        let Decay { natural_frequency_rad_s: w, b1_per_s, b2, b3_s, .. } = point.decay;
        let quadratic = 8.0 / (3.0 * std::f64::consts::PI) * b2 * w * amplitude_rad;
        let damping_per_s = quadratic + equivalent_per_s(b1_per_s, b3_s, w, amplitude_rad);
        // A record that grows would have none; a hundredth of critical is a size like any other.
        let scale = Scale { damping_per_s: damping_per_s.max(0.002 * w), rate_rad_per_s };
        let mut fitted = [0.0; N_UNKNOWNS];
        fitted[CUBIC_RESTORING] = point.decay.restoring_cubic_per_rad2;
        let parts = [b1_per_s, b2 * rate_rad_per_s, b3_s * rate_rad_per_s.powi(2)];
        for (part, power) in parts.into_iter().zip([1.0, 2.0, 3.0]) {
            for (fitted, curve) in fitted[CURVE..].iter_mut().zip(power_curve(power)) {
                *fitted += part * curve / scale.damping_per_s;
            }
        }
        let mut responses = common_responses(&path, &point.decay);
        for k in 0..N_CURVE {
            responses.push(path.to_moment(|_, rate| -scale.moments(rate)[k]));
        }
        let columns: Vec<Vec<f64>> = responses
            .iter()
            .enumerate()
            .map(|(unknown, response)| seen(record, response, unknown))
            .collect();
        let residual_rad = residual(record, &point, &motion);
        Self { point, scale, fitted, motion, responses, columns, residual_rad }
    }

    /// Change of `U = phi'' + w^2 phi` [rad/s2] at one sample per unit of an unknown.
    pub fn moment_response(&self, unknown: usize, sample: usize) -> f64 {
        let w = self.point.decay.natural_frequency_rad_s;
        let response = &self.responses[unknown][sample];
        let direct =
            if unknown == FREQUENCY { 2.0 * w * self.motion[sample].roll_rad } else { 0.0 };
        response.acceleration + w * w * response.roll + direct
    }

    /// `U = phi'' + w^2 phi` [rad/s2] of the fit at one sample.
    pub fn moment_per_s2(&self, sample: usize) -> f64 {
        let motion = &self.motion[sample];
        let w = self.point.decay.natural_frequency_rad_s;
        motion.roll_acceleration_rad_per_s2 + w * w * motion.roll_rad
    }
}

/// Responses to everything but the damping.
fn common_responses(path: &Path, decay: &Decay) -> Vec<Vec<Response>> {
    let (w, k3) = (decay.natural_frequency_rad_s, decay.restoring_cubic_per_rad2);
    vec![
        path.to_initial_roll(),
        path.to_initial_rate(),
        path.to_moment(|phi, _| -2.0 * w * phi * (1.0 + k3 * phi * phi)),
        path.motion().map(|_| Response { roll: 0.0, rate: 0.0, acceleration: 0.0 }).collect(),
        path.to_moment(|phi, _| -w * w * phi.powi(3)),
    ]
}

/// What the record sees of a response: the mean over the instants that each value stands for.
fn seen(record: &Record, response: &[Response], unknown: usize) -> Vec<f64> {
    let half = 0.5 * record.spread_s2;
    let offset = if unknown == ZERO { 1.0 } else { 0.0 };
    response.iter().map(|r| r.roll + half * r.acceleration + offset).collect()
}

fn residual(record: &Record, point: &Point, motion: &[Motion]) -> Vec<f64> {
    let half = 0.5 * record.spread_s2;
    let simulated =
        |m: &Motion| m.roll_rad + half * m.roll_acceleration_rad_per_s2 + point.zero_rad;
    record.roll_rad.iter().zip(motion).map(|(roll, m)| roll - simulated(m)).collect()
}

/// The least-squares point near `start` for a law of these powers of the rate, with or without a
/// cubic part of the restoring.
///
/// # Errors
/// The reason, as a sentence, when the fit does not settle.
pub fn settle(
    record: &Record,
    start: Point,
    powers: &[u8],
    cubic_restoring: bool,
) -> Result<Point, String> {
    const LOST: &str = "the roll equation cannot be fitted to the record";
    let active: Vec<usize> = (0..CURVE)
        .filter(|unknown| cubic_restoring || *unknown != CUBIC_RESTORING)
        .chain(powers.iter().map(|power| CURVE + usize::from(*power) - 1))
        .collect();
    let n = active.len();
    let n_samples = record.roll_rad.len() as f64;
    let mut here = start;
    let mut best = f64::INFINITY;
    let mut last = (start, [0.0; N_MOVED]);
    let mut share = 1.0;
    for _ in 0..60 {
        let triangle = normal_triangle(record, &here, &active);
        let total: f64 = (0..=n).map(|i| triangle.at(i, n).powi(2)).sum::<f64>().sqrt();
        if !total.is_finite() || total > best * (1.0 + 1e-9) {
            // Too far: go back half of the way.
            share *= 0.5;
            if share < 1e-4 {
                return if best.is_finite() { Ok(last.0) } else { Err(LOST.into()) };
            }
            here = moved(&last.0, &last.1, share);
            continue;
        }
        best = total;
        let residual = triangle.at(n, n).abs();
        let mut step = [0.0; N_MOVED];
        for (position, weight) in active.iter().zip(triangle.explained_by(n, n)) {
            step[*position] = -weight;
        }
        if step.iter().any(|s| !s.is_finite()) {
            return Err(LOST.into());
        }
        last = (here, step);
        share = 1.0;
        here = moved(&here, &step, 1.0);
        // After a step of a standard deviation or so the next is a hundredth of one.
        let gain = (total * total - residual * residual).max(0.0).sqrt();
        if gain < 1.5 * residual / n_samples.sqrt() || gain < 1e-12 * record.scale_rad() {
            return Ok(here);
        }
    }
    Ok(last.0)
}

/// Unknowns that the fit can move: those of the equation, then three powers of the rate.
const N_MOVED: usize = CURVE + 3;

/// The triangle of the active columns and the residual, in that order.
fn normal_triangle(record: &Record, point: &Point, active: &[usize]) -> Triangle {
    let path = Path::new(&point.decay, &record.time_s);
    let motion: Vec<Motion> = path.motion().collect();
    let residual = residual(record, point, &motion);
    let mut responses = common_responses(&path, &point.decay);
    for power in 0..3 {
        // A power that does not move needs no response.
        responses.push(if active.contains(&(CURVE + power)) {
            path.to_moment(|_, rate| -rate * rate.abs().powi(power as i32))
        } else {
            Vec::new()
        });
    }
    let columns: Vec<Vec<f64>> =
        active.iter().map(|&u| seen(record, &responses[u], u)).chain([residual]).collect();
    let mut triangle = Triangle::new(columns.len());
    for sample in 0..record.roll_rad.len() {
        triangle.push(columns.iter().map(|column| column[sample]));
    }
    triangle.settle();
    if let Some(position) = active.iter().position(|unknown| *unknown == CUBIC_RESTORING) {
        let n = active.len();
        let noise = triangle.at(n, n).abs() / (record.roll_rad.len() as f64).sqrt();
        let mut row = vec![0.0; n + 1];
        row[position] = noise / CUBIC_RESTORING_SD;
        row[n] = -row[position] * point.decay.restoring_cubic_per_rad2;
        triangle.add(&row);
    }
    triangle
}

fn moved(from: &Point, step: &[f64; N_MOVED], share: f64) -> Point {
    let step = step.map(|s| s * share);
    let decay = &from.decay;
    Point {
        decay: Decay {
            initial_roll_rad: decay.initial_roll_rad + step[ROLL],
            initial_roll_rate_rad_per_s: decay.initial_roll_rate_rad_per_s + step[RATE],
            natural_frequency_rad_s: decay.natural_frequency_rad_s + step[FREQUENCY],
            b1_per_s: decay.b1_per_s + step[CURVE],
            b2: decay.b2 + step[CURVE + 1],
            b3_s: decay.b3_s + step[CURVE + 2],
            restoring_cubic_per_rad2: decay.restoring_cubic_per_rad2 + step[CUBIC_RESTORING],
        },
        zero_rad: from.zero_rad + step[ZERO],
    }
}
