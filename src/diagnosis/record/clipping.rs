//! Readings that stop at the end of a channel's range.

use super::noise::rough_noise;
use crate::model::Clip;
use crate::run::Series;

/// A crest reaches from this share of its top.
const CREST_FROM: f64 = 0.93;
/// Curvature below this share of a round crest's is none.
const FLAT: f64 = 0.35;
/// Logarithm of the odds against chance above which readings stick.
const STUCK: f64 = 5.0;
/// Crests within this share of the largest reading may be at the end of the range.
const NEAR_TOP: f64 = 0.97;

/// The level at which readings stop: repeated to the last digit in spite of the noise, or two or
/// more crests flat, or one without doubt.
///
/// A model held beyond the range is seen in what was read before the run, and a roll that soon
/// fades may show nothing else.
pub(super) fn clip(before: &Series, roll: &Series, rolling_rad_s: f64) -> Option<Clip> {
    let all = [&before.value[..], &roll.value].concat();
    stuck(&all).or_else(|| flat_crests(roll, rolling_rad_s))
}

/// Readings in a row that noise would never leave alike, at the end of what the channel reads.
fn stuck(values: &[f64]) -> Option<Clip> {
    let noise_rad = rough_noise(values);
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let step_rad = steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    // Chance that noise leaves a reading where it was.
    let alike = step_rad / (2.0 * std::f64::consts::PI.sqrt() * noise_rad);
    let middle = middle(values);
    let end_of = |sign: f64| -> Clip {
        let end = values.iter().map(|v| sign * (v - middle)).fold(f64::NEG_INFINITY, f64::max);
        let is_there = |value: &f64| sign * (value - middle) >= end;
        let rows = values.split(|value| !is_there(value)).map(<[f64]>::len);
        let n_alike: usize = rows.map(|n| n.saturating_sub(1)).sum();
        // Any reading may be the largest; that its neighbours are too takes chance.
        let log_bayes_factor = -(n_alike as f64) * alike.min(1.0).ln();
        Clip { level_rad: end, sd_rad: step_rad, log_bayes_factor }
    };
    let ends = [end_of(1.0), end_of(-1.0)];
    let [surest, other] =
        if ends[0].log_bayes_factor > ends[1].log_bayes_factor { ends } else { [ends[1], ends[0]] };
    let is_wide = surest.level_rad > 0.5 * other.level_rad;
    (surest.log_bayes_factor > STUCK && alike < 0.5 && is_wide).then_some(surest)
}

/// What a channel reads at rest, by the end of a record: that of a forced run holds no whole number
/// of periods.
pub(super) fn middle(values: &[f64]) -> f64 {
    let tail = &values[values.len() - (values.len() / 5).max(1)..];
    let range = tail.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(*value), high.max(*value)]
    });
    0.5 * (range[0] + range[1])
}

