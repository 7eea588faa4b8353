//! Standing waves between the side walls of a tank.

/// The section of a tank of water.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Width [m].
    pub width_m: f64,
    /// Depth of the water [m]; none where it is deep.
    pub depth_m: Option<f64>,
}

/// Highest order that is looked at: waves of a twentieth of the width.
const MOST: usize = 41;

/// Frequencies [rad/s] of the antisymmetric modes, lowest first: a model amid the tank is rolled by
/// these, the odd ones of `w_n^2 = k g tanh(k d)`, `k = n pi/width`.
pub fn all(section: &Section, gravity_m_s2: f64) -> impl Iterator<Item = f64> {
    let Section { width_m, depth_m } = *section;
    (1..=MOST).step_by(2).map(move |n| {
        let number_per_m = n as f64 * std::f64::consts::PI / width_m;
        let bottom = depth_m.map_or(1.0, |depth_m| (number_per_m * depth_m).tanh());
        (number_per_m * gravity_m_s2 * bottom).sqrt()
    })
}

/// The antisymmetric mode nearest to a frequency [rad/s], and how far apart it and the next one on
/// that side are [rad/s].
pub fn nearest(frequency_rad_s: f64, section: &Section, gravity_m_s2: f64) -> (f64, f64) {
    let modes: Vec<f64> = all(section, gravity_m_s2).collect();
    let above = modes.partition_point(|mode| *mode < frequency_rad_s).clamp(1, modes.len() - 1);
    let [low, high] = [modes[above - 1], modes[above]];
    let is_low = frequency_rad_s - low < high - frequency_rad_s;
    let mode = if is_low { low } else { high };
    (mode, high - low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tank_of_ten_metres_has_the_cross_modes_of_its_width() {
        let section = Section { width_m: 10.0, depth_m: Some(5.0) };
        for mode_rad_s in [5.82, 6.33, 6.80, 7.24] {
            let (found, spacing) = nearest(mode_rad_s + 0.1, &section, 9.81);
            assert!((found - mode_rad_s).abs() < 0.01, "{found}");
            assert!((0.4..0.6).contains(&spacing), "{spacing}");
        }
    }

    #[test]
    fn shallow_water_slows_the_first_mode() {
        let at = |depth_m| nearest(1.0, &Section { width_m: 10.0, depth_m }, 9.81).0;
        assert!(at(Some(1.0)) < 0.6 * at(None));
    }
}
