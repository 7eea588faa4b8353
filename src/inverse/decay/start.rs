//! Where the fit of a decay starts from.

use super::fit::Point;
use crate::inverse::record::Record;
use crate::roll::damping::cubic_weight;
use crate::roll::equation::Decay;
use crate::run::Run;

/// A starting point for the fit: zero from the middle of the record, damping from how soon the
/// roll has fallen to a third.
pub(super) fn first_guess(record: &Record, run: &Run) -> Point {
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
        b2: 0.0,
        b3_s: 0.3 * equivalent / cubic_weight(w, largest),
        restoring_cubic_per_rad2: 0.0,
    };
    Point { decay, zero_rad: zero }
}
