//! Playing one recording of a campaign into the run finder.

use std::sync::mpsc::{Receiver, SyncSender};
use std::thread;
use std::time::Duration;

use devices::{Device, Quantity, Reading, Sample};
use replay::{Note, Player};

use super::asking::Asking;
use super::overview::OverviewBuilder;
use super::workers::{Identified, Workers};
use super::{Options, PipelineError};
use crate::campaign::{Campaign, Recording};
use crate::results::Overview;
use crate::run::{Event, Limits, Rejection, RunFinder};

/// What a playing thread tells the collecting one.
pub(super) enum Heard {
    /// The next batch of samples covers this stretch [s] of absolute time.
    Covered { start_s: f64, end_s: f64 },
    /// A batch of samples has been read; bytes of this recording so far.
    Read { index: usize, bytes_read: u64 },
    /// A run has ended and is being identified; the overview shows the recording up to here.
    Run { index: usize, identified: Receiver<Identified>, overview: Overview },
    /// A stretch will not be used.
    Rejected { index: usize, rejection: Rejection },
    /// The recording has ended.
    Ended { overview: Overview, notes: Vec<Note> },
}

pub(super) type Queue = SyncSender<Result<Heard, PipelineError>>;

/// The listener has gone away, so there is nobody to play for.
pub(super) struct Unheard;

/// Plays one recording until it ends, cannot be read further, or nobody listens.
pub(super) fn recording(
    campaign: &Campaign,
    options: &Options,
    workers: &Workers,
    index: usize,
    queue: &Queue,
) {
    let recording = &campaign.recordings[index];
    let mut asking = Asking::new(campaign, options, workers, index);
    let mut listening = Listening {
        index,
        recording: &recording.name,
        finder: RunFinder::new(limits(campaign, recording)),
        events: Vec::new(),
        overview: OverviewBuilder::default(),
        drive_is_moment: false,
        asking: &mut asking,
        queue,
    };
    let mut heard = Ok(());
    let mut pace = Pace { speed: options.speed, last_s: None };
    let covered = |start_s, end_s| {
        // A listener that is gone is noticed at the next word to it.
        drop(queue.send(Ok(Heard::Covered { start_s, end_s })));
        Ok(())
    };
    let played = play(campaign, recording, &mut { covered }, &mut |batch, bytes_read| {
        pace.wait(batch);
        heard =
            listening.batch(batch).and_then(|()| listening.tell(Heard::Read { index, bytes_read }));
        heard.is_ok()
    });
    let heard = heard.and_then(|()| match played {
        Ok(notes) => listening.end(notes),
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

/// One recording on its way through the run finder.
struct Listening<'q, 'a> {
    index: usize,
    recording: &'q str,
    finder: RunFinder,
    events: Vec<Event>,
    overview: OverviewBuilder,
    drive_is_moment: bool,
    asking: &'q mut Asking<'a>,
    queue: &'q Queue,
}

impl Listening<'_, '_> {
    fn batch(&mut self, batch: &[Sample]) -> Result<(), Unheard> {
        for sample in batch {
            self.drive_is_moment |= sample.quantity == Quantity::Moment;
            self.overview.push(sample);
            self.finder.push(sample, &mut self.events);
            if !self.events.is_empty() {
                self.tell_events()?;
            }
        }
        Ok(())
    }

    fn end(mut self, notes: Vec<Note>) -> Result<(), Unheard> {
        self.finder.finish(&mut self.events);
        self.tell_events()?;
        let messages = notes.iter().map(|note| note.message.clone()).collect();
        let overview = self.overview.so_far(self.recording, messages);
        self.tell(Heard::Ended { overview, notes })
    }

    fn tell_events(&mut self) -> Result<(), Unheard> {
        for event in std::mem::take(&mut self.events) {
            let index = self.index;
            let heard = match event {
                Event::Run(run) => Heard::Run {
                    index,
                    identified: self.asking.identify(run, self.drive_is_moment),
                    overview: self.overview.so_far(self.recording, Vec::new()),
                },
                Event::Rejected(rejection) => Heard::Rejected { index, rejection },
            };
            self.tell(heard)?;
        }
        Ok(())
    }

    fn tell(&self, heard: Heard) -> Result<(), Unheard> {
        self.queue.send(Ok(heard)).map_err(|_| Unheard)
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

fn limits(campaign: &Campaign, recording: &Recording) -> Limits {
    Limits {
        carriage_max_speed_m_s: campaign.tank.carriage_max_speed_m_s,
        declared_speed_m_s: recording.speed_m_s,
        length_pp_m: campaign.hull.length_pp_m,
        gravity_m_s2: campaign.water.gravity_m_s2,
    }
}

/// Bytes of a recording; a file that cannot be asked will say so when it is opened.
pub(super) fn size_bytes(recording: &Recording) -> u64 {
    let files = recording.files.iter();
    files.filter_map(|(_, path)| path.metadata().ok()).map(|metadata| metadata.len()).sum()
}
