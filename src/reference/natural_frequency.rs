//! What a natural frequency read off a Fourier spectrum is worth.

use std::f64::consts::TAU;

use super::Erratum;
use crate::tank::paper;

/// One way to get the printed frequency as a line of a discrete Fourier transform.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bin {
    sample_rate_hz: f64,
    n_samples: usize,
    line: usize,
}

impl Bin {
    fn frequency_rad_s(&self) -> f64 {
        TAU * self.sample_rate_hz * self.line as f64 / self.n_samples as f64
    }

    /// Half the distance between lines as a share of the frequency [-].
    fn half_width(&self) -> f64 {
        0.5 / self.line as f64
    }
}

/// Sample rates that recorders offer [Hz].
const SAMPLE_RATES_HZ: [f64; 6] = [10.0, 20.0, 50.0, 100.0, 200.0, 1000.0];
/// Shortest and longest record of a decay that could have been transformed [s].
const RECORD_S: [f64; 2] = [5.0, 21.0];

/// Transforms of a power-of-two length with a line that rounds to `printed` at three decimals.
///
/// Coarser lines come first: the same frequency is line 5 of a record half as long as line 10.
fn bins_at(printed_rad_s: f64) -> Vec<Bin> {
    let mut bins = Vec::new();
    for sample_rate_hz in SAMPLE_RATES_HZ {
        for n_samples in (5..15).map(|power| 1_usize << power) {
            let length_s = n_samples as f64 / sample_rate_hz;
            let line = (printed_rad_s / TAU * length_s).round() as usize;
            let bin = Bin { sample_rate_hz, n_samples, line };
            let same = (bin.frequency_rad_s() - printed_rad_s).abs() < 5e-4;
            if (RECORD_S[0]..=RECORD_S[1]).contains(&length_s) && line > 0 && same {
                bins.push(bin);
            }
        }
    }
    bins.sort_by_key(|bin| bin.line);
    bins
}

/// The transforms at 100 Hz, the coarser first.
fn bins_at_100_hz() -> Vec<Bin> {
    let mut bins = bins_at(paper::NATURAL_FREQUENCY_KEELS_RAD_S);
    bins.retain(|bin| (bin.sample_rate_hz - 100.0).abs() < 1e-9);
    bins
}

/// Growth of the inertia from bare hull to bilge keels at a relative error of the frequency [-].
fn inertia_growth(frequency_error: f64) -> f64 {
    let keels = paper::NATURAL_FREQUENCY_KEELS_RAD_S * (1.0 + frequency_error);
    (paper::NATURAL_FREQUENCY_BARE_RAD_S / keels).powi(2) - 1.0
}

/// The printed frequency that is a line of the transform.
pub(super) fn bin_erratum() -> Erratum {
    let printed = paper::NATURAL_FREQUENCY_KEELS_RAD_S;
    let ways: Vec<String> = bins_at_100_hz()
        .iter()
        .map(|bin| {
            format!(
                "line {} of {} samples at {} Hz is {:.4} rad/s, known to +-{:.0} %",
                bin.line,
                bin.n_samples,
                bin.sample_rate_hz,
                bin.frequency_rad_s(),
                100.0 * bin.half_width(),
            )
        })
        .collect();
    let length_s = 10.0;
    Erratum {
        title: "The natural frequency with bilge keels is a line of a Fourier transform".to_owned(),
        printed: format!("Table 1, Sec. 4.1: {printed} rad/s, the largest Fourier component"),
        computed: format!(
            "{}; the lines of a {length_s:.0} s record are {:.2} rad/s apart",
            ways.join("; "),
            TAU / length_s,
        ),
        how: format!(
            "search of sample rates from {:.0} to {:.0} Hz and lengths that are powers of two, \
             records of {:.0} to {:.0} s, for a line that rounds to {printed} rad/s; half a line \
             spacing as the uncertainty",
            SAMPLE_RATES_HZ[0],
            SAMPLE_RATES_HZ[SAMPLE_RATES_HZ.len() - 1],
            RECORD_S[0],
            RECORD_S[1],
        ),
    }
}

/// The growth of inertia that hangs on that frequency.
pub(super) fn inertia_erratum() -> Erratum {
    let percent = |error: f64| 100.0 * inertia_growth(error);
    let ranges: Vec<String> = bins_at_100_hz()
        .iter()
        .map(|bin| {
            let half = bin.half_width();
            format!("{:.0} to {:.0} % at +-{:.0} %", percent(half), percent(-half), 100.0 * half)
        })
        .collect();
    Erratum {
        title: "The growth of inertia with bilge keels is hardly known".to_owned(),
        printed: format!(
            "Sec. 4.1: an extremely large change of the natural frequency, from {} to {} rad/s",
            paper::NATURAL_FREQUENCY_BARE_RAD_S,
            paper::NATURAL_FREQUENCY_KEELS_RAD_S,
        ),
        computed: format!(
            "as printed the inertia grows by {:.0} %; with the width of the Fourier line it is {}",
            percent(0.0),
            ranges.join(", or "),
        ),
        how: "(I + dI) = K / w^2 with the same K, at both ends of the uncertainty of w".to_owned(),
    }
}

/// What a wrong natural frequency adds to the identified moment.
pub(super) fn loop_erratum() -> Erratum {
    let (w, error, roll_rad) = (paper::NATURAL_FREQUENCY_KEELS_RAD_S, 0.05, 0.1);
    let added_per_s2 = ((w * (1.0 + error)).powi(2) - w * w) * roll_rad;
    let row = paper::BILGE_KEELS[2];
    let rate = w * roll_rad;
    let damping_per_s2 = row.b1_per_s * rate + row.b3_s * rate.powi(3);
    Erratum {
        title: "A wrong natural frequency turns the damping curve into a loop".to_owned(),
        printed: "Sec. 4.1: only the natural frequency is needed, for simplicity from the spectrum"
            .to_owned(),
        computed: format!(
            "a frequency {:.0} % off adds {added_per_s2:.2} 1/s2 at {roll_rad} rad of roll, where \
             the damping is zero; the damping itself peaks at {damping_per_s2:.2} 1/s2 in that \
             swing",
            100.0 * error,
        ),
        how: format!(
            "(w_used^2 - w^2) phi is left in the identified moment; damping with bilge keels at \
             Fr {} and a roll rate of w phi",
            row.froude
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frequency_with_bilge_keels_is_line_5_or_10_at_100_hz() {
        let found: Vec<_> = bins_at_100_hz().iter().map(|b| (b.line, b.n_samples)).collect();
        assert_eq!(found, [(5, 512), (10, 1024), (20, 2048)]);
    }

    #[test]
    fn the_frequency_of_the_bare_hull_is_no_such_line() {
        // A period read to 0.01 s explains it instead: 2 pi / 0.910 s.
        assert!(bins_at(paper::NATURAL_FREQUENCY_BARE_RAD_S).is_empty());
        assert!((TAU / 0.910 - paper::NATURAL_FREQUENCY_BARE_RAD_S).abs() < 5e-4);
    }

    #[test]
    fn the_inertia_growth_of_27_percent_lies_between_5_and_56() {
        // Rounded to whole per cent, as the erratum states them.
        let percent = |error| (100.0 * inertia_growth(error)).round() as i64;
        assert_eq!([percent(0.0), percent(0.1), percent(-0.1)], [27, 5, 56]);
        assert_eq!([percent(0.05), percent(-0.05)], [15, 40]);
    }
}
