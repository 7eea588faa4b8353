//! What the tank can do, against which a run is checked.

/// What the run finder must know about model and tank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Greatest carriage speed [m/s], where known.
    pub carriage_max_speed_m_s: Option<f64>,
    /// Speed declared for the recording [m/s], used when no speed channel was recorded.
    pub declared_speed_m_s: Option<f64>,
    /// Length between perpendiculars `L` [m].
    pub length_pp_m: f64,
    /// Gravity `g` [m/s2].
    pub gravity_m_s2: f64,
}

/// Excess over the greatest speed that the calibration of a speed channel explains [-].
const SPEED_MARGIN: f64 = 1.02;

impl Limits {
    /// Why a run at `speed_m_s` is impossible, with `Fr = V / sqrt(g L)`; none when it is not.
    pub(super) fn too_fast(&self, speed_m_s: f64) -> Option<String> {
        let max_m_s = self.carriage_max_speed_m_s?;
        if speed_m_s.abs() <= SPEED_MARGIN * max_m_s {
            return None;
        }
        let unit_m_s = (self.gravity_m_s2 * self.length_pp_m).sqrt();
        Some(format!(
            "the pass is too fast: Fr {:.2} needs {:.2} m/s, the carriage does {max_m_s:.2} m/s \
             (Fr {:.3})",
            speed_m_s.abs() / unit_m_s,
            speed_m_s.abs(),
            max_m_s / unit_m_s
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn froude_one_in_a_tank_of_two_metres_a_second_is_refused_with_the_arithmetic() {
        let limits = Limits {
            carriage_max_speed_m_s: Some(2.0),
            declared_speed_m_s: None,
            length_pp_m: 2.5,
            gravity_m_s2: 9.81,
        };
        let reason = limits.too_fast(4.952).unwrap();
        assert!(
            reason.contains("Fr 1.00 needs 4.95 m/s, the carriage does 2.00 m/s (Fr 0.404)"),
            "{reason}"
        );
        assert_eq!(limits.too_fast(1.98), None);
    }
}
