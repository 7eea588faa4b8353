//! The instrument chain: transducers, clocks, noise and a converter of 16 bits.

use super::base::ARM_M;
use super::draw::Draw;
use super::effect::Hiding;
use super::motion::Motion;
use super::plan::Pass;

/// Sampling rate of all channels [1/s].
pub(crate) const RATE_HZ: f64 = 100.0;
/// Noise of the roll angle [rad]: 0.05 degrees.
pub(crate) const ROLL_NOISE_RAD: f64 = 0.05 * std::f64::consts::PI / 180.0;
/// Noise of the moment [N m].
pub(crate) const MOMENT_NOISE_N_M: f64 = 0.05;
/// Noise of the carriage speed [m/s].
const SPEED_NOISE_M_S: f64 = 0.001;
/// Steps of the converter: 16 bits over 330 degrees, 650 N, and the encoder's count.
const ROLL_STEP_DEG: f64 = 0.005;
const FORCE_STEP_N: f64 = 0.01;
const SPEED_STEP_M_S: f64 = 0.001;
/// Zeros are taken every morning; what is left is a tenth of a step.
const ZERO_LEFT: f64 = 0.1;

/// A recording, row by row.
#[derive(Clone, Default)]
pub(crate) struct Rows {
    /// Stamp [s].
    pub(crate) time_s: Vec<f64>,
    /// Roll [deg].
    pub(crate) roll_deg: Vec<f64>,
    /// Force of the rod [N].
    pub(crate) force_n: Vec<f64>,
    /// Carriage speed [m/s].
    pub(crate) speed_m_s: Vec<f64>,
}

impl Rows {
    /// The channels whose samples one scan takes together.
    pub(crate) fn channels(&mut self) -> [&mut Vec<f64>; 3] {
        [&mut self.roll_deg, &mut self.force_n, &mut self.speed_m_s]
    }
}

/// What is written of a motion. Without `noise` the signal is as fine and still as it never is.
pub(crate) fn record(
    mut motion: Motion,
    pass: &Pass,
    hiding: &Hiding,
    noise: Option<&mut Draw>,
) -> Rows {
    for effect in hiding {
        effect.transduce(&mut motion, pass);
    }
    let begins_s = motion.time_s[0];
    let per_sample = (1.0 / (RATE_HZ * motion.step_s)).round() as usize;
    let n_rows = (motion.time_s.len() - 1) / per_sample + 1;
    let force_sign = if pass.force_reversed { -1.0 } else { 1.0 };
    let mut rows = Rows::default();
    for row in 0..n_rows {
        let at = row * per_sample;
        let stamp_s = begins_s + row as f64 / RATE_HZ;
        let sampled_s = hiding.iter().fold(stamp_s, |t, effect| effect.force_sampled_s(t, pass));
        let moment = between(&motion.moment, (sampled_s - begins_s) / motion.step_s);
        rows.time_s.push(stamp_s);
        rows.roll_deg.push(motion.roll[at].to_degrees());
        rows.force_n.push(force_sign * moment / ARM_M);
        rows.speed_m_s.push(motion.speed[at] * pass.speed_shown);
    }
    if let Some(draw) = noise {
        convert(&mut rows, draw);
    }
    for effect in hiding {
        effect.spoil(&mut rows, pass);
    }
    rows
}

/// Noise, what the morning's zero left, and the steps of the converter.
fn convert(rows: &mut Rows, draw: &mut Draw) {
    let chain = [
        (ROLL_NOISE_RAD.to_degrees(), ROLL_STEP_DEG),
        (MOMENT_NOISE_N_M / ARM_M, FORCE_STEP_N),
        (SPEED_NOISE_M_S, SPEED_STEP_M_S),
    ];
    for (values, (noise, step)) in rows.channels().into_iter().zip(chain) {
        let zero = ZERO_LEFT * step * draw.between(-1.0, 1.0);
        for value in values {
            *value = ((*value + zero + noise * draw.normal()) / step).round() * step;
        }
    }
}

/// A value between grid points, by the cubic through the four nearest.
pub(crate) fn between(values: &[f64], at: f64) -> f64 {
    let at = at.clamp(0.0, (values.len() - 1) as f64);
    let first = (at.floor() as usize).saturating_sub(1).min(values.len().saturating_sub(4));
    let four = &values[first..(first + 4).min(values.len())];
    let x = at - first as f64;
    let weight = |i: usize| {
        let others = (0..four.len()).filter(|j| *j != i);
        others.map(|j| (x - j as f64) / (i as f64 - j as f64)).product::<f64>()
    };
    four.iter().enumerate().map(|(i, value)| value * weight(i)).sum()
}
