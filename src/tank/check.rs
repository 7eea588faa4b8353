//! The physical limits of model, tank, instruments and conditions.

use super::instruments::{FileFormat, Instrument};
use super::scenario::{ArmShape, Condition, Damping, DampingRow, Scenario, Shaker};

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

/// Nothing, or the first mistake.
pub(super) type Checked = Result<(), Problem>;

/// Highest sample rate [Hz].
const SAMPLE_RATE_MAX_HZ: f64 = 20_000.0;
/// Largest `b1/w` and `b3 w` [-]; a `b1/w` of 2 already stops a roll from swinging.
pub(super) const OVERDAMPED: f64 = 10.0;

/// Tells one mistake.
pub(super) fn problem(table: Table, message: String, hint: &str) -> Checked {
    Err(Problem { table, message, hint: hint.to_owned() })
}

/// Refuses any value that is not inside the closed range.
pub(super) fn within(table: Table, key: &str, value: f64, lowest: f64, highest: f64) -> Checked {
    if value >= lowest && value <= highest {
        return Ok(());
    }
    let message = format!("{key} = {value} is outside {lowest} to {highest}");
    problem(table, message, "values are in the unit that the key ends with")
}

/// Refuses any value that is not a positive number.
pub(super) fn positive(table: Table, key: &str, value: f64) -> Checked {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    problem(table, format!("{key} = {value} is not positive"), "give a number above zero")
}

/// Refuses any value that is negative or not a number.
pub(super) fn not_negative(table: Table, key: &str, value: f64) -> Checked {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    problem(table, format!("{key} = {value} is negative"), "give zero or a number above it")
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
        self.exciter.as_ref().map_or(Ok(()), check_exciter)
    }

    fn check_instruments(&self) -> Checked {
        let table = ("instruments", None);
        let channels = self.instruments.recorded();
        for (quantity, instrument) in &channels {
            let Instrument { sample_rate_hz, noise, quantum, time_jitter_s, clock_offset_s } =
                *instrument;
            let key = |name: &str| format!("{}.{name}", quantity.name());
            within(table, &key("sample_rate_hz"), sample_rate_hz, 1.0, SAMPLE_RATE_MAX_HZ)?;
            within(table, &key("noise"), noise, 0.0, 1e6)?;
            within(table, &key("quantum"), quantum, 0.0, 1e6)?;
            within(table, &key("time_jitter_s"), time_jitter_s, 0.0, 60.0)?;
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

fn check_exciter(shaker: &Shaker) -> Checked {
    let table = ("exciter", None);
    positive(table, "moment_arm_m", shaker.moment_arm_m)?;
    if !matches!(shaker.force_sign, 1.0 | -1.0) {
        let message = format!("force_sign = {} is neither 1.0 nor -1.0", shaker.force_sign);
        return problem(table, message, "it turns the recorded force round and nothing else");
    }
    match (shaker.arm, shaker.rod_length_m) {
        (ArmShape::Rod, None) => {
            let message = "arm = \"rod\" needs rod_length_m".to_owned();
            problem(table, message, "give the length between the two joints of the rod")
        }
        // A shorter rod cannot follow its pin joint through every angle.
        (ArmShape::Rod, Some(length_m)) => {
            within(table, "rod_length_m", length_m, shaker.moment_arm_m, 1000.0)
        }
        (_, Some(_)) => {
            let message = "rod_length_m has no effect on this arm".to_owned();
            problem(table, message, "write arm = \"rod\", or leave rod_length_m out")
        }
        (_, None) => Ok(()),
    }
}

fn check_condition(table: Table, condition: &Condition) -> Checked {
    let w = condition.natural_frequency_rad_s;
    within(table, "natural_frequency_rad_s", w, 0.05, 20.0)?;
    let rows = match &condition.damping {
        Damping::Law(law) => {
            within(table, "damping.law.kappa", law.kappa, 0.0, 1000.0)?;
            within(table, "damping.law.scatter_per_s", law.scatter_per_s, 0.0, law.b0_per_s)?;
            vec![DampingRow { froude: 0.0, b1_per_s: law.b0_per_s, b3_s: law.b3_s }]
        }
        Damping::Table(rows) => rows.clone(),
    };
    if rows.is_empty() || rows.windows(2).any(|pair| pair[1].froude <= pair[0].froude) {
        let message = "damping.table needs rows with rising Froude numbers".to_owned();
        return problem(table, message, "sort the rows by froude and give each speed once");
    }
    for row in rows {
        within(table, "froude of the damping", row.froude, 0.0, 10.0)?;
        positive(table, "b1_per_s of the damping", row.b1_per_s)?;
        within(table, "b1_per_s of the damping", row.b1_per_s, 0.0, OVERDAMPED * w)?;
        within(table, "b3_s of the damping", row.b3_s, 0.0, OVERDAMPED / w)?;
    }
    Ok(())
}