/// Crests that are flat at one level.
fn flat_crests(roll: &Series, rolling_rad_s: f64) -> Option<Clip> {
    let values = &roll.value;
    let noise_rad = rough_noise(values);
    let middle = middle(values);
    let top = values.iter().map(|v| (v - middle).abs()).fold(0.0, f64::max) - 2.0 * noise_rad;
    // Of each side, for the middle is not known well enough to compare them.
    let mut levels: [Vec<(f64, f64)>; 2] = [Vec::new(), Vec::new()];
    let mut log_bayes_factor = 0.0;
    let mut start = 0;
    while start < values.len() {
        let sign = (values[start] - middle).signum();
        let inside = |v: f64| sign * (v - middle) > CREST_FROM * top;
        let length = values[start..].iter().take_while(|v| inside(**v)).count();
        // A crest that begins with the record may still be in the hand that lets go.
        if length >= 6 && start > 0 && start + length < values.len() {
            let crest = &values[start..start + length];
            let inner = &crest[length / 4..length - length / 4];
            let level = inner.iter().map(|v| sign * (v - middle)).sum::<f64>() / inner.len() as f64;
            let times = &roll.time_s[start + length / 4..start + length - length / 4];
            let (curvature, sd) = curvature(times, inner, noise_rad);
            let round = -sign * rolling_rad_s.powi(2) * level;
            if level > NEAR_TOP * top && inner.len() >= 4 {
                let off = |expected: f64| ((curvature - expected) / sd).powi(2);
                let log = 0.5 * (off(round).min(400.0) - off(0.0).min(400.0)) - 2.0;
                if (curvature / round) < FLAT && log > 0.0 {
                    levels[usize::from(sign < 0.0)]
                        .push((level, noise_rad / (inner.len() as f64).sqrt()));
                    log_bayes_factor += log;
                }
            }
        }
        start += length.max(1);
    }
    let cut: Vec<&Vec<(f64, f64)>> = levels.iter().filter(|side| !side.is_empty()).collect();
    let n = cut.len() as f64;
    let mean = |side: &[(f64, f64)]| side.iter().map(|l| l.0).sum::<f64>() / side.len() as f64;
    let level_rad = cut.iter().map(|side| mean(side)).sum::<f64>() / n;
    let variance = |side: &[(f64, f64)]| {
        side.iter().map(|l| l.1 * l.1).sum::<f64>() / (side.len() as f64).powi(2)
    };
    let sd_rad = cut.iter().map(|side| variance(side)).sum::<f64>().sqrt() / n;
    let agree = cut.iter().all(|side| {
        let level_rad = mean(side);
        side.iter().all(|l| (l.0 - level_rad).abs() < 4.0 * l.1 + 2e-3 * level_rad)
    });
    let sure = !cut.is_empty() && agree && log_bayes_factor > 10.0;
    sure.then_some(Clip { level_rad, sd_rad, log_bayes_factor })
}

/// Second derivative of a parabola through the samples, with its standard deviation.
fn curvature(times: &[f64], values: &[f64], noise_rad: f64) -> (f64, f64) {
    let n = times.len() as f64;
    let centre = times.iter().sum::<f64>() / n;
    let moment = |p: i32| times.iter().map(|t| (t - centre).powi(p)).sum::<f64>();
    let (m2, m3, m4) = (moment(2), moment(3), moment(4));
    // The square less its projection on a straight line.
    let part = |t: f64| (t - centre).powi(2) - m2 / n - m3 / m2 * (t - centre);
    let norm = m4 - m2 * m2 / n - m3 * m3 / m2;
    let slope: f64 = times.iter().zip(values).map(|(t, v)| part(*t) * v).sum::<f64>() / norm;
    (2.0 * slope, 2.0 * noise_rad / norm.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decay(end_rad: f64) -> Series {
        let time_s: Vec<f64> = (0..1500).map(|i| f64::from(i) * 0.01).collect();
        let noise = |i: usize| 8e-4 * (((i * 7919) % 1000) as f64 / 500.0 - 1.0);
        let value = time_s
            .iter()
            .enumerate()
            .map(|(i, t)| {
                (0.26 * (-0.15 * t).exp() * (6.9 * t).cos()).clamp(-end_rad, end_rad) + noise(i)
            })
            .collect();
        Series { time_s, value }
    }

    #[test]
    fn a_model_held_beyond_the_range_is_seen_before_it_is_let_go() {
        // Read within the range from the release on, as a strongly damped roll is.
        let roll = decay(1.0);
        let noise = |i: usize| 8e-4 * (((i * 7919) % 1000) as f64 / 500.0 - 1.0);
        let held = |level_rad: f64, end_rad: f64| Series {
            time_s: (0..600).map(|i| f64::from(i) * 0.01 - 6.0).collect(),
            value: (0..600).map(|i| (level_rad + noise(i)).min(end_rad)).collect(),
        };
        assert_eq!(clip(&held(0.3, 1.0), &roll, 6.9), None);
        let found = clip(&held(0.3, 0.28), &roll, 6.9).expect("readings that stick");
        assert!((found.level_rad - 0.28).abs() < 5e-3, "{found:?}");
    }

    #[test]
    fn cut_crests_are_seen_with_their_level_and_round_ones_are_not() {
        assert_eq!(clip(&Series::default(), &decay(1.0), 6.9), None);
        let found = clip(&Series::default(), &decay(0.2), 6.9).expect("flat crests");
        assert!((found.level_rad - 0.2).abs() < 5e-4, "{found:?}");
    }
}
