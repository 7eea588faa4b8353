//! Recordings made for a story, and everything a player brings out of them.

use std::fs;
use std::path::{Path, PathBuf};

use devices::{Quantity, Reading, Sample};
use replay::{ChannelColumn, Columns, Note, Player, ReplayError, Severity, TimeColumn};

/// A folder that vanishes with the story.
pub(crate) fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder can be made")
}

/// Writes one file of a recording.
pub(crate) fn write(folder: &tempfile::TempDir, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, bytes).expect("the file can be written");
    path
}

/// A header and its rows as the text of a table.
pub(crate) fn table(header: &str, rows: impl IntoIterator<Item = String>) -> String {
    let lines: Vec<String> = std::iter::once(header.to_owned()).chain(rows).collect();
    lines.join("\n") + "\n"
}

pub(crate) fn time(column: &str) -> TimeColumn {
    TimeColumn { column: column.to_owned(), seconds_per_unit: 1.0 }
}

pub(crate) fn channel(quantity: Quantity, column: &str) -> ChannelColumn {
    ChannelColumn { quantity, column: column.to_owned(), topic: None, time: None, si_per_unit: 1.0 }
}

/// Time in `t`, and each channel in the column of its name.
pub(crate) fn columns(quantities: &[Quantity]) -> Columns {
    let channels = quantities.iter().map(|quantity| channel(*quantity, quantity.name()));
    Columns { time: Some(time("t")), sample_rate_hz: None, channels: channels.collect() }
}

/// Everything that came out of a recording.
#[derive(Debug)]
pub(crate) struct Played {
    pub(crate) samples: Vec<Sample>,
    pub(crate) notes: Vec<Note>,
    pub(crate) error: Option<ReplayError>,
}

impl Played {
    /// Times and values of one channel.
    pub(crate) fn of(&self, quantity: Quantity) -> Vec<(f64, f64)> {
        let of = self.samples.iter().filter(|sample| sample.quantity == quantity);
        of.map(|sample| (sample.time_s, sample.value)).collect()
    }

    /// The one note of a severity that contains a text.
    #[track_caller]
    pub(crate) fn note(&self, severity: Severity, text: &str) -> &str {
        let fits = |note: &&Note| note.severity == severity && note.message.contains(text);
        let found: Vec<_> = self.notes.iter().filter(fits).collect();
        assert_eq!(found.len(), 1, "one {severity:?} note on \"{text}\" in {:?}", self.notes);
        &found[0].message
    }
}

/// Plays files with the channel each carries.
pub(crate) fn play_files(
    files: &[(Option<Quantity>, PathBuf)],
    columns: &Columns,
) -> Result<Played, ReplayError> {
    let mut player = Player::open("story", files, columns)?;
    let mut played = Played { samples: Vec::new(), notes: Vec::new(), error: None };
    loop {
        let before = played.samples.len();
        let read = player.read_batch(&mut played.samples);
        assert!(played.samples.len() - before <= 1024, "batches are bounded");
        match read {
            Ok(Reading::More) => {}
            Ok(Reading::Ended) => break,
            Err(error) => {
                played.error = Some(error);
                break;
            }
        }
    }
    let (read, total) = player.progress();
    assert!(read <= total, "{read} of {total} bytes");
    played.notes = player.notes().to_vec();
    Ok(played)
}

/// Plays one file that carries every channel.
pub(crate) fn play(path: &Path, columns: &Columns) -> Result<Played, ReplayError> {
    play_files(&[(None, path.to_owned())], columns)
}

/// Plays one file that is expected to be readable to its end.
#[track_caller]
pub(crate) fn play_whole(path: &Path, columns: &Columns) -> Played {
    let played = play(path, columns).expect("the recording opens");
    assert!(played.error.is_none(), "the recording is read to its end: {:?}", played.error);
    played
}

/// The error of a recording that opens or reads badly, as message and hint.
#[track_caller]
pub(crate) fn refusal(path: &Path, columns: &Columns) -> (String, String) {
    let error = match play(path, columns) {
        Ok(played) => played.error.expect("the recording is refused"),
        Err(error) => error,
    };
    told(&error)
}

/// Message and hint of an error, without the folder of the story.
pub(crate) fn told(error: &ReplayError) -> (String, String) {
    let mut message = error.to_string();
    if let (Some(from), Some(to)) = (message.find('"'), message.find("/story.")) {
        message.replace_range(from + 1..=to, "");
    }
    (message, error.hint().unwrap_or_default())
}
