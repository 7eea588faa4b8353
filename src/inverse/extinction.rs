//! Coefficients of extinction `p`, `q`: the loss of amplitude of a decay against its amplitude.

use serde::Serialize;

use super::estimate::Estimate;
use super::identification::Identification;
use super::scattered::{combination, never_nil, nodes};
use crate::run::RunKind;

/// `dphi / phi_m = p + q phi_m` over FULL cycles, the convention of MARIN.
///
/// From it, with `A` the total inertia and `T` the period, `B44 = 2 (p + q phi_a) A / T`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Extinction {
    /// Relative loss per full cycle at no amplitude `p` [-].
    pub p: Estimate,
    /// Its growth with amplitude `q` [1/deg].
    pub q_per_deg: Estimate,
    /// Half cycles that it rests on.
    pub n_half_cycles: usize,
}

/// Half cycles that a line and the scatter about it need.
const N_NEEDED: usize = 4;

/// The line through the half cycles of a decay; none of a forced run or of too few of them.
///
/// A half cycle loses `dphi / phi_m = pi b_eq / (2 w)`, a full one twice that; how far the half
/// cycles scatter about the line beyond their noise is unknown and widens the intervals.
pub fn extinction(identification: &Identification) -> Option<Extinction> {
    if identification.kind != RunKind::Decay {
        return None;
    }
    let natural_rad_s = identification.natural_frequency_rad_s.mean;
    let (mut rows, mut losses) = (Vec::new(), Vec::new());
    for half in &identification.half_cycles {
        let loss = half.equivalent_damping_per_s.scaled(std::f64::consts::PI / natural_rad_s);
        if loss.mean.is_finite() && loss.sd.is_finite() && loss.sd > 0.0 {
            rows.push(vec![1.0, half.amplitude_rad.to_degrees()]);
            losses.push((loss.mean, loss.sd));
        }
    }
    if rows.len() < N_NEEDED {
        return None;
    }
    let nodes = never_nil(nodes(&rows, &losses), &losses);
    Some(Extinction {
        p: combination(&nodes, &[1.0, 0.0]),
        q_per_deg: combination(&nodes, &[0.0, 1.0]),
        n_half_cycles: rows.len(),
    })
}
