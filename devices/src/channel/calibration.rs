//! From raw readings to SI: a zero, a curve, and who took them when.

use serde::{Deserialize, Serialize};

/// A calibration; without one a value is the raw reading.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Raw reading of nothing: model upright, rod unloaded.
    #[serde(default)]
    pub zero_raw: f64,
    /// From the raw reading less its zero to SI.
    #[serde(default)]
    pub curve: Curve,
    /// Who took it.
    #[serde(default)]
    pub by: String,
    /// When it was taken, as written by them.
    #[serde(default)]
    pub at: String,
    /// Certificate, loads, conditions.
    #[serde(default)]
    pub note: String,
}

/// The curve of a transducer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Curve {
    /// SI per raw unit.
    Gain(f64),
    /// `c0 + c1 x + c2 x² ...`
    Polynomial(Vec<f64>),
    /// Pairs of raw reading and SI value, raw readings rising; straight in between and beyond.
    Table(Vec<[f64; 2]>),
}

impl Default for Curve {
    fn default() -> Self {
        Self::Gain(1.0)
    }
}

impl Curve {
    /// The value in SI of a raw reading less its zero.
    pub fn value(&self, x: f64) -> f64 {
        match self {
            Self::Gain(gain) => gain * x,
            Self::Polynomial(coefficients) => {
                coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
            }
            Self::Table(pairs) => interpolated(pairs, x),
        }
    }
}

/// A calibration that gives no value.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CalibrationError {
    /// A number that is none, or a gain of nothing.
    #[error("calibration has the number {0}, expected are finite numbers and a gain other than 0")]
    Number(f64),
    /// A table that is too short.
    #[error("calibration table has {0} pairs, at least 2 are needed")]
    Short(usize),
    /// A table that does not rise.
    #[error("calibration table falls from {before} to {after} in its raw readings, they must rise")]
    Falls {
        /// Raw reading of a pair.
        before: f64,
        /// Raw reading of the next.
        after: f64,
    },
    /// Too few readings.
    #[error("{got} readings, at least {needed} are needed")]
    Few {
        /// How many there are.
        got: usize,
        /// How many are needed.
        needed: usize,
    },
}

impl Calibration {
    /// The value in SI of a raw reading.
    pub fn value(&self, raw: f64) -> f64 {
        self.curve.value(raw - self.zero_raw)
    }

    /// Whether it gives a value for every reading.
    ///
    /// # Errors
    /// [`CalibrationError`] with the number at fault.
    pub fn check(&self) -> Result<(), CalibrationError> {
        let numbers: Vec<f64> = match &self.curve {
            Curve::Gain(gain) => vec![*gain],
            Curve::Polynomial(coefficients) => coefficients.clone(),
            Curve::Table(pairs) => pairs.iter().flatten().copied().collect(),
        };
        let all = numbers.iter().chain([&self.zero_raw]);
        if let Some(number) = all.copied().find(|number| !number.is_finite()) {
            return Err(CalibrationError::Number(number));
        }
        match &self.curve {
            Curve::Gain(gain) if *gain == 0.0 => Err(CalibrationError::Number(*gain)),
            Curve::Table(pairs) if pairs.len() < 2 => Err(CalibrationError::Short(pairs.len())),
            Curve::Table(pairs) => match pairs.windows(2).find(|two| two[0][0] >= two[1][0]) {
                Some(two) => Err(CalibrationError::Falls { before: two[0][0], after: two[1][0] }),
                None => Ok(()),
            },
            _ => Ok(()),
        }
    }
}

fn interpolated(pairs: &[[f64; 2]], x: f64) -> f64 {
    let after = pairs.partition_point(|[raw, _]| *raw <= x).clamp(1, pairs.len().max(2) - 1);
    match (pairs.get(after - 1), pairs.get(after)) {
        (Some([x0, y0]), Some([x1, y1])) => y0 + (y1 - y0) * (x - x0) / (x1 - x0),
        _ => f64::NAN,
    }
}

/// Mean and standard deviation of the raw readings of nothing.
///
/// # Errors
/// [`CalibrationError::Few`] below ten readings.
pub fn zero_from_readings(raw: &[f64]) -> Result<(f64, f64), CalibrationError> {
    const NEEDED: usize = 10;
    if raw.len() < NEEDED {
        return Err(CalibrationError::Few { got: raw.len(), needed: NEEDED });
    }
    let n = raw.len() as f64;
    let mean = raw.iter().sum::<f64>() / n;
    let variance = raw.iter().map(|raw| (raw - mean).powi(2)).sum::<f64>() / (n - 1.0);
    Ok((mean, variance.sqrt()))
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
mod tests {
    use super::*;

    fn with(curve: Curve) -> Calibration {
        Calibration { zero_raw: 2.0, curve, ..Calibration::default() }
    }

    #[test]
    fn a_gain_a_polynomial_and_a_table_give_their_values() {
        assert_eq!(with(Curve::Gain(3.0)).value(4.0), 6.0);
        assert_eq!(with(Curve::Polynomial(vec![1.0, 2.0, 3.0])).value(4.0), 17.0);
        let table = with(Curve::Table(vec![[0.0, 0.0], [1.0, 10.0], [3.0, 14.0]]));
        let values = [1.0, 2.5, 4.0, 6.0].map(|raw| table.value(raw));
        assert_eq!(values, [-10.0, 5.0, 12.0, 16.0]);
    }

    #[test]
    fn what_gives_no_value_is_refused_with_its_number() {
        let falls = with(Curve::Table(vec![[0.0, 0.0], [1.0, 1.0], [1.0, 2.0]]));
        let error = falls.check().unwrap_err().to_string();
        assert!(error.contains("falls from 1 to 1"), "{error}");
        assert!(with(Curve::Gain(0.0)).check().is_err());
        assert!(with(Curve::Table(vec![[0.0, 1.0]])).check().is_err());
        assert!(with(Curve::Polynomial(vec![0.0, f64::NAN])).check().is_err());
    }

    #[test]
    fn a_zero_is_the_mean_of_ten_readings_at_least() {
        let (mean, deviation) = zero_from_readings(&[1.0, 3.0].repeat(5)).unwrap();
        assert!((mean - 2.0).abs() < 1e-12 && (deviation - 1.054_092_6).abs() < 1e-6);
        assert!(zero_from_readings(&[1.0; 9]).is_err());
    }

    #[test]
    fn a_calibration_is_written_in_the_campaign_file() {
        let text = "zero_raw = 12.5\nby = \"A. Nilsson\"\nat = \"2026-11-26 08:10\"\n\
                    curve = { table = [[0.0, 0.0], [1.0, 9.81]] }";
        let calibration: Calibration = toml::from_str(text).unwrap();
        assert_eq!(calibration.curve, Curve::Table(vec![[0.0, 0.0], [1.0, 9.81]]));
        assert!(toml::from_str::<Calibration>("gian = 2.0").is_err());
    }
}
