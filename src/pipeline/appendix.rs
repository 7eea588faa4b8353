//! What the appendix of a report tells: read from the recordings themselves.

use std::fs::{self, File};
use std::path::Path;

use replay::{Record, Recorded};

use super::Options;
use super::files::WriteError;
use super::sha256::sha256;
use crate::campaign::Campaign;
use crate::report::{self, Appendix, AttachedInstrument, ChannelCalibration, RecordedFile};

/// Writes the appendix of a report to `dir`; its campaign page leads there from then on.
pub fn write_appendix(
    campaign: &Campaign,
    options: &Options,
    dir: &Path,
) -> Result<(), WriteError> {
    let mut appendix = Appendix { seed: options.seed, ..Appendix::default() };
    for recording in &campaign.recordings {
        let mut paths: Vec<&Path> = recording.files.iter().map(|(_, path)| &**path).collect();
        paths.dedup();
        for path in paths {
            appendix.files.push(file(&recording.name, path, &campaign.folder));
            told_by(path, &recording.name, &mut appendix);
        }
    }
    Ok(report::write_appendix(campaign, &appendix, dir)?)
}

fn file(recording: &str, path: &Path, folder: &Path) -> RecordedFile {
    RecordedFile {
        recording: recording.to_owned(),
        file: path.strip_prefix(folder).unwrap_or(path).display().to_string(),
        n_bytes: fs::metadata(path).ok().map(|metadata| metadata.len()),
        sha256: File::open(path).and_then(sha256).ok(),
    }
}

/// Instruments and calibrations as a recording of our own tells them; a table tells none.
fn told_by(path: &Path, recording: &str, appendix: &mut Appendix) {
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("mcap")) {
        return;
    }
    // What cannot be read was told by the replay.
    let Ok(mut recorded) = Recorded::open(path) else { return };
    while let Ok(Some(record)) = recorded.next_record() {
        match record {
            Record::Device(device) => {
                let device = AttachedInstrument {
                    recording: recording.to_owned(),
                    device: device.device,
                    profile: device.profile,
                    port: device.port,
                };
                if !appendix.instruments.iter().any(|known| known.is_like(&device)) {
                    appendix.instruments.push(device);
                }
            }
            Record::Calibration(taken) => {
                let calibration = ChannelCalibration {
                    recording: recording.to_owned(),
                    device: taken.device,
                    channel: taken.channel,
                    definition: definition(&taken.definition),
                    by: taken.by,
                    taken: taken.taken,
                };
                if !appendix.calibrations.iter().any(|known| known.is_like(&calibration)) {
                    appendix.calibrations.push(calibration);
                }
            }
            _ => {}
        }
    }
}

/// Zero and curve on one line, without what the record says beside them.
fn definition(table: &str) -> String {
    let beside =
        |line: &&str| !["by = ", "at = ", "note = \"\""].iter().any(|k| line.starts_with(k));
    let words = table.lines().filter(beside).flat_map(str::split_whitespace);
    words.collect::<Vec<_>>().join(" ")
}
