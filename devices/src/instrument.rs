//! A live instrument: its port's thread, and what its bytes mean.

use std::collections::VecDeque;
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use crate::channel::Counts;
use crate::clock::Clock;
use crate::driver::Session;
use crate::error::InstrumentError;
use crate::interpreter::{InstrumentEvent, Interpreter};
use crate::port::{
    LinkEvent, LinkOptions, LinkReader, LinkThread, Outlet, PortFault, USB_SERIAL_FOLDER,
    adapter_latency_s,
};
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

/// An instrument whose events another thread takes from where its port's thread puts them.
pub struct AttachedInstrument {
    /// The port's thread.
    pub thread: LinkThread,
    /// What its events mean.
    pub interpreter: Interpreter,
    /// What its adapter may hold back [s]; a recording keeps it, since a replay needs it.
    pub latency_s: f64,
}

impl Instrument {
    /// Starts the port's thread; the port may come later.
    ///
    /// # Errors
    /// [`InstrumentError`] when the settings are wrong or the system has no thread to give.
    pub fn start(config: &DeviceConfig, clock: Arc<dyn Clock>) -> Result<Self, InstrumentError> {
        let (session, options) = conversation(config)?;
        let latency_s = latency_s(config);
        let interpreter = Interpreter::new(config, latency_s)?;
        let reader = LinkReader::start(options, session, clock);
        let reader = reader.map_err(|error| no_thread(config, &error))?;
        let name = config.name.clone();
        Ok(Self { name, latency_s, reader, interpreter, waiting: VecDeque::new() })
    }

    /// The same for who takes the events of several ports from one queue, into which `outlet` puts
    /// them.
    ///
    /// # Errors
    /// As [`Instrument::start`].
    pub fn attach(
        config: &DeviceConfig,
        clock: Arc<dyn Clock>,
        outlet: Outlet,
    ) -> Result<AttachedInstrument, InstrumentError> {
        let (session, options) = conversation(config)?;
        let latency_s = latency_s(config);
        let interpreter = Interpreter::new(config, latency_s)?;
        let thread = LinkThread::start(options, session, clock, outlet);
        let thread = thread.map_err(|error| no_thread(config, &error))?;
        Ok(AttachedInstrument { thread, interpreter, latency_s })
    }

    /// Waits at most so long for what happened next on the link, and appends what it means.
    pub fn next(&mut self, wait: Duration, out: &mut Vec<InstrumentEvent>) -> Option<LinkEvent> {
        let event = self.reader.next(wait)?;
        self.interpreter.interpret(&event, out);
        Some(event)
    }

    /// Counts of each channel since the start.
    pub fn counts(&self) -> impl Iterator<Item = (Quantity, Counts)> {
        self.interpreter.counts()
    }

    /// What its adapter may hold back [s]; a replay needs it.
    pub fn latency_s(&self) -> f64 {
        self.latency_s
    }
}

fn conversation(config: &DeviceConfig) -> Result<(Session, LinkOptions), InstrumentError> {
    let session = Session::new(config.protocol()?, config.pace.pace(&config.line));
    let options = LinkOptions { path: config.port.clone(), line: config.line, realtime: true };
    Ok((session, options))
}

fn latency_s(config: &DeviceConfig) -> f64 {
    let held_s = adapter_latency_s(&config.port, Path::new(USB_SERIAL_FOLDER));
    held_s.unwrap_or(0.0).max(PLAIN_LATENCY_S)
}

fn no_thread(config: &DeviceConfig, error: &io::Error) -> InstrumentError {
    InstrumentError::Port {
        device: config.name.clone(),
        port: config.port.clone(),
        fault: PortFault::Other(error.to_string()),
        present: Vec::new(),
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
