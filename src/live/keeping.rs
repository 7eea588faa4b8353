//! The recording of a session: its name, its records, and its end on a thread of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use devices::clock::WallClock;
use replay::{
    ClosedRecording, Disk, Exit, ExitStatus, LIVE_SOURCE, LocalDisk, Progress, Provenance, Raw,
    Record, Recorder, ReplayError, Settings,
};

use super::error::LiveError;
use super::remembered::Remembered;
use crate::campaign::LIVE_FOLDER;
use crate::page::stamp;

/// Free space [bytes] at which recording begins again; with less it would soon stop again.
const ROOM_BYTES: u64 = 2 * Settings::LIVE.reserve_bytes;

/// Takes the records of a session, and remembers the last seconds of the links for the next.
pub(super) struct Keeper {
    recorder: Option<Recorder>,
    /// Where recordings go; none where somebody does not want any.
    folder: Option<PathBuf>,
    n_refused: u64,
    /// Whether it was stopped by something else than the want of room.
    has_failed: bool,
    remembered: Remembered,
    /// Whether what comes on the links is in the recording before.
    leads: bool,
    /// Whether what comes on the links is for the next recording.
    is_cut: bool,
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
        let remembered = Remembered::new();
        Self {
            recorder: None,
            folder: None,
            n_refused: 0,
            has_failed: false,
            remembered,
            leads: false,
            is_cut: false,
        }
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
        let is_of_link = match &record {
            Record::Raw(raw) => {
                self.remember(raw.clone());
                true
            }
            Record::Sample(_) | Record::Gap(_) | Record::Loss(_) | Record::Quality(_) => true,
            _ => false,
        };
        if !(is_of_link && self.is_cut) {
            self.mark(record);
        }
    }

    /// Takes a record that the next recording has no use for.
    pub(super) fn mark(&mut self, record: Record) {
        if let Some(recorder) = &mut self.recorder {
            let pushed = recorder.push(record);
            self.told(pushed);
        }
    }

    /// Remembers what happened on a link; a recording may begin there.
    pub(super) fn remember(&mut self, raw: Raw) {
        let is_recorded = self.leads || self.records() && !self.is_cut;
        self.remembered.push(raw, is_recorded);
    }

    /// Whether what comes on the links from here on is in the recording before.
    pub(super) fn lead(&mut self, leads: bool) {
        self.leads = leads;
    }

    /// What comes on the links from here on is for the next recording.
    pub(super) fn cut(&mut self) {
        self.is_cut = true;
    }

    /// What was remembered, for the next session.
    pub(super) fn take_remembered(&mut self) -> Remembered {
        std::mem::replace(&mut self.remembered, Remembered::new())
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
        self.has_failed |= !is_record && !error.is_for_want_of_room();
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
        let status = match self.broke_off() {
            true if self.has_failed => ExitStatus::Fail,
            true => ExitStatus::Abort,
            false => ExitStatus::Success,
        };
        let Some(recorder) = self.recorder else { return Ok(None) };
        Ok(Some(recorder.close(Exit { status, reason: reason.to_owned() })?))
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
