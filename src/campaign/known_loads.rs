//! A channel's zero and curve from known loads, and how far the curve is off them.

use devices::channel::Curve;
use faer::Mat;
use faer::prelude::SolveLstsq;

/// What an instrument read under a known load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loaded {
    /// The load, in the quantity's SI unit.
    pub load: f64,
    /// Mean raw reading.
    pub raw: f64,
}

/// The form of a curve that loads are to give.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurveForm {
    /// A straight line.
    Gain,
    /// A polynomial in the raw reading.
    Polynomial {
        /// Its highest power.
        degree: usize,
    },
    /// Straight from each load to the next.
    Table,
}

/// A zero and a curve that loads have given.
#[derive(Debug, Clone, PartialEq)]
pub struct FromLoads {
    /// Raw reading of no load.
    pub zero_raw: f64,
    /// From the raw reading less its zero to SI.
    pub curve: Curve,
    /// How far it is off a load at most, in SI; none where a curve of this form goes through any
    /// such loads, and they tell nothing of it.
    pub deviation: Option<f64>,
}

/// Loads that give no curve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LoadsError {
    /// Too few of them differ.
    #[error(
        "different loads: {got}, this curve needs {needed} at least\nhint: apply more loads, or \
         take a simpler curve"
    )]
    Few {
        /// How many differ.
        got: usize,
        /// How many are needed.
        needed: usize,
    },
    /// Two loads, or two readings, that no curve parts.
    #[error(
        "the curve turns back at raw {raw}, load {load} (SI): between its loads a reading must \
         belong to one load\nhint: look for a load that was entered wrongly or had not settled, or \
         take a simpler curve"
    )]
    Turns {
        /// Raw reading at which it does.
        raw: f64,
        /// The load there, in SI.
        load: f64,
    },
    /// A curve that is nowhere zero near its loads.
    #[error("the curve has no zero near its loads\nhint: apply loads on both sides of none")]
    NoZero,
}

/// The zero and the curve of such a form from loads in any order, each applied once or more.
///
/// # Errors
/// [`LoadsError`] with what the loads lack.
pub fn curve_from_loads(form: CurveForm, loads: &[Loaded]) -> Result<FromLoads, LoadsError> {
    let means = mean_of_each_load(loads);
    let needed = match form {
        CurveForm::Gain | CurveForm::Table => 2,
        CurveForm::Polynomial { degree } => degree + 1,
    };
    if means.len() < needed {
        return Err(LoadsError::Few { got: means.len(), needed });
    }
    let (zero_raw, curve) = match form {
        CurveForm::Gain => line(loads).map(|(zero_raw, gain)| (zero_raw, Curve::Gain(gain)))?,
        CurveForm::Polynomial { degree } => polynomial(loads, degree)?,
        CurveForm::Table => table(&means)?,
    };
    let told_apart = match form {
        CurveForm::Table => loads.len() > means.len(),
        CurveForm::Gain | CurveForm::Polynomial { .. } => loads.len() > needed,
    };
    let deviation = told_apart.then(|| {
        let off = |loaded: &Loaded| (curve.value(loaded.raw - zero_raw) - loaded.load).abs();
        loads.iter().map(off).fold(0.0, f64::max)
    });
    Ok(FromLoads { zero_raw, curve, deviation })
}

/// Each load with the mean of its readings, the smallest load first.
fn mean_of_each_load(loads: &[Loaded]) -> Vec<Loaded> {
    let mut sorted = loads.to_vec();
    sorted.sort_by(|one, other| one.load.total_cmp(&other.load));
    let alike = sorted.chunk_by(|one, other| one.load.total_cmp(&other.load).is_eq());
    let mean = |alike: &[Loaded]| Loaded {
        load: alike[0].load,
        raw: alike.iter().map(|loaded| loaded.raw).sum::<f64>() / alike.len() as f64,
    };
    alike.map(mean).collect()
}

/// Zero and gain of the straight line: loads are known and readings scatter, so that the reading is
/// fitted on the load, and turned round.
fn line(loads: &[Loaded]) -> Result<(f64, f64), LoadsError> {
    let n = loads.len() as f64;
    let mean_raw = loads.iter().map(|loaded| loaded.raw).sum::<f64>() / n;
    let mean_load = loads.iter().map(|loaded| loaded.load).sum::<f64>() / n;
    let product = |loaded: &Loaded| (loaded.raw - mean_raw) * (loaded.load - mean_load);
    let spread: f64 = loads.iter().map(|loaded| (loaded.load - mean_load).powi(2)).sum();
    let gain = spread / loads.iter().map(product).sum::<f64>();
    if !gain.is_finite() {
        return Err(LoadsError::Turns { raw: mean_raw, load: mean_load });
    }
    Ok((mean_raw - mean_load / gain, gain))
}

