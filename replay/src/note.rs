//! What was mended or lost while a recording was read.

/// Whether the recording's content is whole after all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Everything was kept, after a repair that is told.
    Mended,
    /// Something that was or should have been recorded is missing.
    Lost,
}

/// One kind of irregularity, counted over the whole recording so far.
///
/// Each file, time base and channel gives at most one note of a kind, so the list stays short.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// Mended or lost.
    pub severity: Severity,
    /// What happened, where first, and how often.
    pub message: String,
}

impl Note {
    pub(crate) fn mended(message: String) -> Self {
        Self { severity: Severity::Mended, message }
    }

    pub(crate) fn lost(message: String) -> Self {
        Self { severity: Severity::Lost, message }
    }
}

/// How often something happened and where first.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    pub(crate) count: u64,
    pub(crate) first: Option<u64>,
}

impl Tally {
    /// Counts one more; `place` is asked for only at the first.
    pub(crate) fn add(&mut self, place: impl FnOnce() -> u64) {
        if self.count == 0 {
            self.first = Some(place());
        }
        self.count += 1;
    }

    /// "3 rows, the first at line 17".
    pub(crate) fn told(&self, what: &str, place: &str) -> String {
        let plural = if self.count == 1 { "" } else { "s" };
        match (self.count, self.first) {
            (1, Some(first)) => format!("1 {what}, at {place} {first}"),
            (count, Some(first)) => {
                format!("{count} {what}{plural}, the first at {place} {first}")
            }
            (count, None) => format!("{count} {what}{plural}"),
        }
    }
}
