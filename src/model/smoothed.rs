//! A motion from noisy readings of a roll, each instant by the sine that rolls through it.

/// Readings that a window must have.
pub(super) const LEAST_READINGS: usize = 12;
/// Numbers that each window is fitted with.
const N_NUMBERS: usize = 6;
/// Share of its square below which a column is made of those before it [-].
const NOTHING_NEW: f64 = 1e-9;

/// Roll, roll rate and roll acceleration [rad, rad/s, rad/s2] at some times [s], from readings
/// [rad] at theirs, of which there are [`LEAST_READINGS`] at least: by least squares over a window
/// [s] a sine of the frequency [rad/s] at which rod or model roll, whose amplitude and phase drift,
/// beside a drift. At the ends the window is not about its time.
///
/// Second differences of neighbouring readings are mostly noise, and so are the accelerations of a
/// polynomial through a window: a mode that is hardly damped would ring with them.
pub(super) fn motion(
    time_s: &[f64],
    readings_rad: &[f64],
    at_s: &[f64],
    (window_s, rolling_rad_s): (f64, f64),
) -> Vec<[f64; 3]> {
    let n = time_s.len();
    let (first_s, last_s) = (time_s[0], time_s[n - 1]);
    let one = |at_s: &f64| {
        let from_s = (at_s - 0.5 * window_s).min(last_s - window_s).max(first_s);
        let place = |t: f64| time_s.partition_point(|time_s| *time_s < t);
        let (from, to) = (place(from_s), place(from_s + window_s));
        let lacking = LEAST_READINGS.saturating_sub(to - from);
        let from = from.saturating_sub(lacking.div_ceil(2)).min(n - LEAST_READINGS);
        let to = to.max(from + LEAST_READINGS).min(n);
        let since_s = time_s[from..to].iter().map(|t| t - at_s);
        fitted(since_s, &readings_rad[from..to], rolling_rad_s)
    };
    at_s.iter().map(one).collect()
}

/// Value, rate and acceleration at time nought, by Gram and Schmidt: each column of the fit is
/// made orthogonal to those before it, together with what it is at time nought.
fn fitted(time_s: impl Iterator<Item = f64>, readings: &[f64], rolling_rad_s: f64) -> [f64; 3] {
    let w = rolling_rad_s;
    let rows = time_s.map(|t| {
        let (sin, cos) = (w * t).sin_cos();
        [1.0, w * t, cos, sin, w * t * cos, w * t * sin]
    });
    let mut columns = [(); N_NUMBERS].map(|()| Vec::with_capacity(readings.len()));
    for row in rows {
        columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }
    // The same at time nought, with two derivatives.
    let mut there = [
        [1.0, 0.0, 0.0],
        [0.0, w, 0.0],
        [1.0, 0.0, -w * w],
        [0.0, w, 0.0],
        [0.0, w, 0.0],
        [0.0, 0.0, 2.0 * w * w],
    ];
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut squares = [0.0; N_NUMBERS];
    let mut motion = [0.0; 3];
    for k in 0..N_NUMBERS {
        let (known, new) = columns.split_at_mut(k);
        let new = &mut new[0];
        let whole = dot(new, new);
        for j in (0..k).filter(|j| squares[*j] > 0.0) {
            let share = dot(new, &known[j]) / squares[j];
            new.iter_mut().zip(&known[j]).for_each(|(new, known)| *new -= share * known);
            there[k] = [0, 1, 2].map(|d| there[k][d] - share * there[j][d]);
        }
        let square = dot(new, new);
        if square > NOTHING_NEW * whole {
            squares[k] = square;
            let coefficient = dot(new, readings) / square;
            motion.iter_mut().zip(there[k]).for_each(|(motion, q)| *motion += coefficient * q);
        }
    }
    motion
}

#[cfg(test)]
mod tests {
    use super::*;

    const W: f64 = 7.0;

    #[test]
    fn a_sine_that_grows_is_what_it_is_up_to_both_ends_at_any_times() {
        let roll = |t: &f64| 0.02 - 0.01 * t + 0.1 * t * (W * t).sin();
        let truth = |t: f64| {
            let (sin, cos) = (W * t).sin_cos();
            [-0.01 + 0.1 * (sin + W * t * cos), 0.1 * (2.0 * W * cos - W * W * t * sin)]
        };
        let at_s: Vec<f64> = (0..60).map(|k| 0.05 * f64::from(k)).collect();
        for n in [40, 300] {
            let uneven = |k: u32| 3.0 * (f64::from(k) + 0.3 * f64::from(k).sin()) / f64::from(n);
            let time_s: Vec<f64> = (0..n).map(uneven).collect();
            let readings: Vec<f64> = time_s.iter().map(roll).collect();
            let all = motion(&time_s, &readings, &at_s, (1.3, W));
            for (t, told) in at_s.iter().zip(all) {
                let [rate, acceleration] = truth(*t);
                let off = [told[0] - roll(t), told[1] - rate, told[2] - acceleration];
                assert!(off.iter().all(|off| off.abs() < 1e-8), "{off:?} at {t} of {n}");
            }
        }
    }

    #[test]
    fn noise_hardly_reaches_the_acceleration() {
        let mut state = 1_u64;
        let mut noise = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5
        };
        let readings: Vec<f64> = (0..2000).map(|_| noise()).collect();
        let time_s: Vec<f64> = (0..2000).map(|k| 0.01 * f64::from(k)).collect();
        let square = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>();
        let raw = square(&mut readings.windows(3).map(|r| (r[0] - 2.0 * r[1] + r[2]) * 1e4));
        let all = motion(&time_s, &readings, &time_s, (1.3, W));
        let smooth = square(&mut all.iter().map(|[.., a]| *a));
        assert!((smooth / raw).sqrt() < 2e-3, "{smooth} of {raw} is left");
    }
}
