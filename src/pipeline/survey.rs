//! Reading every recording to its end without looking for runs.

use devices::Quantity;
use replay::Note;

use super::PipelineError;
use super::claims::Claims;
use super::play::{play, size_bytes};
use crate::campaign::Campaign;

/// A recording that was read from end to end, without looking for runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Surveyed {
    /// Name of the recording, as in the campaign file.
    pub recording: String,
    /// First time stamp [s].
    pub start_s: f64,
    /// Last time stamp [s].
    pub end_s: f64,
    /// Samples of each channel that was recorded.
    pub channels: Vec<(Quantity, u64)>,
    /// What was mended or lost while reading.
    pub notes: Vec<Note>,
}

/// Reads every recording of a campaign to its end and tells what each holds, or what is wrong.
pub fn survey(
    campaign: &Campaign,
    progress: &mut dyn FnMut(&str, u64, u64),
) -> Vec<Result<Surveyed, PipelineError>> {
    let mut claims = Claims::default();
    let bytes_total = campaign.recordings.iter().map(size_bytes).sum();
    let mut bytes_before = 0;
    let mut all = Vec::new();
    for recording in &campaign.recordings {
        let (mut start_s, mut end_s) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut counts = Quantity::ALL.map(|quantity| (quantity, 0));
        let mut covered = |start_s, end_s| claims.extend(&recording.name, start_s, end_s);
        let played = play(campaign, recording, &mut covered, &mut |batch| {
            for sample in batch.samples {
                start_s = start_s.min(sample.time_s);
                end_s = end_s.max(sample.time_s);
                counts.iter_mut().filter(|count| count.0 == sample.quantity).for_each(|c| c.1 += 1);
            }
            progress(&recording.name, bytes_before + batch.bytes_read, bytes_total);
            true
        });
        claims.end_recording();
        bytes_before += size_bytes(recording);
        all.push(played.map(|notes| Surveyed {
            recording: recording.name.clone(),
            start_s,
            end_s,
            channels: counts.into_iter().filter(|(_, count)| *count > 0).collect(),
            notes,
        }));
    }
    all
}
