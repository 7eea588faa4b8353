//! The step of a converter, read from the values that a channel takes.

/// Samples that are looked at: a lattice shows in a few.
const N_LOOKED_AT: usize = 2048;
/// How far a value may lie off the lattice, as a share of its step: what printed decimals leave.
const OFF_LATTICE: f64 = 0.02;
/// Values must repeat at least this often on average, or the lattice is finer than the noise.
const REPEATS: usize = 3;

/// The step between the values of a channel, in the values' unit; none when they are not on a
/// lattice or it is too fine to matter.
pub(super) fn quantum(values: &[f64]) -> Option<f64> {
    let mut sorted: Vec<f64> = values.iter().take(N_LOOKED_AT).copied().collect();
    sorted.sort_by(f64::total_cmp);
    let size = sorted[0].abs().max(sorted[sorted.len() - 1].abs());
    // Two values closer than a converter of 40 bits could tell apart are one.
    let same = size * 1e-12;
    sorted.dedup_by(|a, b| (*a - *b).abs() <= same);
    if sorted.len() < 2 || sorted.len() * REPEATS > values.len().min(N_LOOKED_AT) {
        return None;
    }
    let step = sorted.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    let is_on_it = |value: &f64| {
        let count = (value - sorted[0]) / step;
        (count - count.round()).abs() < OFF_LATTICE * count.max(1.0)
    };
    sorted.iter().all(is_on_it).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_converter_shows_its_step_and_a_smooth_channel_none() {
        let smooth: Vec<f64> = (0..1000).map(|i| (0.1 * f64::from(i)).sin()).collect();
        let stepped: Vec<f64> = smooth.iter().map(|v| (v / 0.02).round() * 0.02).collect();
        assert_eq!(quantum(&smooth), None);
        let step = quantum(&stepped).expect("a lattice");
        assert!((step - 0.02).abs() < 1e-12);
    }
}
