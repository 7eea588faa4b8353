//! Numbers as text, rounded to what is known of them.

use crate::inverse::estimate::Estimate;

/// What stands where a number is not known.
pub(crate) const UNKNOWN: &str = "\u{2013}";

/// The power of ten of the last digit worth printing beside this standard deviation.
///
/// Two significant digits of the standard deviation are kept (GUM 7.2.6).
fn last_place(sd: f64) -> i32 {
    let place = sd.log10().floor() as i32 - 1;
    // A standard deviation such as 0.0996 rounds up to 0.10 and so to one decimal less.
    let rounded = (sd / 10_f64.powi(place)).round();
    if rounded >= 100.0 { place + 1 } else { place }
}

/// The power of ten of the first digit of a value; very low for zero, which has none.
fn first_place(value: f64) -> i32 {
    if value == 0.0 { i32::MIN / 2 } else { value.abs().log10().floor() as i32 }
}

/// `value` rounded to the given power of ten.
fn rounded(value: f64, place: i32) -> String {
    let decimals = usize::try_from(-place).unwrap_or(0).min(12);
    let value = if place > 0 {
        let unit = 10_f64.powi(place);
        (value / unit).round() * unit
    } else {
        value
    };
    // Adding zero turns a negative zero into a plain one.
    let text = format!("{:.decimals$}", value + 0.0);
    let is_zero = text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

/// `value` with this many significant digits.
pub(crate) fn significant(value: f64, digits: i32) -> String {
    if !value.is_finite() {
        return UNKNOWN.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    rounded(value, first_place(value) + 1 - digits)
}

/// `value` with this many decimals.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    if value.is_finite() { rounded(value, -(decimals as i32)) } else { UNKNOWN.to_owned() }
}

/// Standard deviations beyond which an interval has no end that anybody could use.
const UNBOUNDED: f64 = 1e4;

/// The mean, to two significant digits of the standard deviation: `0.3796`.
pub(crate) fn mean(estimate: &Estimate) -> String {
    parts(estimate).0
}

/// The interval, to two significant digits of the standard deviation: `[0.3706, 0.3886]`.
pub(crate) fn interval(estimate: &Estimate) -> String {
    parts(estimate).1
}

/// The standard deviation itself, two significant digits.
pub(crate) fn standard_deviation(estimate: &Estimate) -> String {
    significant(estimate.sd, 2)
}

/// Mean with interval: `0.3796 [0.3706, 0.3886]`.
pub(crate) fn estimate(estimate: &Estimate) -> String {
    let (mean, interval) = parts(estimate);
    format!("{mean} {interval}")
}

/// The same with at most `digits` significant digits of the mean, for tables of limited width.
pub(crate) fn estimate_within(estimate: &Estimate, digits: i32) -> String {
    let (mean, interval) = parts_within(estimate, digits);
    format!("{mean} {interval}")
}

/// The mean alone, as [`estimate_within`] writes it.
pub(crate) fn mean_within(estimate: &Estimate, digits: i32) -> String {
    parts_within(estimate, digits).0
}

fn parts(estimate: &Estimate) -> (String, String) {
    parts_within(estimate, 12)
}

/// The mean and its interval, as [`estimate_within`] writes them.
pub(crate) fn parts_within(estimate: &Estimate, digits: i32) -> (String, String) {
    let known = [estimate.mean, estimate.lo95, estimate.hi95];
    if !known.iter().all(|value| value.is_finite()) {
        return (significant(estimate.mean, 4), format!("[{UNKNOWN}, {UNKNOWN}]"));
    }
    if estimate.sd.is_finite() && estimate.sd > 0.0 {
        let place = last_place(estimate.sd).max(first_place(estimate.mean) + 1 - digits);
        let [mean, lo, hi] = known.map(|value| {
            match (value - estimate.mean) / estimate.sd {
                // The ratio of two numbers of which the lower may be nil.
                off if off > UNBOUNDED => "∞".to_owned(),
                off if off < -UNBOUNDED => "−∞".to_owned(),
                _ => rounded(value, place),
            }
        });
        (mean, format!("[{lo}, {hi}]"))
    } else {
        let [mean, lo, hi] = known.map(|value| significant(value, 5));
        (mean, format!("[{lo}, {hi}]"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_estimate_shows_two_digits_of_its_standard_deviation() {
        assert_eq!(estimate(&Estimate::normal(0.379_6, 0.004_6)), "0.3796 [0.3706, 0.3886]");
        assert_eq!(estimate(&Estimate::normal(11.83, 3.6)), "11.8 [4.8, 18.9]");
        assert_eq!(estimate(&Estimate::normal(1_184.0, 360.0)), "1180 [480, 1890]");
    }

    #[test]
    fn a_standard_deviation_that_rounds_up_loses_a_decimal() {
        assert_eq!(mean(&Estimate::normal(1.0, 0.099_6)), "1.00");
    }

    #[test]
    fn what_is_not_finite_is_a_dash_but_never_nan() {
        let unknown = Estimate { mean: f64::NAN, sd: f64::NAN, lo95: f64::NAN, hi95: f64::NAN };
        assert_eq!(estimate(&unknown), "\u{2013} [\u{2013}, \u{2013}]");
        assert_eq!(significant(f64::INFINITY, 3), "\u{2013}");
    }

    #[test]
    fn a_bound_that_nothing_holds_is_infinite() {
        let ratio = Estimate { mean: 14.7, sd: 21.0, lo95: 0.02, hi95: 1_073_741_824.0 };
        assert_eq!(estimate(&ratio), "15 [0, ∞]");
    }

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(fixed(-0.000_01, 3), "0.000");
        assert_eq!(significant(0.0, 3), "0");
    }
}
