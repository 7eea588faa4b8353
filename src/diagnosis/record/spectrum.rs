//! Power of a record at some frequencies, several at a time.

/// Frequencies that a processor takes side by side.
const SIDE_BY_SIDE: usize = 8;

/// Square of the sum of `v[i] exp(j a i)` for each angle `a` per sample.
pub(in crate::diagnosis) fn powers(values: &[f64], angles: &[f64]) -> Vec<f64> {
    let mut powers = Vec::with_capacity(angles.len() + SIDE_BY_SIDE);
    for angles in angles.chunks(SIDE_BY_SIDE) {
        let turn: [(f64, f64); SIDE_BY_SIDE] =
            std::array::from_fn(|k| angles.get(k).copied().unwrap_or(0.0).sin_cos());
        let (sin, cos) = (turn.map(|turn| turn.0), turn.map(|turn| turn.1));
        let (mut c, mut s) = ([1.0; SIDE_BY_SIDE], [0.0; SIDE_BY_SIDE]);
        let (mut re, mut im) = ([0.0; SIDE_BY_SIDE], [0.0; SIDE_BY_SIDE]);
        for value in values {
            for k in 0..SIDE_BY_SIDE {
                re[k] += value * c[k];
                im[k] += value * s[k];
                let next = c[k] * cos[k] - s[k] * sin[k];
                s[k] = s[k] * cos[k] + c[k] * sin[k];
                c[k] = next;
            }
        }
        powers.extend((0..angles.len()).map(|k| re[k] * re[k] + im[k] * im[k]));
    }
    powers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tone_has_its_power_at_its_own_frequency_alone() {
        let angle = |bin: usize| std::f64::consts::TAU * bin as f64 / 64.0;
        let values: Vec<f64> = (0..64).map(|i| (angle(5) * f64::from(i)).cos()).collect();
        let angles: Vec<f64> = (1..12).map(angle).collect();
        let powers = powers(&values, &angles);
        assert_eq!(powers.len(), 11);
        for (k, power) in powers.iter().enumerate() {
            let expected = if k == 4 { 32.0 * 32.0 } else { 0.0 };
            assert!((power - expected).abs() < 1e-9, "{k}: {power}");
        }
    }
}
