//! Playing one recording of a campaign into the run finder.

use std::sync::mpsc::SyncSender;
use std::thread;
use std::time::Duration;

use devices::channel::Counted;
use devices::{Device, Reading, Sample};
use replay::{Note, Player};

use super::listening::{Heard, Listening, Unheard};
use super::workers::Workers;
use super::{Options, PipelineError};
use crate::campaign::{Campaign, Recording};

pub(super) type Queue = SyncSender<Result<Heard, PipelineError>>;

/// What one reading of a recording brought.
pub(super) struct Batch<'b> {
    pub(super) samples: &'b [Sample],
    /// What instruments counted, each with the samples of the batch that came before it.
    pub(super) counted: &'b [(usize, Counted)],
    /// Bytes of the recording so far.
    pub(super) bytes_read: u64,
}

/// Plays one recording until it ends, cannot be read further, or nobody listens.
pub(super) fn recording(
    campaign: &Campaign,
    options: &Options,
    workers: &Workers,
    index: usize,
    queue: &Queue,
) {
    let recording = &campaign.recordings[index];
    let mut listening = Listening::new(campaign, options, workers, index);
    let tell = &mut |heard| queue.send(Ok(heard)).map_err(|_| Unheard);
    let mut heard = Ok(());
    let mut pace = Pace { speed: options.speed, last_s: None };
    let covered = |start_s, end_s| {
        // A listener that is gone is noticed at the next word to it.
        drop(queue.send(Ok(Heard::Covered { start_s, end_s })));
        Ok(())
    };
    let played = play(campaign, recording, &mut { covered }, &mut |batch| {
        let Batch { samples, counted, bytes_read } = *batch;
        pace.wait(samples);
        let listened = listening.batch(samples, counted, tell);
        heard = listened.and_then(|()| tell(Heard::Read { index, bytes_read }));
        heard.is_ok()
    });
    let heard = heard.and_then(|()| match played {
        Ok(notes) => listening.end(notes, tell),
        Err(error) => queue.send(Err(error)).map_err(|_| Unheard),
    });
    // Whoever went away needs no answer.
    drop(heard);
}

/// Hands a recording to `listener` batch by batch until it ends or the listener has had enough;
/// `covered` hears first which stretch [s] of absolute time each batch covers.
pub(super) fn play(
    campaign: &Campaign,
    recording: &Recording,
    covered: &mut dyn FnMut(f64, f64) -> Result<(), PipelineError>,
    listener: &mut dyn FnMut(&Batch<'_>) -> bool,
) -> Result<Vec<Note>, PipelineError> {
    let mut player = Player::open(&recording.name, &recording.files, &campaign.columns)?;
    let size_bytes = size_bytes(recording);
    let mut samples = Vec::new();
    loop {
        samples.clear();
        let reading = player.read(&mut samples);
        if let ([first, ..], [.., last]) = (&samples[..], &samples[..]) {
            let zero_s = player.zero_log_time_ns() as f64 / 1e9;
            covered(zero_s + first.time_s, zero_s + last.time_s)?;
        }
        let (read, total) = player.progress();
        let share = read as f64 / total.max(1) as f64;
        let bytes_read = (share * size_bytes as f64) as u64;
        let batch = Batch { samples: &samples, counted: player.counted(), bytes_read };
        if !listener(&batch) || reading? == Reading::Ended {
            return Ok(player.notes().to_vec());
        }
    }
}

/// Plays at a multiple of the recorded pace by sleeping over the recorded time of each batch.
struct Pace {
    speed: Option<f64>,
    last_s: Option<f64>,
}

impl Pace {
    fn wait(&mut self, samples: &[Sample]) {
        let (Some(speed), Some(sample)) = (self.speed, samples.last()) else { return };
        let last_s = self.last_s.replace(sample.time_s).unwrap_or(samples[0].time_s);
        let wait = Duration::try_from_secs_f64((sample.time_s - last_s) / speed);
        thread::sleep(wait.unwrap_or_default());
    }
}

/// Bytes of a recording; a file that cannot be asked will say so when it is opened.
pub(super) fn size_bytes(recording: &Recording) -> u64 {
    let files = recording.files.iter();
    files.filter_map(|(_, path)| path.metadata().ok()).map(|metadata| metadata.len()).sum()
}
