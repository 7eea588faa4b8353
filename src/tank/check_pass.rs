//! The physical limits of a pass and of what is done in it.

use super::action::Action;
use super::carriage::Carriage;
use super::check::{Checked, OVERDAMPED, Table, not_negative, positive, problem, within};
use super::scenario::{Condition, Damping, Pass, Scenario};

/// Longest recording [s]: an hour, so that a slip of the pen does not fill the disk.
const PASS_LENGTH_MAX_S: f64 = 3600.0;
/// Largest angle [rad]: the small-angle restoring of (2.1) is far off beyond it.
const ANGLE_MAX_RAD: f64 = std::f64::consts::FRAC_PI_4;
/// Largest value of an irregular excitation over its root mean square [-], nearly always.
const PEAK_OVER_RMS: f64 = 4.0;
/// Frequencies of an excitation [rad/s].
const FREQUENCY_RAD_S: (f64, f64) = (0.05, 100.0);
/// Most repeats of one pass.
const REPEAT_MAX: usize = 1000;

/// An angle in degrees as the file gave it, without the rounding of its way to radians and back.
fn as_written_deg(angle_rad: f64) -> f64 {
    (angle_rad.to_degrees() * 1e9).round() / 1e9
}

impl Scenario {
    /// Refuses a pass that the tank, the carriage or the model could not make.
    pub(super) fn check_pass(&self, table: Table, pass: &Pass) -> Checked {
        if !self.conditions.iter().any(|c| c.name == pass.condition) {
            let names: Vec<_> = self.conditions.iter().map(|c| format!("\"{}\"", c.name)).collect();
            let message = format!("condition \"{}\" is not in the file", pass.condition);
            return problem(table, message, &format!("conditions are {}", names.join(", ")));
        }
        match (pass.froude, pass.speed_m_s) {
            (Some(froude), None) => not_negative(table, "froude", froude)?,
            (None, Some(speed_m_s)) => not_negative(table, "speed_m_s", speed_m_s)?,
            _ => {
                let message = "a pass needs either froude or speed_m_s".to_owned();
                return problem(table, message, "give one of the two; 0.0 for a carriage at rest");
            }
        }
        within(table, "repeat", pass.repeat as f64, 1.0, REPEAT_MAX as f64)?;
        within(table, "static_heel_deg", as_written_deg(pass.static_heel_rad), -45.0, 45.0)?;
        not_negative(table, "declared_speed_m_s", pass.declared_speed_m_s.unwrap_or(0.0))?;
        not_negative(table, "carriage.start_s", pass.carriage.start_s)?;
        not_negative(table, "carriage.brake_s", pass.carriage.brake_s.unwrap_or(0.0))?;
        let speed_m_s = self.pass_speed_m_s(pass);
        if let Err(message) = Carriage::plan(&self.tank, &pass.carriage, speed_m_s) {
            return problem(table, message, &self.speed_hint(pass, speed_m_s));
        }
        self.check_damping_reaches(table, pass, speed_m_s)?;
        self.check_strength(table, pass)?;
        let duration_s: f64 = pass.actions.iter().map(Action::duration_s).sum();
        within(table, "the length of all actions [s]", duration_s, 1.0, PASS_LENGTH_MAX_S)?;
        for (at, action) in pass.actions.iter().enumerate() {
            check_action(table, at, action)?;
        }
        self.check_disturbances(table, pass)
    }

    /// The moment that heels the model to the largest angle allowed [N m].
    fn heeling_n_m(&self) -> f64 {
        let weight_n =
            self.water.density_kg_m3 * self.water.gravity_m_s2 * self.hull.displacement_m3;
        weight_n * self.hull.gm_m * ANGLE_MAX_RAD
    }

