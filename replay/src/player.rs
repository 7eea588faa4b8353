//! Plays a recording: its channels merged in time order, batch by batch.

use std::path::PathBuf;

use devices::channel::Counted;
use devices::{Device, DeviceError, Quantity, Reading, Sample};

use crate::columns::Columns;
use crate::error::ReplayError;
use crate::gaps::Gaps;
use crate::note::Note;
use crate::sources::open_streams;
use crate::stream::Stream;

/// Samples in one batch.
const BATCH_SAMPLES: usize = 1024;

/// One recording as a device.
///
/// Memory does not grow with the recording: each file is read once for each time base in it, and
/// one sample of each waits for its turn.
pub struct Player {
    name: String,
    heads: Vec<Head>,
    /// Channels whose gaps show in their intervals alone.
    gaps: Vec<Gaps>,
    /// What is known before anything is read.
    endings: Vec<Note>,
    notes: Vec<Note>,
    /// What instruments counted in the last batch, each behind so many of its samples.
    counted: Vec<(usize, Counted)>,
    zero_log_time_ns: u64,
}

struct Head {
    stream: Box<dyn Stream>,
    /// The stream's next sample; none at its end.
    next: Option<Sample>,
}

impl Player {
    /// Opens the files of one recording, each with the channel it carries, or none for all.
    ///
    /// # Errors
    /// [`ReplayError`] when a file, column or topic is missing, or the first rows are unreadable.
    pub fn open(
        name: &str,
        files: &[(Option<Quantity>, PathBuf)],
        columns: &Columns,
    ) -> Result<Self, ReplayError> {
        let sources = open_streams(name, files, columns)?;
        let mut heads = Vec::new();
        for mut stream in sources.streams {
            let next = stream.next()?;
            heads.push(Head { stream, next });
        }
        if heads.iter().all(|head| head.next.is_none()) {
            return Err(ReplayError::NoSamples { recording: name.to_owned() });
        }
        let gaps = sources.quantities.into_iter().map(Gaps::new).collect();
        let zero_log_time_ns = sources.zero_log_time_ns;
        let mut player = Self {
            name: name.to_owned(),
            heads,
            gaps,
            endings: sources.notes,
            notes: Vec::new(),
            counted: Vec::new(),
            zero_log_time_ns,
        };
        player.renew_notes(false);
        Ok(player)
    }

    /// Bytes read so far and bytes in all; a file read for several time bases counts for each.
    pub fn progress(&self) -> (u64, u64) {
        let sum = |bytes: fn(&dyn Stream) -> u64| {
            self.heads.iter().map(|head| bytes(head.stream.as_ref())).sum()
        };
        (sum(|stream| stream.bytes_read()), sum(|stream| stream.bytes_total()))
    }

    /// What was mended and lost in what was read so far.
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// What the instruments of a live recording counted in the last batch, each with the samples of
    /// the batch that came before it; other recordings tell of none.
    pub fn counted(&self) -> &[(usize, Counted)] {
        &self.counted
    }

    /// Log time [ns] of time zero: the first of a foreign MCAP recording, 0 for every other.
    pub fn zero_log_time_ns(&self) -> u64 {
        self.zero_log_time_ns
    }

    /// [`Device::read`] with its own error.
    ///
    /// # Errors
    /// [`ReplayError`] when the recording cannot be read further.
    pub fn read_batch(&mut self, samples: &mut Vec<Sample>) -> Result<Reading, ReplayError> {
        let read = self.read_samples(samples);
        self.renew_notes(matches!(read, Ok(Reading::Ended)));
        read
    }

    fn read_samples(&mut self, samples: &mut Vec<Sample>) -> Result<Reading, ReplayError> {
        let n_before = samples.len();
        self.counted.clear();
        for head in &mut self.heads {
            self.counted.extend(head.stream.take_counted().into_iter().map(|counted| (0, counted)));
        }
        for _ in 0..BATCH_SAMPLES {
            let Some(head) = earliest(&mut self.heads) else { return Ok(Reading::Ended) };
            // The sample goes out before its successor is read, so an error loses nothing.
            if let Some(sample) = head.next.take() {
                if let Some(gaps) = self.gaps.iter_mut().find(|gaps| gaps.is_of(sample.quantity)) {
                    gaps.push(&sample);
                }
                samples.push(sample);
            }
            head.next = head.stream.next()?;
            let n_read = samples.len() - n_before;
            let counted = head.stream.take_counted().into_iter();
            self.counted.extend(counted.map(|counted| (n_read, counted)));
        }
        Ok(Reading::More)
    }

    fn renew_notes(&mut self, ended: bool) {
        self.notes.clone_from(&self.endings);
        for head in &self.heads {
            head.stream.notes(&mut self.notes);
        }
        for gaps in &self.gaps {
            gaps.notes(ended, &mut self.notes);
        }
    }
}

/// The head whose sample is first in time and, at equal times, in the order of the quantities.
fn earliest(heads: &mut [Head]) -> Option<&mut Head> {
    let waiting = heads.iter_mut().filter_map(|head| head.next.map(|sample| (sample, head)));
    let first = waiting
        .min_by(|(a, _), (b, _)| a.time_s.total_cmp(&b.time_s).then(a.quantity.cmp(&b.quantity)));
    first.map(|(_, head)| head)
}

impl Device for Player {
    fn name(&self) -> &str {
        &self.name
    }

    fn read(&mut self, samples: &mut Vec<Sample>) -> Result<Reading, DeviceError> {
        self.read_batch(samples)
            .map_err(|error| DeviceError { device: self.name.clone(), source: Box::new(error) })
    }
}
