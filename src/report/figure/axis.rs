//! The range and the ticks of an axis.

/// One axis: its label with the unit, and what its range must hold.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Axis {
    label: String,
    margin: f64,
    holds: Option<f64>,
    limits: Option<(f64, f64)>,
    width_min: f64,
}

impl Axis {
    /// An axis that holds its data with a small margin.
    pub(crate) fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), margin: 0.06, holds: None, limits: None, width_min: 0.0 }
    }

    /// A time axis [s], which begins and ends with its data.
    pub(crate) fn time() -> Self {
        Self::new("time t [s]").tight()
    }

    /// The same axis without a margin beside its data.
    #[must_use]
    pub(crate) fn tight(self) -> Self {
        Self { margin: 0.0, ..self }
    }

    /// The same axis with `value` always on it.
    #[must_use]
    pub(crate) fn holding(self, value: f64) -> Self {
        Self { holds: Some(value), ..self }
    }

    /// The same axis from `lo` to `hi` whatever the data; data beyond are drawn on the edge.
    #[must_use]
    pub(crate) fn limited(self, lo: f64, hi: f64) -> Self {
        let limits = (lo.is_finite() && hi.is_finite() && lo < hi).then_some((lo, hi));
        Self { limits, ..self }
    }

    /// The same axis at least `width_min` wide, so that mere noise is not blown up.
    #[must_use]
    pub(crate) fn at_least(self, width_min: f64) -> Self {
        Self { width_min, ..self }
    }

    /// The label, with its unit.
    pub(crate) fn label(&self) -> &str {
        &self.label
    }

    /// Where the axis begins and ends for these data; never empty.
    pub(super) fn range(&self, data: impl Iterator<Item = f64>) -> (f64, f64) {
        if let Some(limits) = self.limits {
            return limits;
        }
        let (lo, hi) = data
            .chain(self.holds)
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
        if lo > hi {
            return (0.0, 1.0);
        }
        // A constant is drawn in the middle of a range of its own size.
        let width = hi - lo;
        if width < self.width_min {
            let middle = f64::midpoint(lo, hi);
            return (middle - 0.5 * self.width_min, middle + 0.5 * self.width_min);
        }
        if width <= 1e-9 * lo.abs().max(hi.abs()) || width == 0.0 {
            let half = if lo == 0.0 { 1.0 } else { 0.05 * lo.abs() };
            return (lo - half, hi + half);
        }
        let margin = self.margin * width;
        let lo_margin = if self.holds == Some(lo) { 0.0 } else { margin };
        (lo - lo_margin, hi + margin)
    }
}

/// A second scale on the right: the left one times `factor`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SecondScale {
    /// Label, with its unit.
    pub(crate) label: String,
    /// Units of this scale in one unit of the left scale, positive.
    pub(crate) factor: f64,
}

/// Ticks at round numbers, with the labels written beside them.
pub(super) fn ticks(lo: f64, hi: f64, n_max: usize) -> Vec<(f64, String)> {
    let mut step = round_step((hi - lo) / n_max.max(1) as f64);
    // One tick alone tells no scale.
    if (hi / step).floor() - (lo / step).ceil() < 1.0 {
        step = round_step(0.5 * (hi - lo) / n_max.max(1) as f64);
    }
    if !step.is_finite() || step <= 0.0 {
        return Vec::new();
    }
    let decimals = decimals_of(step);
    let (first, last) = ((lo / step - 1e-9).ceil() as i64, (hi / step + 1e-9).floor() as i64);
    (first..=last)
        .map(|k| {
            let value = k as f64 * step;
            (value, label(value, step, decimals))
        })
        .collect()
}

/// The smallest of 1, 2, 5 times a power of ten that is at least `raw`.
fn round_step(raw: f64) -> f64 {
    let power = 10_f64.powf(raw.log10().floor());
    let digit = [1.0, 2.0, 5.0, 10.0].into_iter().find(|digit| digit * power >= raw * (1.0 - 1e-9));
    digit.unwrap_or(10.0) * power
}

fn decimals_of(step: f64) -> usize {
    (-(step * (1.0 + 1e-9)).log10().floor()).max(0.0) as usize
}

fn label(value: f64, step: f64, decimals: usize) -> String {
    let text = if decimals > 5 || value.abs().max(step) >= 1e6 {
        format!("{value:.0e}")
    } else {
        format!("{value:.decimals$}")
    };
    text.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(lo: f64, hi: f64) -> Vec<String> {
        ticks(lo, hi, 6).into_iter().map(|tick| tick.1).collect()
    }

    #[test]
    fn ticks_stand_at_round_numbers_with_as_many_decimals_as_they_need() {
        assert_eq!(labels(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(
            labels(-0.011, 0.011),
            ["\u{2212}0.010", "\u{2212}0.005", "0.000", "0.005", "0.010"]
        );
        assert_eq!(labels(3.0, 290.0), ["50", "100", "150", "200", "250"]);
    }

    #[test]
    fn noise_is_drawn_on_an_axis_of_the_least_width() {
        let range = Axis::new("V").at_least(0.1).range([0.999, 1.001].into_iter());
        assert_eq!(range, (0.95, 1.05));
    }

    #[test]
    fn an_axis_has_two_ticks_or_more() {
        assert!(ticks(-0.45, 0.45, 4).len() >= 2);
    }

    #[test]
    fn a_range_is_never_empty_whatever_the_data() {
        for data in [vec![], vec![f64::NAN], vec![0.0, 0.0], vec![7.0], vec![-2.0, f64::INFINITY]] {
            let (lo, hi) = Axis::new("x").range(data.into_iter());
            assert!(lo.is_finite() && hi.is_finite() && lo < hi);
        }
    }
}
