//! The physical limits that every scenario must keep.

use super::action::Action;
use super::carriage::Carriage;
use super::instruments::{FileFormat, Instrument};
use super::scenario::{Condition, Damping, Pass, Scenario};

/// A table of the scenario file: `[hull]` is `("hull", None)`, the third pass `("pass", Some(2))`.
pub(super) type Table = (&'static str, Option<usize>);

/// What a scenario gets wrong, and where.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Problem {
    /// The table that holds the mistake.
    pub(super) table: Table,
    /// The mistake, with its value and its limit.
    pub(super) message: String,
    /// How to mend it.
    pub(super) hint: String,
}

type Checked = Result<(), Problem>;

/// Longest recording [s]: an hour, so that a slip of the pen does not fill the disk.
const PASS_LENGTH_MAX_S: f64 = 3600.0;
/// Largest angle [rad]: the small-angle restoring of (2.1) is far off beyond it.
const ANGLE_MAX_RAD: f64 = std::f64::consts::FRAC_PI_4;
/// Highest sample rate [Hz].
const SAMPLE_RATE_MAX_HZ: f64 = 20_000.0;
/// Most repeats of one pass.
const REPEAT_MAX: usize = 1000;

fn problem(table: Table, message: String, hint: &str) -> Checked {
    Err(Problem { table, message, hint: hint.to_owned() })
}

/// Refuses any value that is not inside the closed range.
fn within(table: Table, key: &str, value: f64, lowest: f64, highest: f64) -> Checked {
    if value >= lowest && value <= highest {
        return Ok(());
    }
    let message = format!("{key} = {value} is outside {lowest} to {highest}");
    problem(table, message, "values are in the unit that the key ends with")
}

/// Refuses any value that is not a positive number.
fn positive(table: Table, key: &str, value: f64) -> Checked {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    problem(table, format!("{key} = {value} is not positive"), "give a number above zero")
}

/// Refuses any value that is negative or not a number.
fn not_negative(table: Table, key: &str, value: f64) -> Checked {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    problem(table, format!("{key} = {value} is negative"), "give zero or a number above it")
}

/// An angle in degrees as the file gave it, without the rounding of its way to radians and back.
fn as_written_deg(angle_rad: f64) -> f64 {
    (angle_rad.to_degrees() * 1e9).round() / 1e9
}

impl Scenario {
    /// The first mistake in the scenario, if there is one.
    pub(super) fn check_tables(&self) -> Checked {
        let hull = ("hull", None);
        positive(hull, "length_pp_m", self.hull.length_pp_m)?;
        positive(hull, "beam_m", self.hull.beam_m)?;
        positive(hull, "draft_m", self.hull.draft_m)?;
        positive(hull, "displacement_m3", self.hull.displacement_m3)?;
        positive(hull, "gm_m", self.hull.gm_m)?;
        positive(("water", None), "density_kg_m3", self.water.density_kg_m3)?;
        positive(("water", None), "gravity_m_s2", self.water.gravity_m_s2)?;
        self.check_tank()?;
        self.check_instruments()?;
        if self.conditions.is_empty() || self.passes.is_empty() {
            let hint = "add a [[condition]] and a [[pass]]; docs/scenario.md has an example";
            return problem(("condition", None), "no condition or no pass".to_owned(), hint);
        }
        for (at, condition) in self.conditions.iter().enumerate() {
            let table = ("condition", Some(at));
            if self.conditions[..at].iter().any(|other| other.name == condition.name) {
                let message = format!("condition \"{}\" is given twice", condition.name);
                return problem(table, message, "give each condition a name of its own");
            }
            check_condition(table, condition)?;
        }
        for (at, pass) in self.passes.iter().enumerate() {
            self.check_pass(("pass", Some(at)), pass)?;
        }
        self.check_names()
    }