    /// Refuses moments and blows that would throw the model beyond the largest angle allowed.
    fn check_strength(&self, table: Table, pass: &Pass) -> Checked {
        let condition = self.conditions.iter().find(|c| c.name == pass.condition);
        let Some(condition) = condition else { return Ok(()) };
        let moment = self.heeling_n_m();
        // A blow gives the rate J/I, and that rate the amplitude J/(I w) = J w/K.
        let impulse = moment / condition.natural_frequency_rad_s;
        within(table, "carriage.shock_n_m_s", pass.carriage.shock_n_m_s, -impulse, impulse)?;
        for (at, action) in pass.actions.iter().enumerate() {
            let key = |name: &str| format!("action {}: {}.{name}", at + 1, action.name());
            match *action {
                Action::Strike { impulse_n_m_s, .. } => {
                    within(table, &key("impulse_n_m_s"), impulse_n_m_s, -impulse, impulse)?;
                }
                Action::Driven { moment_n_m, .. } | Action::DrivenSweep { moment_n_m, .. } => {
                    within(table, &key("moment_n_m"), moment_n_m, -moment, moment)?;
                }
                Action::DrivenIrregular { rms_n_m, .. } => {
                    within(table, &key("rms_n_m"), rms_n_m, 0.0, moment / PEAK_OVER_RMS)?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Refuses speeds that the damping says nothing about, or takes out of all proportion.
    fn check_damping_reaches(&self, table: Table, pass: &Pass, speed_m_s: f64) -> Checked {
        let root = (self.water.gravity_m_s2 * self.hull.length_pp_m).sqrt();
        let froude = speed_m_s / root;
        let condition = self.conditions.iter().find(|c| c.name == pass.condition);
        let Some(Condition { natural_frequency_rad_s, damping, .. }) = condition else {
            return Ok(());
        };
        let rows = match damping {
            Damping::Table(rows) => rows,
            Damping::Law(law) => {
                let b1_per_s = law.b0_per_s * (1.0 + law.kappa * froude * froude);
                let highest = OVERDAMPED * natural_frequency_rad_s;
                return within(table, "b1_per_s at this speed", b1_per_s, 0.0, highest);
            }
        };
        let (first, last) = (rows[0].froude, rows[rows.len() - 1].froude);
        // A speed turned into a Froude number and back may miss the row by its rounding.
        if froude >= first - 1e-9 && froude <= last + 1e-9 {
            return Ok(());
        }
        let message = format!(
            "Froude number {froude:.3} is outside the damping table of \"{}\", {first} to {last}",
            pass.condition
        );
        problem(table, message, "add a row to the table, or give the damping as a law")
    }

    fn speed_hint(&self, pass: &Pass, speed_m_s: f64) -> String {
        let root = (self.water.gravity_m_s2 * self.hull.length_pp_m).sqrt();
        pass.froude.map_or_else(
            || "slow down, brake earlier, or give [tank] more length".to_owned(),
            |froude| {
                format!(
                    "Froude number {froude} is {froude} x sqrt({} x {}) = {speed_m_s:.3} m/s; the \
                     carriage's limit is Froude number {:.3}",
                    self.water.gravity_m_s2,
                    self.hull.length_pp_m,
                    self.tank.carriage_max_speed_m_s / root
                )
            },
        )
    }

    fn check_disturbances(&self, table: Table, pass: &Pass) -> Checked {
        if let Some(waves) = pass.waves {
            within(table, "waves.moment_n_m", waves.moment_n_m, 0.0, self.heeling_n_m())?;
            positive(table, "waves.frequency_rad_s", waves.frequency_rad_s)?;
            positive(table, "waves.decay_s", waves.decay_s)?;
        }
        if let Some(vibration) = pass.vibration {
            not_negative(
                table,
                "vibration.amplitude_deg",
                as_written_deg(vibration.amplitude_rad),
            )?;
            positive(table, "vibration.frequency_hz", vibration.frequency_hz)?;
        }
        within(table, "zero.roll_deg", as_written_deg(pass.zero.roll_rad), -45.0, 45.0)?;
        let drift = as_written_deg(pass.zero.roll_drift_rad_per_s);
        within(table, "zero.roll_drift_deg_per_s", drift, -1.0, 1.0)?;
        within(table, "zero.force_n", pass.zero.force_n, -1e6, 1e6)?;
        within(table, "zero.moment_n_m", pass.zero.moment_n_m, -1e6, 1e6)?;
        for gap in &pass.gaps {
            not_negative(table, "gap.start_s", gap.start_s)?;
            positive(table, "gap.duration_s", gap.duration_s)?;
            let Some(channel) = gap.channel.as_deref() else { continue };
            let recorded = self.instruments.recorded();
            if !recorded.iter().any(|(quantity, _)| quantity.name() == channel) {
                let names: Vec<_> = recorded.iter().map(|(q, _)| q.name()).collect();
                let message = format!("gap.channel = \"{channel}\" is not recorded");
                return problem(table, message, &format!("recorded are {}", names.join(", ")));
            }
        }
        Ok(())
    }
}

fn check_action(table: Table, at: usize, action: &Action) -> Checked {
    let length_s = action.duration_s();
    let key = |name: &str| format!("action {}: {}.{name}", at + 1, action.name());
    positive(table, &key("duration_s"), length_s)?;
    let highest_deg = as_written_deg(ANGLE_MAX_RAD);
    let part = |name: &str, part_s: f64| within(table, &key(name), part_s, 1e-3, length_s);
    let (lowest, highest) = FREQUENCY_RAD_S;
    let frequency = |name: &str, rad_s: f64| within(table, &key(name), rad_s, lowest, highest);
    if let Some(band) = action.band() {
        frequency("from_rad_s", band.from_rad_s)?;
        frequency("to_rad_s", band.to_rad_s)?;
    }
    match *action {
        Action::Rest { .. } => Ok(()),
        Action::Hold { heel_rad, ramp_s, tremor_rad, .. } => {
            within(table, &key("heel_deg"), as_written_deg(heel_rad), -highest_deg, highest_deg)?;
            within(table, &key("tremor_deg"), as_written_deg(tremor_rad), 0.0, 5.0)?;
            part("ramp_s", ramp_s)
        }
        Action::Rock { amplitude_rad, frequency_rad_s, .. } => {
            within(table, &key("amplitude_deg"), as_written_deg(amplitude_rad), 0.01, highest_deg)?;
            frequency("frequency_rad_s", frequency_rad_s)
        }
        Action::Release { fade_s, .. } => within(table, &key("fade_s"), fade_s, 0.0, length_s),
        Action::Strike { blow_s, .. } => part("blow_s", blow_s),
        Action::Catch { damping_ratio, .. } => {
            within(table, &key("damping_ratio"), damping_ratio, 0.1, 10.0)
        }
        Action::Forced { amplitude_rad, frequency_rad_s, ramp_s, .. } => {
            within(table, &key("amplitude_deg"), as_written_deg(amplitude_rad), 0.01, highest_deg)?;
            frequency("frequency_rad_s", frequency_rad_s)?;
            part("ramp_s", ramp_s)
        }
        Action::ForcedSweep { amplitude_rad, ramp_s, .. } => {
            within(table, &key("amplitude_deg"), as_written_deg(amplitude_rad), 0.01, highest_deg)?;
            part("ramp_s", ramp_s)
        }
        Action::ForcedIrregular { rms_rad, from_rad_s, to_rad_s, ramp_s, .. } => {
            let highest_deg = highest_deg / PEAK_OVER_RMS;
            within(table, &key("rms_deg"), as_written_deg(rms_rad), 0.01, highest_deg)?;
            within(table, &key("to_rad_s"), to_rad_s, from_rad_s, highest)?;
            part("ramp_s", ramp_s)
        }
        Action::DrivenIrregular { from_rad_s, to_rad_s, ramp_s, .. } => {
            within(table, &key("to_rad_s"), to_rad_s, from_rad_s, highest)?;
            part("ramp_s", ramp_s)
        }
        Action::Stop { ramp_s, .. } | Action::DrivenSweep { ramp_s, .. } => part("ramp_s", ramp_s),
        Action::Driven { frequency_rad_s, ramp_s, .. } => {
            frequency("frequency_rad_s", frequency_rad_s)?;
            part("ramp_s", ramp_s)
        }
    }
}
