//! The part of a forced run in which nothing but the excitation repeats.

use std::ops::Range;

use super::harmonic::FourierSeries;

/// How many standard deviations a cycle may stray from the steady ones. Each of some twenty cycles
/// is tested twice, so four keeps a false cut below one run in a hundred.
const STRAY: f64 = 4.0;

/// Fewest cycles from which a phase is read.
const N_CYCLES_MIN: f64 = 3.0;

/// First and last instant [s] at which both roll and force are steady, times and values each.
///
/// The force is the sharper witness: a ramp that is too gentle to be seen in the roll still takes a
/// moment to accelerate the model. Half a cycle more is left out at both ends, because a cycle may
/// hide the last of a transient in its outer half.
///
/// # Errors
/// The reason, as a sentence, when one of them is not periodic or the two are not steady together.
pub fn both(
    roll: (&[f64], &[f64]),
    force: (&[f64], &[f64]),
    near_rad_s: f64,
) -> Result<(f64, f64), String> {
    let ends = |(time_s, value): (&[f64], &[f64])| -> Result<(f64, f64), String> {
        let (range, _) = stretch(time_s, value, near_rad_s)?;
        Ok((time_s[range.start], time_s[range.end - 1]))
    };
    let (roll_s, force_s) = (ends(roll)?, ends(force)?);
    let period_s = std::f64::consts::TAU / near_rad_s;
    let from_s = roll_s.0.max(force_s.0) + 0.5 * period_s;
    let to_s = roll_s.1.min(force_s.1) - 0.5 * period_s;
    let n_cycles = (to_s - from_s) / period_s;
    if n_cycles < N_CYCLES_MIN {
        return Err(format!(
            "roll and force are steady together for {:.1} cycles, {N_CYCLES_MIN} are needed",
            n_cycles.max(0.0)
        ));
    }
    Ok((from_s, to_s))
}

/// The samples of the longest steady stretch about the middle of a record, and its series.
///
/// The middle third is fitted first; cycles are then added at both ends as long as what they hold
/// beside the series is noise, so that a start-up transient or the ramp to another frequency, which
/// biases inertia and damping long before it can be seen, stays out.
///
/// # Errors
/// The reason, as a sentence, when not even the middle is periodic near `near_rad_s` [rad/s].
pub fn stretch(
    time_s: &[f64],
    value: &[f64],
    near_rad_s: f64,
) -> Result<(Range<usize>, FourierSeries), String> {
    let n = time_s.len();
    let period_s = std::f64::consts::TAU / near_rad_s;
    let cycle = time_s.partition_point(|t| t - time_s[0] < period_s).max(4);
    let middle = n / 2;
    let half = (n / 6).max(2 * cycle).min(n / 2);
    let mut range = middle - half..middle + half;
    let mut series = FourierSeries::fit(&time_s[range.clone()], &value[range.clone()], near_rad_s)?;
    loop {
        let mut wider = range.clone();
        let reach = (range.len() / 3).max(cycle);
        while wider.start >= cycle
            && range.start - wider.start < reach
            && steady(&series, time_s, value, wider.start - cycle..wider.start, &range)
        {
            wider.start -= cycle;
        }
        while wider.end + cycle <= n
            && wider.end - range.end < reach
            && steady(&series, time_s, value, wider.end..wider.end + cycle, &range)
        {
            wider.end += cycle;
        }
        if wider == range {
            return Ok((range, series));
        }
        range = wider;
        series = FourierSeries::fit(
            &time_s[range.clone()],
            &value[range.clone()],
            series.frequency_rad_s.mean,
        )?;
    }
}

/// Whether one cycle beside the fitted samples holds the series and noise, no more.
fn steady(
    series: &FourierSeries,
    time_s: &[f64],
    value: &[f64],
    cycle: Range<usize>,
    fitted: &Range<usize>,
) -> bool {
    let w = series.frequency_rad_s;
    let (mut cos, mut sin) = (0.0, 0.0);
    for i in cycle.clone() {
        let residual = value[i] - series.at(time_s[i]).value;
        cos += residual * (w.mean * time_s[i]).cos();
        sin += residual * (w.mean * time_s[i]).sin();
    }
    let count = cycle.len() as f64;
    let stray = 2.0 / count * cos.hypot(sin);
    // The fit's own errors grow away from its middle, in size and, with the frequency, in phase.
    let middle_s = 0.5 * (time_s[fitted.start] + time_s[fitted.end - 1]);
    let away_s = (0.5 * (time_s[cycle.start] + time_s[cycle.end - 1]) - middle_s).abs();
    let own = series.noise_sd * (2.0 / count).sqrt();
    let phase = series.amplitude() * w.sd * away_s;
    stray < STRAY * own.hypot(series.coefficient_sd).hypot(phase)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten seconds of a chirp into a steady oscillation of ten more, with a little noise.
    fn chirp_then_steady() -> (Vec<f64>, Vec<f64>) {
        let time_s: Vec<f64> = (0..2000).map(|i| f64::from(i) * 0.01).collect();
        let value = time_s
            .iter()
            .enumerate()
            .map(|(i, &t)| {
                let before = (6.0 - t).max(0.0);
                let noise = 1e-3 * ((i * 7919 % 97) as f64 / 48.0 - 1.0);
                (6.0 * t - 0.05 * before * before).cos() + noise
            })
            .collect();
        (time_s, value)
    }

    #[test]
    fn a_chirp_before_the_steady_part_is_left_out() {
        let (time_s, value) = chirp_then_steady();
        let (range, series) = stretch(&time_s, &value, 6.05).expect("it repeats");
        assert!((time_s[range.start] - 6.0).abs() < 1.1, "starts at {}", time_s[range.start]);
        assert!(time_s[range.end - 1] > 18.8);
        assert!((series.frequency_rad_s.mean - 6.0).abs() < 1e-3);
    }
}
