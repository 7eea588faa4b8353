//! A recording of live instruments, its raw bytes decoded anew by the drivers that ran live.

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};

use devices::channel::Counted;
use devices::{Attachment, InstrumentEvent, Sample};

use crate::error::ReplayError;
use crate::link_decoder::LinkDecoder;
use crate::link_losses::LinkLosses;
use crate::note::Note;
use crate::record::{AttachedDevice, Direction, Raw, Record};
use crate::recorded::Recorded;
use crate::stream::Stream;

/// [`Provenance::source`](crate::Provenance) of a recording whose raw bytes its own drivers decode.
pub const LIVE_SOURCE: &str = "live instruments";
/// Topic of the devices, with all that decoding their bytes takes.
const DEVICE_TOPIC: &str = "/device";

/// Whether a recording says of itself that its raw bytes give its samples.
pub(crate) fn is_live(metadata: &BTreeMap<String, String>) -> bool {
    metadata.get("source").is_some_and(|source| source == LIVE_SOURCE)
}

/// Samples of one recording in the order in which they came.
///
/// The run finder gets what it got live, in the same order, so that its runs are the same to the
/// bit; a merge by time would exchange samples of instruments that differ in their delays.
pub(crate) struct LiveStream {
    path: PathBuf,
    recorded: Recorded,
    attached: BTreeMap<String, LinkDecoder>,
    waiting: VecDeque<Sample>,
    events: Vec<InstrumentEvent>,
    losses: LinkLosses,
    counted: Vec<Counted>,
    samples: u64,
}

impl LiveStream {
    pub(crate) fn open(path: &Path) -> Result<Self, ReplayError> {
        Ok(Self {
            path: path.to_owned(),
            recorded: Recorded::open(path)?.without_samples(),
            attached: BTreeMap::new(),
            waiting: VecDeque::new(),
            events: Vec::new(),
            losses: LinkLosses::default(),
            counted: Vec::new(),
            samples: 0,
        })
    }

    fn attach(&mut self, device: AttachedDevice) -> Result<(), ReplayError> {
        let AttachedDevice { device, settings, .. } = device;
        let attachment = Attachment::from_text(&settings).map_err(|error| error.to_string());
        let started = attachment
            .and_then(|known| LinkDecoder::new(&known).map_err(|error| error.to_string()));
        let started = started.map_err(|found| ReplayError::Field {
            path: self.path.clone(),
            topic: DEVICE_TOPIC.to_owned(),
            message: self.attached.len() as u64 + 1,
            field: "settings".to_owned(),
            found: format!("device \"{device}\": {found}"),
        })?;
        self.attached.insert(device, started);
        Ok(())
    }

    fn decode(&mut self, raw: &Raw) {
        let Some(decoder) = self.attached.get_mut(&*raw.device) else { return };
        let Some(event) = raw.link_event() else {
            return match raw.direction {
                Direction::Before => decoder.lead(),
                _ => decoder.begin(),
            };
        };
        decoder.take(&event, &mut self.events);
        self.counted.extend(decoder.counted());
        for event in self.events.drain(..) {
            self.losses.push(&raw.device, &event);
            self.waiting.extend(event.usable_sample());
        }
    }
}

impl Stream for LiveStream {
    fn next(&mut self) -> Result<Option<Sample>, ReplayError> {
        loop {
            if let Some(sample) = self.waiting.pop_front() {
                self.samples += 1;
                return Ok(Some(sample));
            }
            match self.recorded.next_record()? {
                Some(Record::Device(device)) => self.attach(device)?,
                Some(Record::Raw(raw)) => self.decode(&raw),
                Some(_) => {}
                None => return Ok(None),
            }
        }
    }

    fn take_counted(&mut self) -> Vec<Counted> {
        std::mem::take(&mut self.counted)
    }

    fn bytes_read(&self) -> u64 {
        self.recorded.progress().0
    }

    fn bytes_total(&self) -> u64 {
        self.recorded.progress().1
    }

    fn notes(&self, notes: &mut Vec<Note>) {
        self.losses.notes(notes);
        if let Some(offset) = self.recorded.torn_at() {
            notes.push(Note::lost(format!(
                "\"{}\": the file is torn at byte {offset} of {}, {} samples before it read",
                self.path.display(),
                self.recorded.progress().1,
                self.samples
            )));
        }
    }
}
