//! The recording of a session: its name, its records, and its end on a thread of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use devices::clock::WallClock;
use replay::{
    ClosedRecording, Disk, Exit, LIVE_SOURCE, LocalDisk, PreTrigger, Progress, Provenance, Raw,
    Record, Recorder, ReplayError, Settings,
};

use super::error::LiveError;
use crate::campaign::LIVE_FOLDER;
use crate::page::stamp;

/// Free space [bytes] at which recording begins again; with less it would soon stop again.
const ROOM_BYTES: u64 = 2 * Settings::LIVE.reserve_bytes;

/// Of what is not recorded, so much is remembered [s] and begins the next recording: whoever lets
/// the model go and then sees that nothing is recorded has the run.
const REMEMBERED_S: f64 = 30.0;
/// Memory that it may take [bytes]: four times what four channels at 2 kHz need.
const REMEMBERED_BYTES: usize = 32 << 20;

/// Takes the records of a session; of one that is not recorded it remembers the last seconds of the
/// links.
pub(super) struct Keeper {
    recorder: Option<Recorder>,
    /// Where recordings go; none where somebody does not want any.
    folder: Option<PathBuf>,
    n_refused: u64,
    ring: PreTrigger,
}

/// Name of a recording that begins now, relative to the campaign's folder:
/// `live/2026-11-26_081530.mcap`.
pub(super) fn fresh_name(folder: &Path, clock: &WallClock, now_ns: u64) -> String {
    let stamp = stamp(clock, now_ns, "%Y-%m-%d_%H%M%S");
    let taken = |name: &str| {
        let part = format!("{name}.part");
        [name, &part].iter().any(|name| folder.join(name).symlink_metadata().is_ok())
    };
    let numbered = (2_u32..).map(|number| format!("{LIVE_FOLDER}/{stamp}_{number}.mcap"));
    let mut names = std::iter::once(format!("{LIVE_FOLDER}/{stamp}.mcap")).chain(numbered);
    names.find(|name| !taken(name)).expect("there are fewer files than numbers")
}

impl Keeper {
    /// Begins a recording whose time zero is the clock's; on a full disk, which is told, it waits.
    pub(super) fn start(
        path: &Path,
        campaign_text: String,
        clock: &WallClock,
    ) -> Result<Self, LiveError> {
        let folder = path.parent().unwrap_or(path).to_owned();
        if let Err(source) = fs::create_dir_all(&folder) {
            return Err(LiveError::File { path: folder, source });
        }
        let provenance = Provenance {
            campaign_text,
            source: LIVE_SOURCE.to_owned(),
            zero_log_time_ns: u64::try_from(clock.start_unix_ns()).unwrap_or_default(),
        };
        let started = Recorder::start(path, &provenance, Settings::LIVE, Box::new(LocalDisk));
        let mut keeper = Self { folder: Some(folder), ..Self::idle() };
        match started {
            Ok(recorder) => keeper.recorder = Some(recorder),
            Err(error) if error.is_for_want_of_room() => keeper.told(Err(error)),
            Err(error) => return Err(error.into()),
        }
        Ok(keeper)
    }

    /// Of a session that somebody does not want recorded.
    pub(super) fn idle() -> Self {
        let ring = PreTrigger::new(REMEMBERED_S, REMEMBERED_BYTES);
        Self { recorder: None, folder: None, n_refused: 0, ring }
    }

    /// Of a session that waits for the disk to have room.
    pub(super) fn waiting(path: &Path) -> Self {
        Self { folder: Some(path.parent().unwrap_or(path).to_owned()), ..Self::idle() }
    }

    /// Whether anything is recorded.
    pub(super) fn records(&self) -> bool {
        self.recorder.as_ref().is_some_and(|recorder| !recorder.progress().stopped)
    }

    /// Whether a recording was begun that a full or failing disk has stopped.
    pub(super) fn broke_off(&self) -> bool {
        self.recorder.is_some() && !self.records()
    }

    /// Whether nothing is recorded although it is wanted: the disk is full, or fails.
    fn is_stopped(&self) -> bool {
        self.folder.is_some() && !self.records()
    }

    /// Whether recording has stopped, and the disk has room for another.
    pub(super) fn may_begin_again(&self) -> bool {
        let free_bytes = |folder: &PathBuf| LocalDisk.free_bytes(folder).unwrap_or_default();
        self.is_stopped() && self.folder.as_ref().map_or(0, free_bytes) >= ROOM_BYTES
    }

    /// Takes a record; a disk that fails is told once and stops nothing else.
    pub(super) fn push(&mut self, record: Record) {
        match (&mut self.recorder, record) {
            (Some(recorder), record) => {
                let pushed = recorder.push(record);
                self.told(pushed);
            }
            (None, Record::Raw(raw)) => self.ring.push(Record::Raw(raw)),
            (None, _) => {}
        }
    }

    /// Remembers what a recording need not hold unless it begins there.
    pub(super) fn remember(&mut self, raw: Option<Raw>) {
        if let Some(raw) = raw.filter(|_| self.recorder.is_none()) {
            self.ring.push(Record::Raw(raw));
        }
    }

    /// What was remembered.
    pub(super) fn take_ring(&mut self) -> PreTrigger {
        std::mem::replace(&mut self.ring, Self::idle().ring)
    }

    /// Does what is due at a time of the world.
    pub(super) fn tick(&mut self, now: Duration) {
        let ticked = self.recorder.as_mut().map_or(Ok(()), |recorder| recorder.tick(now));
        self.told(ticked);
    }

    fn told(&mut self, done: Result<(), ReplayError>) {
        let Err(error) = done else { return };
        let is_record = matches!(
            error,
            ReplayError::Unrecordable { .. }
                | ReplayError::UnrecordableDocument { .. }
                | ReplayError::TimeBackwards { .. }
        );
        self.n_refused += u64::from(is_record);
        // A broken instrument may bring a thousand such numbers a second.
        if !is_record || self.n_refused.is_power_of_two() {
            let (n_refused, hint) = (self.n_refused, error.hint().unwrap_or_default());
            tracing::error!(n_refused, hint, "not recorded: {error}");
        }
    }

    pub(super) fn progress(&self) -> Progress {
        let progress = self.recorder.as_ref().map(Recorder::progress).unwrap_or_default();
        let unrecorded = progress.unrecorded + self.n_refused;
        Progress { unrecorded, stopped: self.is_stopped(), ..progress }
    }

    /// Ends the recording; [`ClosedRecording::convert`] gives it its name.
    pub(super) fn close(self, reason: &str) -> Result<Option<ClosedRecording>, LiveError> {
        let Some(recorder) = self.recorder else { return Ok(None) };
        Ok(Some(recorder.close(Exit::success(reason))?))
    }
}

/// Finishes what a daemon that died has left, and tells of it.
pub(super) fn recover(folder: &Path) -> Result<(), LiveError> {
    let live: PathBuf = folder.join(LIVE_FOLDER);
    if !live.exists() {
        return Ok(());
    }
    for orphan in replay::recover(&live, &mut LocalDisk)? {
        let part = orphan.part.display().to_string();
        match orphan.fate {
            replay::Fate::Recovered(finished) => {
                let (path, torn) = (finished.path.display().to_string(), finished.torn_bytes);
                tracing::warn!(part, path, torn_bytes = torn, "recovered");
            }
            replay::Fate::AlreadyFinished { .. } | replay::Fate::Empty => {
                tracing::info!(part, "held nothing that is not kept already; removed");
            }
            replay::Fate::Left(error) => tracing::error!(part, "left as it is: {error}"),
        }
    }
    Ok(())
}
