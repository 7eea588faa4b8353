//! One judgement as one line of JSON.

use devices::Quantity;
use devices::channel::Calibration;
use serde::{Deserialize, Serialize};

use super::place::Place;

/// What was judged, by whom, when and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Judgement {
    /// Its number in the file, counted from 1.
    pub number: u64,
    /// Date and time.
    pub at: String,
    /// Who.
    pub by: String,
    /// Why, or the note itself.
    pub why: String,
    /// What.
    #[serde(flatten)]
    pub deed: Deed,
}

/// What was done.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "what", rename_all = "snake_case")]
pub enum Deed {
    /// An instant was marked.
    Mark {
        /// Name of the recording.
        recording: String,
        /// The instant [s].
        time_s: f64,
    },
    /// Something was noted of a run.
    Annotate {
        /// The run.
        run: Place,
    },
    /// A run was rejected.
    Reject {
        /// The run.
        run: Place,
    },
    /// The recording was stopped.
    StopRecording,
    /// It was started again.
    StartRecording,
    /// Zeros were taken.
    Zero {
        /// The channels, with what was in force before.
        channels: Vec<Zeroed>,
    },
    /// An earlier judgement no longer holds.
    Undo {
        /// Its number.
        of: u64,
    },
}

/// A channel whose zero was taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Zeroed {
    /// Name of its device.
    pub device: String,
    /// What it measures.
    pub quantity: Quantity,
    /// The calibration that was in force before.
    pub before: Calibration,
    /// The calibration with the zero taken.
    pub after: Calibration,
}

/// A line that is no judgement.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line} is no judgement: {message}")]
pub struct BadLine {
    /// Its number, counted from 1.
    pub line: usize,
    /// Why not.
    pub message: String,
}

impl Judgement {
    /// The line, without its end.
    ///
    /// # Panics
    /// Never: every key is a string, which is all that can fail.
    pub fn line(&self) -> String {
        serde_json::to_string(self).expect("every key is a string")
    }

    /// A note as a remark on its run.
    pub fn remark(&self) -> String {
        format!("{}{NOTED}{}", self.by, self.why)
    }
}

/// Stands between who noted something of a run and what.
const NOTED: &str = " noted: ";

/// Whether a remark on a run is a note of [`Judgement::remark`].
pub fn is_note(remark: &str) -> bool {
    remark.contains(NOTED)
}

/// Every judgement of a text; empty lines are none.
pub(super) fn parse(text: &str) -> Result<Vec<Judgement>, Vec<BadLine>> {
    let (mut all, mut bad) = (Vec::new(), Vec::new());
    for (at, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        match serde_json::from_str(line) {
            Ok(judgement) => all.push(judgement),
            Err(error) => bad.push(BadLine { line: at + 1, message: error.to_string() }),
        }
    }
    if bad.is_empty() { Ok(all) } else { Err(bad) }
}
