//! Reads a scenario file; every mistake is told with its line and a way to mend it.

use toml::de::{DeTable, DeValue};

use super::check::{Problem, Table};
use super::paper;
use super::scenario::{Pass, Scenario};

/// A scenario file that cannot be simulated.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {message}\nhint: {hint}")]
pub struct ScenarioError {
    /// The scenario file.
    pub file: String,
    /// Line of the mistake, or of the table that holds it.
    pub line: usize,
    /// The mistake, with its value and its limit.
    pub message: String,
    /// How to mend it.
    pub hint: String,
}

impl Scenario {
    /// Reads a scenario from the text of a TOML file called `file` in messages.
    pub fn parse(text: &str, file: &str) -> Result<Self, ScenarioError> {
        let scenario: Self = toml::from_str(text).map_err(|error| ScenarioError {
            file: file.to_owned(),
            line: error.span().map_or(1, |span| line_at(text, span.start)),
            message: error.message().lines().next().unwrap_or("not a scenario").to_owned(),
            hint: spelling_hint(error.message()),
        })?;
        scenario.check(text, file)?;
        Ok(scenario)
    }

    /// A scenario that comes with the program: `"paper"`, `"short-day"`.
    pub fn builtin(name: &str) -> Option<Self> {
        match name {
            paper::NAME => Some(paper::scenario()),
            paper::SHORT_DAY => Some(paper::short_day()),
            _ => None,
        }
    }

    /// Checks the physical limits of a scenario written by a program, so without lines.
    pub fn checked(self) -> Result<Self, ScenarioError> {
        let name = self.name.clone();
        self.check("", &name)?;
        Ok(self)
    }

    fn check(&self, text: &str, file: &str) -> Result<(), ScenarioError> {
        self.check_tables().map_err(|Problem { table, message, hint }| ScenarioError {
            file: file.to_owned(),
            line: table_line(text, table),
            message: table_name(table) + &message,
            hint,
        })
    }

    /// Number of recordings, each repeat counted.
    pub fn pass_count(&self) -> usize {
        self.passes.iter().map(|pass| pass.repeat).sum()
    }

    /// The pass behind the recording at `index`, and the recording's name.
    ///
    /// # Panics
    /// When `index` is not below [`Scenario::pass_count`].
    pub fn pass_at(&self, index: usize) -> (&Pass, String) {
        let mut before = 0;
        for pass in &self.passes {
            if index < before + pass.repeat {
                let digits = self.pass_count().to_string().len().max(2);
                let name = match &pass.name {
                    None => format!("pass_{:0digits$}", index + 1),
                    Some(name) if pass.repeat == 1 => name.clone(),
                    Some(name) => format!("{name}-{}", index - before + 1),
                };
                return (pass, name);
            }
            before += pass.repeat;
        }
        panic!("pass {index} of {before}");
    }

    /// Carriage speed of the steady stretch of a pass [m/s].
    pub(super) fn pass_speed_m_s(&self, pass: &Pass) -> f64 {
        let root = (self.water.gravity_m_s2 * self.hull.length_pp_m).sqrt();
        pass.speed_m_s.or_else(|| pass.froude.map(|froude| froude * root)).unwrap_or(0.0)
    }
}

fn line_at(text: &str, offset: usize) -> usize {
    1 + text.bytes().take(offset).filter(|&byte| byte == b'\n').count()
}

fn table_name((name, index): Table) -> String {
    index.map_or_else(|| format!("[{name}]: "), |at| format!("[[{name}]] number {}: ", at + 1))
}

/// Line on which a table starts; 1 when the text does not name it.
fn table_line(text: &str, (name, index): Table) -> usize {
    let find = || {
        let document = DeTable::parse(text).ok()?;
        let table = document.get_ref().get(name)?;
        let offset = match (table.get_ref(), index) {
            (DeValue::Array(rows), Some(at)) => rows.get(at)?.span().start,
            _ => table.span().start,
        };
        Some(line_at(text, offset))
    };
    find().unwrap_or(1)
}

/// The expected name nearest to the one that was not understood, both as the message gives them.
fn spelling_hint(message: &str) -> String {
    let (found, expected) = misspelling(message).unwrap_or_default();
    let nearest = expected
        .into_iter()
        .map(|name| (edit_distance(found, name), name))
        .min()
        .filter(|(distance, name)| 3 * distance <= name.len().max(6));
    nearest.map_or_else(
        || "docs/scenario.md lists every table and key with its unit".to_owned(),
        |(_, name)| format!("did you mean `{name}`?"),
    )
}

/// A name that was not understood and the names that could stand there, from a parser's message.
fn misspelling(message: &str) -> Option<(&str, Vec<&str>)> {
    if let Some(keys) = message.strip_prefix("unexpected keys in table: ") {
        let (found, expected) = keys.split_once(", available keys: ")?;
        return Some((found.split(", ").next()?, expected.split(", ").collect()));
    }
    let mut quoted = message.strip_prefix("unknown ")?.split('`').skip(1).step_by(2);
    Some((quoted.next()?, quoted.collect()))
}

/// Least number of letters to insert, drop or change to get from one word to the other.
fn edit_distance(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, a) in from.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, b) in to.iter().enumerate() {
            let change = diagonal + usize::from(a != *b);
            diagonal = row[j + 1];
            row[j + 1] = change.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[to.len()]
}
