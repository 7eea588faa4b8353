//! Says what the noise of the roll channel can pretend.

/// No roll below 0.02 deg matters, however quiet the channel.
const FLOOR_RAD: f64 = 0.000_35;

/// What noise and quantum do to the roll.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[expect(clippy::struct_field_names, reason = "the unit is the same")]
pub(super) struct Ripple {
    /// Standard deviation of a smoothed bin [rad].
    pub(super) sd_rad: f64,
    /// Step of the digitiser [rad].
    pub(super) quantum_rad: f64,
    /// Roll amplitude [rad] below which the roll is lost in the noise of the samples.
    pub(super) lost_below_rad: f64,
}

impl Ripple {
    /// How far [rad] the roll must come back before a turning point is believed: noise reaches
    /// 6 sd in a few thousand bins.
    pub(super) fn hysteresis_rad(&self) -> f64 {
        (6.0 * self.sd_rad).max(2.0 * self.quantum_rad).max(FLOOR_RAD)
    }

    /// Greatest range [rad] of a model at rest within a few seconds.
    pub(super) fn quiet_range_rad(&self) -> f64 {
        (8.0 * self.sd_rad).max(2.2 * self.quantum_rad).max(FLOOR_RAD)
    }

    /// What noise can do to a ratio of amplitudes near `amplitude_rad` [-].
    pub(super) fn ratio_tolerance(&self, amplitude_rad: f64) -> f64 {
        (2.0 * self.sd_rad + 0.5 * self.quantum_rad) / amplitude_rad.max(FLOOR_RAD)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quiet_channel_still_has_a_floor_and_a_coarse_one_its_steps() {
        assert!((Ripple::default().hysteresis_rad() - FLOOR_RAD).abs() < 1e-12);
        let coarse = Ripple { quantum_rad: 0.002, ..Ripple::default() };
        assert!(coarse.hysteresis_rad() >= 2.0 * 0.002);
        assert!(coarse.quiet_range_rad() > coarse.hysteresis_rad());
    }

    #[test]
    fn noise_counts_more_for_a_small_roll() {
        let noisy = Ripple { sd_rad: 0.001, ..Ripple::default() };
        assert!(noisy.ratio_tolerance(0.02) > 5.0 * noisy.ratio_tolerance(0.2));
    }
}
