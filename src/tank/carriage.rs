//! The carriage in one pass: rest, speed-up, steady, braking, within the length of the tank.

use super::scenario::{Basin, CarriagePlan};

/// When the carriage does what; at zero speed it is steady throughout.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::struct_field_names, reason = "the names end in their units")]
pub(super) struct Carriage {
    /// Speed of the steady stretch [m/s].
    pub(super) speed_m_s: f64,
    /// Start of speeding up [s].
    pub(super) start_s: f64,
    /// Start of the steady stretch [s].
    pub(super) steady_s: f64,
    /// Start of braking [s].
    pub(super) brake_s: f64,
    /// Standstill [s].
    pub(super) stop_s: f64,
    shock_n_m_s: f64,
}

/// How long a jolt of the carriage lasts [s].
const SHOCK_LENGTH_S: f64 = 0.2;

impl Carriage {
    /// Plans a pass at `speed_m_s`.
    ///
    /// # Errors
    /// A sentence with the arithmetic when the tank is too short or the carriage too slow.
    pub(super) fn plan(basin: &Basin, plan: &CarriagePlan, speed_m_s: f64) -> Result<Self, String> {
        let still = Self {
            speed_m_s: 0.0,
            start_s: 0.0,
            steady_s: 0.0,
            brake_s: f64::INFINITY,
            stop_s: f64::INFINITY,
            shock_n_m_s: 0.0,
        };
        if speed_m_s == 0.0 {
            return Ok(still);
        }
        if speed_m_s > basin.carriage_max_speed_m_s {
            return Err(format!(
                "a speed of {speed_m_s:.3} m/s exceeds the carriage's {:.3} m/s",
                basin.carriage_max_speed_m_s
            ));
        }
        let speed_up_s = speed_m_s / basin.carriage_acceleration_m_s2;
        let braking_s = speed_m_s / basin.carriage_braking_m_s2;
        let way_m = basin.length_m - basin.end_margin_m;
        let steady_m = way_m - 0.5 * speed_m_s * (speed_up_s + braking_s);
        if steady_m <= 0.0 {
            return Err(format!(
                "reaching and leaving {speed_m_s:.3} m/s takes {:.2} m of the {way_m:.2} m the \
                 carriage can use",
                way_m - steady_m
            ));
        }
        let steady_s = plan.start_s + speed_up_s;
        let latest_s = steady_s + steady_m / speed_m_s;
        let brake_s = plan.brake_s.unwrap_or(latest_s);
        if brake_s > latest_s {
            return Err(format!(
                "braking at {brake_s:.2} s at {speed_m_s:.3} m/s overruns the tank: the steady \
                 {steady_m:.2} m end at {latest_s:.2} s"
            ));
        }
        if brake_s < steady_s {
            return Err(format!(
                "braking at {brake_s:.2} s comes before the speed is steady at {steady_s:.2} s"
            ));
        }
        Ok(Self {
            speed_m_s,
            start_s: plan.start_s,
            steady_s,
            brake_s,
            stop_s: brake_s + braking_s,
            shock_n_m_s: plan.shock_n_m_s,
        })
    }

    /// Speed at a time [m/s].
    pub(super) fn speed_m_s(&self, time_s: f64) -> f64 {
        if self.speed_m_s == 0.0 {
            return 0.0;
        }
        let up = (time_s - self.start_s) / (self.steady_s - self.start_s);
        let down = (self.stop_s - time_s) / (self.stop_s - self.brake_s);
        self.speed_m_s * up.min(down).clamp(0.0, 1.0)
    }

    /// Roll moment [N m] of the jolts: a half sine at each change of acceleration.
    pub(super) fn shock_n_m(&self, time_s: f64) -> f64 {
        if self.shock_n_m_s == 0.0 {
            return 0.0;
        }
        let jolts =
            [(self.start_s, 1.0), (self.steady_s, -1.0), (self.brake_s, -1.0), (self.stop_s, 1.0)];
        jolts
            .into_iter()
            .map(|(at, sign)| sign * half_sine(time_s - at, SHOCK_LENGTH_S, self.shock_n_m_s))
            .sum()
    }
}

/// A half-sine pulse of the given length and integral.
pub(super) fn half_sine(elapsed_s: f64, length_s: f64, integral: f64) -> f64 {
    if elapsed_s <= 0.0 || elapsed_s >= length_s {
        return 0.0;
    }
    let r = std::f64::consts::PI / length_s;
    0.5 * r * integral * (r * elapsed_s).sin()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASIN: Basin = Basin {
        length_m: 50.0,
        width_m: 10.0,
        depth_m: 5.0,
        carriage_max_speed_m_s: 2.0,
        end_margin_m: 8.0,
        carriage_acceleration_m_s2: 0.5,
        carriage_braking_m_s2: 0.5,
    };

    #[test]
    fn the_carriage_uses_the_tank_to_its_end_and_no_further() {
        let carriage = Carriage::plan(&BASIN, &CarriagePlan::default(), 1.98).unwrap();
        let step_s = 1e-3;
        let way_m: f64 =
            (0..60_000).map(|k| carriage.speed_m_s((f64::from(k) + 0.5) * step_s) * step_s).sum();
        // The midpoint rule is exact but at the four kinks: a_max * step^2 each.
        assert!((way_m - 42.0).abs() < 1e-5, "{way_m} m");
    }

    #[test]
    fn a_pass_that_overruns_the_tank_is_refused_with_the_arithmetic() {
        let plan = CarriagePlan { brake_s: Some(40.0), ..CarriagePlan::default() };
        let message = Carriage::plan(&BASIN, &plan, 1.98).unwrap_err();
        assert!(message.contains("overruns the tank"), "{message}");
        assert!(message.contains("34.16 m"), "{message}");
        let message = Carriage::plan(&BASIN, &plan, 4.95).unwrap_err();
        assert_eq!(message, "a speed of 4.950 m/s exceeds the carriage's 2.000 m/s");
    }

    #[test]
    fn a_half_sine_has_the_impulse_it_is_given() {
        let sum: f64 = (0..1000).map(|k| half_sine((f64::from(k) + 0.5) * 1e-4, 0.1, 2.5)).sum();
        assert!((sum * 1e-4 - 2.5).abs() < 1e-5);
    }
}
