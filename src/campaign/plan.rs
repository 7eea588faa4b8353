//! The test plan: which runs are asked for, from `[[plan]]` or from a table beside the file.

use std::path::Path;

use super::Plan;
use super::live::DEFAULT_CONDITION;
use super::plan_table;
use super::tree::{COUNT, NOT_NEGATIVE, POSITIVE, Section, Source};
use crate::hull::{Hull, Water};
use crate::run::RunKind;

/// Runs that the plan asks for alike: one row of it.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRuns {
    /// Loading or appendage condition.
    pub condition: String,
    /// Froude number [-] on the length between perpendiculars.
    pub froude: f64,
    /// Decay or forced.
    pub kind: RunKind,
    /// Heel at the release or amplitude of the forced roll [rad]; any where none is written.
    pub amplitude_rad: Option<f64>,
    /// Frequency of the excitation [rad/s] of a forced run.
    pub frequency_rad_s: Option<f64>,
    /// How many such runs.
    pub repeats: usize,
    /// Line of the file that asks for them.
    pub line: Option<usize>,
}

/// Reads the plan; a row with a mistake is left out.
pub(super) fn read(root: &Section<'_>, folder: &Path, hull: Option<&Hull>, water: &Water) -> Plan {
    let Some(name) = root.text_or_tables("plan") else {
        let file = super::FILE_NAME.to_owned();
        return Plan { file, rows: rows(&root.sections("plan"), hull, water) };
    };
    let path = folder.join(name);
    let written = match plan_table::read(&path) {
        Ok(written) => written,
        Err(reason) => {
            let hint = "name a CSV file relative to campaign.toml, or write [[plan]] tables";
            root.mistake("plan", format!("plan \"{name}\" {reason}"), hint);
            return Plan { file: name.to_owned(), rows: Vec::new() };
        }
    };
    let source = Source::new(path.display().to_string(), &written);
    let rows = source.parse().map_or_else(Vec::new, |tree| {
        rows(&source.root(tree.get_ref()).sections("plan"), hull, water)
    });
    source.into_mistakes().into_iter().for_each(|mistake| root.add(mistake));
    Plan { file: name.to_owned(), rows }
}

fn rows(sections: &[Section<'_>], hull: Option<&Hull>, water: &Water) -> Vec<PlannedRuns> {
    let read = |section: &Section<'_>| {
        let row = row(section, hull, water);
        section.close();
        row
    };
    sections.iter().filter_map(read).collect()
}

fn row(section: &Section<'_>, hull: Option<&Hull>, water: &Water) -> Option<PlannedRuns> {
    let condition = section.text("condition").unwrap_or(DEFAULT_CONDITION).to_owned();
    let amplitude_rad = section.number("amplitude_deg", &POSITIVE).map(f64::to_radians);
    let repeats = match section.number("repeats", &COUNT) {
        Some(repeats) => repeats as usize,
        None => 1,
    };
    let froude = either(section, "froude", "speed_m_s", |section| {
        let froude = section.number("froude", &NOT_NEGATIVE);
        let speed_m_s = section.number("speed_m_s", &NOT_NEGATIVE);
        froude.or_else(|| Some(hull?.froude(speed_m_s?, water)))
    });
    let kind = kind(section);
    let frequency_rad_s = if kind == Some(RunKind::Forced) {
        either(section, "frequency_rad_s", "period_s", |section| {
            let period_s = section.number("period_s", &POSITIVE);
            let frequency_rad_s = section.number("frequency_rad_s", &POSITIVE);
            frequency_rad_s.or_else(|| Some(std::f64::consts::TAU / period_s?))
        })
    } else {
        refuse_frequency(section, kind);
        None
    };
    let kind = kind?;
    if kind == RunKind::Forced && frequency_rad_s.is_none() {
        return None;
    }
    let (froude, line) = (froude?, section.own_line());
    Some(PlannedRuns { condition, froude, kind, amplitude_rad, frequency_rad_s, repeats, line })
}

fn refuse_frequency(section: &Section<'_>, kind: Option<RunKind>) {
    for key in ["frequency_rad_s", "period_s"] {
        section.leave(key);
        if kind.is_some() && section.holds(key) {
            let message = format!("`{key}` is given, but a decay has no excitation");
            section.mistake(key, message, "leave it out, or write kind = \"forced\"");
        }
    }
}

fn kind(section: &Section<'_>) -> Option<RunKind> {
    let written = section.required_text("kind")?;
    let mut kinds = [RunKind::Decay, RunKind::Forced].into_iter();
    let known = kinds.find(|kind| kind.name() == written);
    if known.is_none() {
        section.mistake(
            "kind",
            format!("`kind` is \"{written}\""),
            "write kind = \"decay\" or kind = \"forced\"",
        );
    }
    known
}

/// One of two keys that say the same in two units; both, or neither, is a mistake.
fn either<T>(
    section: &Section<'_>,
    key: &'static str,
    other: &'static str,
    read: impl Fn(&Section<'_>) -> Option<T>,
) -> Option<T> {
    let value = read(section);
    match (section.holds(key), section.holds(other)) {
        (true, true) => {
            let message = format!("both `{key}` and `{other}` are given");
            section.mistake(other, message, "give one of them");
            None
        }
        (false, false) => {
            let message = format!("neither `{key}` nor `{other}` is given");
            section.mistake(key, message, format!("add `{key} = ...`"));
            None
        }
        _ => value,
    }
}
