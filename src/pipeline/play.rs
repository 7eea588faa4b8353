//! Playing one recording of a campaign into the run finder.

use std::sync::mpsc::SyncSender;
use std::thread;
use std::time::Duration;

use devices::{Device, Reading, Sample};
use replay::{Note, Player};

use super::listening::{Heard, Listening, Unheard};
use super::workers::Workers;
use super::{Options, PipelineError};
use crate::campaign::{Campaign, Recording};

pub(super) type Queue = SyncSender<Result<Heard, PipelineError>>;

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
    let played = play(campaign, recording, &mut { covered }, &mut |batch, bytes_read| {
        pace.wait(batch);
        heard = listening.batch(batch, tell).and_then(|()| tell(Heard::Read { index, bytes_read }));
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
    listener: &mut dyn FnMut(&[Sample], u64) -> bool,
) -> Result<Vec<Note>, PipelineError> {
    let mut player = Player::open(&recording.name, &recording.files, &campaign.columns)?;
    let size_bytes = size_bytes(recording);
    let mut batch = Vec::new();
    loop {
        batch.clear();
        let reading = player.read(&mut batch);
        if let ([first, ..], [.., last]) = (&batch[..], &batch[..]) {
            let zero_s = player.zero_log_time_ns() as f64 / 1e9;
            covered(zero_s + first.time_s, zero_s + last.time_s)?;
        }
        let (read, total) = player.progress();
        let share = read as f64 / total.max(1) as f64;
        if !listener(&batch, (share * size_bytes as f64) as u64) || reading? == Reading::Ended {
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
    fn wait(&mut self, batch: &[Sample]) {
        let (Some(speed), Some(sample)) = (self.speed, batch.last()) else { return };
        let last_s = self.last_s.replace(sample.time_s).unwrap_or(batch[0].time_s);
        let wait = Duration::try_from_secs_f64((sample.time_s - last_s) / speed);
        thread::sleep(wait.unwrap_or_default());
    }
}

/// Bytes of a recording; a file that cannot be asked will say so when it is opened.
pub(super) fn size_bytes(recording: &Recording) -> u64 {
    let files = recording.files.iter();
    files.filter_map(|(_, path)| path.metadata().ok()).map(|metadata| metadata.len()).sum()
}
