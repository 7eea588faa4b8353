//! How well the times of a run's samples are known, as its instruments stated it.

/// Bounds of the times of the two channels of a run; none is stated where no instrument was read,
/// as in a table, or nobody has declared how late its filter makes it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Timing {
    /// The roll's times are at most so far off [s].
    pub roll_bound_s: Option<f64>,
    /// Those of the force or moment are at most so far off [s].
    pub drive_bound_s: Option<f64>,
    /// Whether both came in the same frames, so that they err together.
    pub is_common: bool,
}

impl Timing {
    /// Standard uncertainty of the time between roll and drive [s]: that of two independent
    /// rectangular distributions, `sqrt((d_roll^2 + d_drive^2)/3)` (GUM 4.3.7); nil where one
    /// frame brought both.
    pub fn skew_sd_s(&self) -> Option<f64> {
        if self.is_common {
            return Some(0.0);
        }
        Some(self.roll_bound_s?.hypot(self.drive_bound_s?) / 3.0_f64.sqrt())
    }

    /// The time between roll and drive is at most so far off [s].
    pub fn skew_bound_s(&self) -> Option<f64> {
        if self.is_common {
            return Some(0.0);
        }
        Some(self.roll_bound_s? + self.drive_bound_s?)
    }

    /// Standard uncertainty of the rate of the roll's clock over `span_s` [-]: each end of the
    /// stretch may be off by the bound.
    pub fn rate_sd(&self, span_s: f64) -> Option<f64> {
        self.roll_bound_s.map(|bound_s| bound_s * (2.0_f64 / 3.0).sqrt() / span_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_clocks_err_apart_and_one_does_not() {
        let mut timing =
            Timing { roll_bound_s: Some(3e-3), drive_bound_s: Some(4e-3), is_common: false };
        assert!((timing.skew_sd_s().unwrap() - 5e-3 / 3.0_f64.sqrt()).abs() < 1e-12);
        timing.is_common = true;
        assert_eq!(timing.skew_sd_s(), Some(0.0));
        assert_eq!(Timing::default().skew_sd_s(), None);
    }
}
