//! Fewer points per curve, every peak kept.

/// Most points that are drawn of one curve.
pub(super) const POINTS_MAX: usize = 1500;

/// Most points that are drawn of one cloud, where each point costs a hundred bytes.
const CLOUD_MAX: usize = 800;

/// Indices of the lowest and the highest value of each of up to `POINTS_MAX / 2` stretches.
pub(super) fn peaks(value: &[f64]) -> Vec<usize> {
    if value.len() <= POINTS_MAX {
        return (0..value.len()).collect();
    }
    let mut kept = Vec::with_capacity(POINTS_MAX);
    for stretch in stretches(value.len(), POINTS_MAX / 2) {
        let lowest = stretch.clone().min_by(|&i, &j| value[i].total_cmp(&value[j]));
        let highest = stretch.max_by(|&i, &j| value[i].total_cmp(&value[j]));
        let (Some(lowest), Some(highest)) = (lowest, highest) else { continue };
        kept.push(lowest.min(highest));
        if lowest != highest {
            kept.push(lowest.max(highest));
        }
    }
    kept
}

/// A band as `(x, lowest, highest)` of each of up to `POINTS_MAX / 2` stretches.
pub(super) fn envelope(x: &[f64], lo: &[f64], hi: &[f64]) -> Vec<(f64, f64, f64)> {
    let n = x.len().min(lo.len()).min(hi.len());
    stretches(n, POINTS_MAX / 2)
        .map(|stretch| {
            let lowest = lo[stretch.clone()].iter().copied().fold(f64::INFINITY, f64::min);
            let highest = hi[stretch.clone()].iter().copied().fold(f64::NEG_INFINITY, f64::max);
            (x[(stretch.start + stretch.end - 1) / 2], lowest, highest)
        })
        .collect()
}

/// Indices of up to `CLOUD_MAX` points spread evenly through a cloud of `n`.
pub(super) fn cloud(n: usize) -> impl Iterator<Item = usize> {
    let n_kept = n.min(CLOUD_MAX);
    (0..n_kept).map(move |k| k * n / n_kept)
}

fn stretches(n: usize, n_max: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
    let count = n.min(n_max);
    (0..count).map(move |k| k * n / count..(k + 1) * n / count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_spike_in_a_long_record_survives_thinning() {
        let mut value = vec![0.0; 100_000];
        value[54_321] = 9.0;
        value[54_322] = -9.0;
        let kept = peaks(&value);
        assert!(kept.len() <= POINTS_MAX);
        assert!(kept.contains(&54_321) && kept.contains(&54_322));
        assert!(kept.is_sorted());
    }

    #[test]
    fn a_band_keeps_its_widest_place() {
        let x: Vec<f64> = (0..10_000).map(f64::from).collect();
        let lo = vec![-1.0; x.len()];
        let mut hi = vec![1.0; x.len()];
        hi[7_777] = 5.0;
        let envelope = envelope(&x, &lo, &hi);
        assert!(envelope.len() <= POINTS_MAX);
        assert!(envelope.iter().any(|&(_, _, high)| high >= 5.0));
    }
}
