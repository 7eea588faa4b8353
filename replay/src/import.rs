//! Turns any recording into one of our own.

use std::path::{Path, PathBuf};

use devices::{Quantity, Reading, Sample};

use crate::columns::Columns;
use crate::error::ReplayError;
use crate::note::Note;
use crate::player::Player;
use crate::recorder::{Exit, Provenance, Recorder};

/// What an import wrote.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportReport {
    /// Samples of each channel, in the order of [`Quantity::ALL`].
    pub samples: Vec<(Quantity, u64)>,
    /// Time of the first sample [s].
    pub first_s: f64,
    /// Time of the last sample [s].
    pub last_s: f64,
    /// What was mended and lost on the way.
    pub notes: Vec<Note>,
}

/// Writes the recording `name` to the MCAP file `target`, which must not exist.
///
/// `progress` is told bytes read and bytes in all after every batch. The times are kept to the bit.
/// When the recording turns out to be unreadable, nothing is left behind.
///
/// # Errors
/// [`ReplayError`] of the recording or of the target.
pub fn import(
    name: &str,
    files: &[(Option<Quantity>, PathBuf)],
    columns: &Columns,
    target: &Path,
    campaign_text: &str,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<ImportReport, ReplayError> {
    let mut player = Player::open(name, files, columns)?;
    let mut samples = Vec::new();
    let mut reading = player.read_batch(&mut samples)?;
    let first_s = samples.first().map_or(0.0, |sample: &Sample| sample.time_s);
    let mut last_s = first_s;
    let provenance = Provenance {
        campaign_text: campaign_text.to_owned(),
        source: source(name, files),
        zero_log_time_ns: zero_log_time_ns(player.zero_log_time_ns(), first_s),
    };
    let mut recorder = Recorder::create(target, &provenance)?;
    let copied = loop {
        last_s = samples.last().map_or(last_s, |sample| sample.time_s);
        if let Err(error) = samples.iter().try_for_each(|sample| recorder.push(sample)) {
            break Err(error);
        }
        let (read, total) = player.progress();
        progress(read, total);
        samples.clear();
        if reading == Reading::Ended {
            break Ok(());
        }
        match player.read_batch(&mut samples) {
            Ok(next) => reading = next,
            Err(error) => break Err(error),
        }
    };
    if let Err(error) = copied {
        recorder.abandon()?;
        return Err(error);
    }
    let samples = recorder.finish(Exit::success("imported"))?.samples;
    Ok(ImportReport { samples, first_s, last_s, notes: player.notes().to_vec() })
}

/// Log times begin at zero, so a recording that begins before its time zero is moved up by whole
/// seconds.
fn zero_log_time_ns(zero_ns: u64, first_s: f64) -> u64 {
    let short_s = (-first_s - zero_ns as f64 / 1e9).ceil().max(0.0);
    zero_ns.saturating_add((short_s * 1e9) as u64)
}

fn source(name: &str, files: &[(Option<Quantity>, PathBuf)]) -> String {
    let file_lines = files.iter().map(|(quantity, path)| {
        // The folder is this machine's business, the file's name is the recording's.
        let file = path.file_name().unwrap_or(path.as_os_str()).display();
        match quantity {
            Some(quantity) => format!("{}: {file}", quantity.name()),
            None => file.to_string(),
        }
    });
    let lines: Vec<String> = std::iter::once(name.to_owned()).chain(file_lines).collect();
    lines.join("\n")
}