    fn check_tank(&self) -> Checked {
        let (table, basin) = (("tank", None), &self.tank);
        positive(table, "length_m", basin.length_m)?;
        positive(table, "width_m", basin.width_m)?;
        positive(table, "depth_m", basin.depth_m)?;
        positive(table, "carriage_max_speed_m_s", basin.carriage_max_speed_m_s)?;
        positive(table, "carriage_acceleration_m_s2", basin.carriage_acceleration_m_s2)?;
        positive(table, "carriage_braking_m_s2", basin.carriage_braking_m_s2)?;
        within(table, "end_margin_m", basin.end_margin_m, 0.0, basin.length_m)?;
        self.exciter.map_or(Ok(()), |s| positive(("exciter", None), "moment_arm_m", s.moment_arm_m))
    }

    fn check_instruments(&self) -> Checked {
        let table = ("instruments", None);
        let channels = self.instruments.recorded();
        for (quantity, instrument) in &channels {
            let Instrument { sample_rate_hz, noise, quantum, time_jitter_s, clock_offset_s } =
                *instrument;
            let key = |name: &str| format!("{}.{name}", quantity.name());
            within(table, &key("sample_rate_hz"), sample_rate_hz, 1.0, SAMPLE_RATE_MAX_HZ)?;
            not_negative(table, &key("noise"), noise)?;
            not_negative(table, &key("quantum"), quantum)?;
            not_negative(table, &key("time_jitter_s"), time_jitter_s)?;
            within(table, &key("clock_offset_s"), clock_offset_s, -60.0, 60.0)?;
        }
        if self.instruments.force.is_some() && self.exciter.is_none() {
            let message = "a force is recorded, but there is no [exciter]".to_owned();
            return problem(table, message, "add [exciter] with moment_arm_m = ..");
        }
        if self.instruments.force.is_some() && self.instruments.moment.is_some() {
            let message = "both a force and a moment are recorded".to_owned();
            return problem(table, message, "keep one: a moment stands in for the force");
        }
        self.check_recordings(&channels)
    }

    fn check_recordings(&self, channels: &[(devices::Quantity, Instrument)]) -> Checked {
        let (table, format) = (("recordings", None), &self.recordings);
        if format.format == FileFormat::Mcap {
            return Ok(());
        }
        if !matches!(format.delimiter, ',' | ';' | '\t') {
            let message = format!("delimiter = {:?} cannot part columns", format.delimiter);
            return problem(table, message, "use \",\", \";\" or \"\\t\"");
        }
        if format.decimal_comma && format.delimiter == ',' {
            let message = "decimal_comma needs another delimiter than the comma".to_owned();
            return problem(table, message, "add delimiter = \";\"");
        }
        let one_clock = channels.iter().all(|(_, i)| i.shares_clock(&channels[0].1));
        if !one_clock && !format.one_file_per_channel {
            let message = "channels with different clocks cannot share one table".to_owned();
            let hint = "set one_file_per_channel = true, or give all channels the same \
                        sample_rate_hz, time_jitter_s and clock_offset_s";
            return problem(table, message, hint);
        }
        Ok(())
    }