/// The polynomial of least squares, about the reading at which it is zero.
fn polynomial(loads: &[Loaded], degree: usize) -> Result<(f64, Curve), LoadsError> {
    let raw = |fold: fn(f64, f64) -> f64, first| loads.iter().map(|l| l.raw).fold(first, fold);
    let (low, high) = (raw(f64::min, f64::INFINITY), raw(f64::max, f64::NEG_INFINITY));
    // In units of the loads' own range, where its powers are of one size.
    let (middle, half) = (f64::midpoint(low, high), (high - low) / 2.0);
    let powers = Mat::from_fn(loads.len(), degree + 1, |row, power| {
        ((loads[row].raw - middle) / half).powi(power as i32)
    });
    let wanted = Mat::from_fn(loads.len(), 1, |row, _| loads[row].load);
    let solved = powers.col_piv_qr().solve_lstsq(&wanted);
    let mut about: Vec<f64> = (0..=degree).map(|power| solved[(power, 0)]).collect();
    if !about.iter().all(|coefficient| coefficient.is_finite()) {
        return Err(LoadsError::Turns { raw: middle, load: loads[0].load });
    }
    let zero = zero_of(&about, (line(loads)?.0 - middle) / half)?;
    let (from, to) = (zero.min(-1.0), zero.max(1.0));
    let steps = (0..=200).map(|k| from + (to - from) * f64::from(k) / 200.0);
    let rising = slope(&about, zero) > 0.0;
    if let Some(at) = steps.into_iter().find(|at| (slope(&about, *at) > 0.0) != rising) {
        return Err(LoadsError::Turns { raw: middle + half * at, load: value(&about, at) });
    }
    shift(&mut about, zero);
    about[0] = 0.0;
    let mut unit = 1.0;
    for coefficient in &mut about {
        *coefficient /= unit;
        unit *= half;
    }
    Ok((middle + half * zero, Curve::Polynomial(about)))
}

