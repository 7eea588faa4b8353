//! What to do about each [`ReplayError`], as one sentence for the `hint:` line.

use std::io;
use std::path::Path;

use devices::Quantity;

use crate::error::ReplayError;
use crate::nearest::nearest;
use crate::number::CellFault;

impl ReplayError {
    /// What the user can do about it, where there is more to say than the message does.
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::Open { source, .. } if source.kind() == io::ErrorKind::NotFound => {
                Some("check the path; it is relative to the campaign folder".to_owned())
            }
            Self::Open { .. } | Self::Read { .. } => {
                Some("check that the file may be read and that its disk is there".to_owned())
            }
            Self::Empty { .. } | Self::HeaderOnly { .. } | Self::NoMessages { .. } => {
                Some("nothing was recorded, or it was lost at once; take the file out".to_owned())
            }
            Self::Utf16 { .. } => Some("save the table as UTF-8".to_owned()),
            Self::MissingChannel { quantity, .. } => {
                Some(format!("add {} to [columns] of the campaign file", quantity.name()))
            }
            Self::NoChannels { .. } => {
                Some("add roll to [columns] of the campaign file".to_owned())
            }
            Self::MissingColumn { path, channel, column, present } => {
                Some(near_column(path, channel, column, present))
            }
            Self::RepeatedColumn { .. } => Some("give the columns different names".to_owned()),
            Self::NoTimeBase { .. } => {
                Some("give time or sample_rate_hz in [columns] of the campaign file".to_owned())
            }
            Self::Cell { fault, text, .. } => Some(cell_hint(*fault, text).to_owned()),
            Self::RowLength { .. } => {
                Some("a line was cut in two or lost its end; mend or remove it".to_owned())
            }
            Self::LineTooLong { .. } => Some("look for a quote that is never closed".to_owned()),
            Self::TimeBackwards { .. } => Some(
                "two recordings in one file, or a clock that was set: cut the file there"
                    .to_owned(),
            ),
            Self::Unstamped { .. } | Self::NoStamps { .. } => Some(
                "leave the time column out and give sample_rate_hz in [columns] instead".to_owned(),
            ),
            Self::NotMcap { .. } => Some("name a table \".csv\"".to_owned()),
            Self::Damaged { .. } => {
                Some("copy the file from its source again, or run `mcap recover` on it".to_owned())
            }
            _ => self.hint_on_topics(),
        }
    }

    /// The hints that belong to MCAP topics and to writing.
    fn hint_on_topics(&self) -> Option<String> {
        match self {
            Self::NoTopic { quantity, .. } => Some(format!(
                "give {} a topic and a field in [columns], the field a path such as \"angle.roll\"",
                quantity.name()
            )),
            Self::MissingTopic { topic, present, .. } => nearest(topic, present)
                .map(|name| format!("did you mean \"{name}\"?"))
                .or_else(|| Some("check topic in [columns] of the campaign file".to_owned())),
            Self::Encoding { .. } | Self::Schema { .. } => {
                Some("convert the recording to JSON messages, or export it to CSV".to_owned())
            }
            Self::Field { .. } => Some(
                "field in [columns] is the path of a number in the message, such as \
                 \"angle.roll\"; leave time out to take the log time"
                    .to_owned(),
            ),
            Self::Exists { .. } => {
                Some("choose another name, or remove the file if it is not needed".to_owned())
            }
            Self::DiskFull { .. } => Some(
                "make room; what was recorded is safe, and finished at the next start".to_owned(),
            ),
            Self::NearlyFull { .. } => {
                Some("make room, or record to another disk; what was recorded is safe".to_owned())
            }
            Self::InUse { .. } => Some("stop the program that records it first".to_owned()),
            Self::NotPart { .. } => Some(
                "an earlier version, or another program, left it; `mcap recover` may read it"
                    .to_owned(),
            ),
            Self::NotKept { .. } => {
                Some("the disk fails; copy the part file to another one".to_owned())
            }
            _ => None,
        }
    }
}

/// Names the column that was probably meant.
fn near_column(path: &Path, channel: &str, column: &str, present: &[String]) -> String {
    if let Some(name) = nearest(column, present) {
        return format!("did you mean \"{name}\"?");
    }
    let spelling = "spell the column in [columns] exactly as in the file's header";
    if channel == "time" || channel == Quantity::Roll.name() {
        return spelling.to_owned();
    }
    let file = path.file_name().unwrap_or(path.as_os_str()).display();
    format!(
        "{spelling}; a recording without {channel} lists the channels that it has, as in \
         `files = {{ roll = \"{file}\" }}` of its [[recording]]"
    )
}

fn cell_hint(fault: CellFault, text: &str) -> &'static str {
    match fault {
        CellFault::NotNumber if text.contains(':') => {
            "a time is a number since some start, not a clock's reading; export it so, or leave \
             time out and give sample_rate_hz in [columns] instead"
        }
        CellFault::NotNumber => "correct the cell, or empty it if the sample is missing",
        CellFault::NotFinite => "empty the cell if the sample is missing",
        CellFault::CommaInside => {
            "a decimal comma needs semicolons or tabs between the cells; take out thousands marks"
        }
        CellFault::MixedSeparators => {
            "the file uses the decimal point and the decimal comma; keep one, without thousands \
             marks"
        }
    }
}
