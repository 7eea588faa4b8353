//! A live instrument: its port's thread, and what its bytes mean.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use crate::channel::Counts;
use crate::clock::Clock;
use crate::driver::Session;
use crate::error::InstrumentError;
use crate::interpreter::{InstrumentEvent, Interpreter};
use crate::port::{LinkEvent, LinkOptions, LinkReader, adapter_latency_s};
use crate::setup::DeviceConfig;
use crate::{Device, DeviceError, Quantity, Reading, Sample};

/// What a port without a timer of its own may hold back [s]: a scheduling delay.
const PLAIN_LATENCY_S: f64 = 0.004;
/// Longest wait of one [`Device::read`] [ms].
const READ_WAIT_MS: u64 = 20;
/// Samples in one batch at most.
const BATCH_SAMPLES: usize = 1024;

/// A live instrument.
pub struct Instrument {
    name: String,
    latency_s: f64,
    reader: LinkReader,
    interpreter: Interpreter,
    waiting: VecDeque<InstrumentEvent>,
}

impl Instrument {
    /// Starts the port's thread; the port may come later.
    ///
    /// # Errors
    /// [`InstrumentError`] when the settings are wrong or the system has no thread to give.
    pub fn start(config: &DeviceConfig, clock: Arc<dyn Clock>) -> Result<Self, InstrumentError> {
        let latency_s = adapter_latency_s(&config.port).unwrap_or(0.0).max(PLAIN_LATENCY_S);
        let interpreter = Interpreter::new(config, latency_s)?;
        let session = Session::new(config.protocol()?, config.pace.pace(&config.line));
        let options = LinkOptions { path: config.port.clone(), line: config.line, realtime: true };
        let reader =
            LinkReader::start(options, session, clock).map_err(|error| InstrumentError::Port {
                device: config.name.clone(),
                port: config.port.clone(),
                fault: crate::port::PortFault::Other(error.to_string()),
                present: Vec::new(),
            })?;
        let name = config.name.clone();
        Ok(Self { name, latency_s, reader, interpreter, waiting: VecDeque::new() })
    }

    /// Waits at most so long for what happened next on the link, and appends what it means.
    pub fn next(&mut self, wait: Duration, out: &mut Vec<InstrumentEvent>) -> Option<LinkEvent> {
        let event = self.reader.next(wait)?;
        self.interpreter.interpret(&event, out);
        Some(event)
    }

    /// The port's thread, what its events mean, and the adapter's latency [s]: for who takes events
    /// on one thread and their meaning on another.
    pub fn into_parts(self) -> (LinkReader, Interpreter, f64) {
        (self.reader, self.interpreter, self.latency_s)
    }

    /// Counts of each channel since the start.
    pub fn counts(&self) -> impl Iterator<Item = (Quantity, Counts)> {
        self.interpreter.counts()
    }

    /// What its adapter may hold back [s]; a recording keeps it, since a replay needs it.
    pub fn latency_s(&self) -> f64 {
        self.latency_s
    }

    /// Whether its thread runs under `SCHED_FIFO`.
    pub fn is_realtime(&self) -> bool {
        self.reader.is_realtime()
    }
}

impl Device for Instrument {
    fn name(&self) -> &str {
        &self.name
    }

    /// Samples alone; who must know of gaps and troubles calls [`Instrument::next`].
    fn read(&mut self, samples: &mut Vec<Sample>) -> Result<Reading, DeviceError> {
        if self.waiting.is_empty() {
            let mut events = Vec::new();
            self.next(Duration::from_millis(READ_WAIT_MS), &mut events);
            self.waiting.extend(events);
        }
        let n_events = self.waiting.len().min(BATCH_SAMPLES);
        samples.extend(self.waiting.drain(..n_events).filter_map(|event| match event {
            InstrumentEvent::Sample(measured) => Some(measured.sample),
            _ => None,
        }));
        Ok(Reading::More)
    }
}