fn value(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

fn slope(coefficients: &[f64], x: f64) -> f64 {
    let powers = coefficients.iter().enumerate().skip(1).rev();
    powers.fold(0.0, |sum, (power, coefficient)| sum * x + power as f64 * coefficient)
}

/// Newton's zero of a polynomial, from that of the straight line.
fn zero_of(coefficients: &[f64], mut x: f64) -> Result<f64, LoadsError> {
    const N_STEPS: usize = 50;
    for _ in 0..N_STEPS {
        let step = value(coefficients, x) / slope(coefficients, x);
        x -= step;
        if step.abs() < 1e-12 {
            return Ok(x);
        }
    }
    Err(LoadsError::NoZero)
}

/// The same polynomial in `x - about`: Horner's scheme, once for each power.
fn shift(coefficients: &mut [f64], about: f64) {
    for first in 0..coefficients.len() {
        for power in (first..coefficients.len() - 1).rev() {
            coefficients[power] += about * coefficients[power + 1];
        }
    }
}

/// Pairs in the order of their readings, less the reading of no load.
fn table(means: &[Loaded]) -> Result<(f64, Curve), LoadsError> {
    let mut pairs: Vec<[f64; 2]> = means.iter().map(|loaded| [loaded.raw, loaded.load]).collect();
    pairs.sort_by(|one, other| one[0].total_cmp(&other[0]));
    let rising = pairs[pairs.len() - 1][1] > pairs[0][1];
    let turns = |two: &&[[f64; 2]]| two[0][0] >= two[1][0] || (two[1][1] > two[0][1]) != rising;
    if let Some(two) = pairs.windows(2).find(turns) {
        return Err(LoadsError::Turns { raw: two[1][0], load: two[1][1] });
    }
    let after = pairs.partition_point(|[_, load]| (*load < 0.0) == rising && *load != 0.0);
    let after = after.clamp(1, pairs.len() - 1);
    let ([x0, y0], [x1, y1]) = (pairs[after - 1], pairs[after]);
    let zero_raw = x0 - y0 * (x1 - x0) / (y1 - y0);
    for pair in &mut pairs {
        pair[0] -= zero_raw;
    }
    Ok((zero_raw, Curve::Table(pairs)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Readings of a cell that bends: 102 counts of nothing, 0.05 N a count at first.
    fn bent(raw: f64) -> f64 {
        let x = raw - 102.0;
        0.05 * x + 2e-6 * x * x - 3e-10 * x * x * x
    }

    fn loads(raw: &[f64], of: fn(f64) -> f64) -> Vec<Loaded> {
        raw.iter().map(|raw| Loaded { load: of(*raw), raw: *raw }).collect()
    }

    fn off(from: &FromLoads, raw: f64, load: f64) -> f64 {
        (from.curve.value(raw - from.zero_raw) - load).abs()
    }

    #[test]
    fn a_line_gives_zero_and_gain_and_two_loads_tell_nothing_of_it() {
        let line = |raw: f64| 0.1 * (raw - 102.0);
        let from = curve_from_loads(CurveForm::Gain, &loads(&[102.0, 202.0, 2.0], line)).unwrap();
        assert!(matches!(from.curve, Curve::Gain(gain) if (gain - 0.1).abs() < 1e-12));
        assert!((from.zero_raw - 102.0).abs() < 1e-9 && from.deviation.unwrap() < 1e-9);
        let two = curve_from_loads(CurveForm::Gain, &loads(&[102.0, 202.0], line)).unwrap();
        assert_eq!(two.deviation, None);
        let same = loads(&[5.0, 5.0], |_| 1.0);
        let told = curve_from_loads(CurveForm::Gain, &same).unwrap_err();
        assert_eq!(told, LoadsError::Few { got: 1, needed: 2 });
        let [one, mut other] = [Loaded { load: 0.0, raw: 7.0 }; 2];
        other.load = 3.0;
        let told = curve_from_loads(CurveForm::Gain, &[one, other]).unwrap_err();
        assert!(matches!(told, LoadsError::Turns { .. }), "{told}");
    }

    #[test]
    fn a_bent_cell_is_followed_by_a_cubic_and_a_line_says_how_far_it_is_off() {
        let applied = loads(&[-3000.0, -1500.0, 102.0, 1500.0, 3000.0, 4500.0], bent);
        let cubic = curve_from_loads(CurveForm::Polynomial { degree: 3 }, &applied).unwrap();
        assert!((cubic.zero_raw - 102.0).abs() < 1e-6, "{cubic:?}");
        for raw in [-2900.0, 0.0, 102.0, 4000.0] {
            assert!(off(&cubic, raw, bent(raw)) < 1e-8, "{raw}: {cubic:?}");
        }
        assert!(cubic.deviation.unwrap() < 1e-9);
        let line = curve_from_loads(CurveForm::Gain, &applied).unwrap();
        assert!(line.deviation.unwrap() > 5.0, "{line:?}");
        let few = curve_from_loads(CurveForm::Polynomial { degree: 3 }, &applied[..3]).unwrap_err();
        assert_eq!(few, LoadsError::Few { got: 3, needed: 4 });
    }

    #[test]
    fn a_table_passes_through_the_mean_of_each_load_and_tells_what_came_back_otherwise() {
        let mut applied = loads(&[102.0, 1500.0, 3000.0], bent);
        let alone = curve_from_loads(CurveForm::Table, &applied).unwrap();
        assert!(alone.deviation.is_none() && off(&alone, 102.0, 0.0) < 1e-12, "{alone:?}");
        // The same load on the way down, 20 counts above the way up.
        applied.push(Loaded { raw: 1520.0, ..applied[1] });
        let both = curve_from_loads(CurveForm::Table, &applied).unwrap();
        assert!(off(&both, 1510.0, bent(1500.0)) < 1e-9, "{both:?}");
        assert!((0.3..0.8).contains(&both.deviation.unwrap()), "{both:?}");
    }

    #[test]
    fn a_table_of_falling_loads_has_its_zero_between_them() {
        let falling = |raw: f64| -0.2 * (raw - 40.0);
        for raw in [&[10.0, 20.0, 60.0, 90.0][..], &[50.0, 60.0], &[10.0, 20.0], &[0.0, 40.0]] {
            let from = curve_from_loads(CurveForm::Table, &loads(raw, falling)).unwrap();
            assert!((from.zero_raw - 40.0).abs() < 1e-9, "{raw:?}: {from:?}");
            assert!(off(&from, 55.0, falling(55.0)) < 1e-9, "{raw:?}: {from:?}");
        }
    }

    #[test]
    fn a_curve_that_turns_back_is_refused_where_it_does() {
        let mut applied = loads(&[0.0, 100.0, 200.0, 300.0], |raw| raw);
        applied[2].load = 350.0;
        let told = curve_from_loads(CurveForm::Table, &applied).unwrap_err();
        assert_eq!(told, LoadsError::Turns { raw: 300.0, load: 300.0 });
        let parabola = loads(&[0.0, 1.0, 2.0, 3.0, 4.0], |raw| raw * (3.0 - raw));
        let told = curve_from_loads(CurveForm::Polynomial { degree: 2 }, &parabola).unwrap_err();
        assert!(matches!(told, LoadsError::Turns { .. } | LoadsError::NoZero), "{told}");
    }
}