    fn check_pass(&self, table: Table, pass: &Pass) -> Checked {
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
        not_negative(table, "carriage.start_s", pass.carriage.start_s)?;
        let speed_m_s = self.pass_speed_m_s(pass);
        if let Err(message) = Carriage::plan(&self.tank, &pass.carriage, speed_m_s) {
            return problem(table, message, &self.speed_hint(pass, speed_m_s));
        }
        let duration_s: f64 = pass.actions.iter().map(Action::duration_s).sum();
        within(table, "the length of all actions [s]", duration_s, 1.0, PASS_LENGTH_MAX_S)?;
        for (at, action) in pass.actions.iter().enumerate() {
            check_action(table, at, action)?;
        }
        self.check_disturbances(table, pass)
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
            not_negative(table, "waves.moment_n_m", waves.moment_n_m)?;
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
        within(table, "carriage.shock_n_m_s", pass.carriage.shock_n_m_s, -1e3, 1e3)?;
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

    fn check_names(&self) -> Checked {
        let mut seen = std::collections::BTreeSet::new();
        for index in 0..self.pass_count() {
            let (pass, name) = self.pass_at(index);
            let at = self.passes.iter().position(|p| std::ptr::eq(p, pass));
            let safe = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
            if name.is_empty() || !name.chars().all(safe) {
                let message = format!("name = \"{name}\" cannot be a file name");
                return problem(("pass", at), message, "use letters, digits, \"_\" and \"-\"");
            }
            if !seen.insert(name.clone()) {
                let message = format!("two recordings are called \"{name}\"");
                return problem(("pass", at), message, "give each pass a name of its own, or none");
            }
        }
        Ok(())
    }
}

fn check_condition(table: Table, condition: &Condition) -> Checked {
    positive(table, "natural_frequency_rad_s", condition.natural_frequency_rad_s)?;
    within(table, "natural_frequency_rad_s", condition.natural_frequency_rad_s, 0.05, 50.0)?;
    let rows = match &condition.damping {
        Damping::Law(law) => {
            positive(table, "damping.law.b0_per_s", law.b0_per_s)?;
            not_negative(table, "damping.law.kappa", law.kappa)?;
            not_negative(table, "damping.law.b3_s", law.b3_s)?;
            return not_negative(table, "damping.law.scatter_per_s", law.scatter_per_s);
        }
        Damping::Table(rows) => rows,
    };
    if rows.is_empty() || rows.windows(2).any(|pair| pair[1].froude <= pair[0].froude) {
        let message = "damping.table needs rows with rising Froude numbers".to_owned();
        return problem(table, message, "sort the rows by froude and give each speed once");
    }
    for row in rows {
        not_negative(table, "damping.table.froude", row.froude)?;
        positive(table, "damping.table.b1_per_s", row.b1_per_s)?;
        not_negative(table, "damping.table.b3_s", row.b3_s)?;
    }
    Ok(())
}

fn check_action(table: Table, at: usize, action: &Action) -> Checked {
    let length_s = action.duration_s();
    let key = |name: &str| format!("action {}: {}.{name}", at + 1, action.name());
    positive(table, &key("duration_s"), length_s)?;
    let highest_deg = as_written_deg(ANGLE_MAX_RAD);
    let part = |name: &str, part_s: f64| within(table, &key(name), part_s, 1e-3, length_s);
    match *action {
        Action::Rest { .. } => Ok(()),
        Action::Hold { heel_rad, ramp_s, tremor_rad, .. } => {
            within(table, &key("heel_deg"), as_written_deg(heel_rad), -highest_deg, highest_deg)?;
            within(table, &key("tremor_deg"), as_written_deg(tremor_rad), 0.0, 5.0)?;
            part("ramp_s", ramp_s)
        }
        Action::Rock { amplitude_rad, frequency_rad_s, .. } => {
            within(table, &key("amplitude_deg"), as_written_deg(amplitude_rad), 0.01, highest_deg)?;
            within(table, &key("frequency_rad_s"), frequency_rad_s, 0.05, 100.0)
        }
        Action::Release { fade_s, .. } => within(table, &key("fade_s"), fade_s, 0.0, length_s),
        Action::Strike { impulse_n_m_s, blow_s, .. } => {
            within(table, &key("impulse_n_m_s"), impulse_n_m_s, -1e6, 1e6)?;
            part("blow_s", blow_s)
        }
        Action::Catch { damping_ratio, .. } => {
            within(table, &key("damping_ratio"), damping_ratio, 0.1, 10.0)
        }
        Action::Forced { amplitude_rad, frequency_rad_s, ramp_s, .. } => {
            within(table, &key("amplitude_deg"), as_written_deg(amplitude_rad), 0.01, highest_deg)?;
            within(table, &key("frequency_rad_s"), frequency_rad_s, 0.05, 100.0)?;
            part("ramp_s", ramp_s)
        }
        Action::Stop { ramp_s, .. } => part("ramp_s", ramp_s),
        Action::Driven { moment_n_m, frequency_rad_s, ramp_s, .. } => {
            within(table, &key("moment_n_m"), moment_n_m, -1e6, 1e6)?;
            within(table, &key("frequency_rad_s"), frequency_rad_s, 0.05, 100.0)?;
            part("ramp_s", ramp_s)
        }
    }
}
