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

/// The antisymmetric mode nearest to a frequency [rad/s], and how far apart it and the next one on
/// that side are [rad/s]. A model amid the tank is rolled by these, the odd ones of
/// `w_n^2 = k g tanh(k d)`, `k = n pi/width`.
pub fn nearest(frequency_rad_s: f64, section: &Section, gravity_m_s2: f64) -> (f64, f64) {
    let mode_rad_s = |n: usize| {
        let number_per_m = n as f64 * std::f64::consts::PI / section.width_m;
        let bottom = section.depth_m.map_or(1.0, |depth_m| (number_per_m * depth_m).tanh());
        (number_per_m * gravity_m_s2 * bottom).sqrt()
    };
    let off = |n: &usize| (mode_rad_s(*n) - frequency_rad_s).abs();
    let odd = (1..=MOST).step_by(2);
    let n = odd.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(1);
    let mode = mode_rad_s(n);
    let next = if frequency_rad_s < mode && n > 1 { n - 2 } else { n + 2 };
    (mode, (mode_rad_s(next) - mode).abs())
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
