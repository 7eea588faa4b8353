//! What a person must mend, recognised in the stream and told once until it changes.

use std::path::PathBuf;

use crate::driver::{Decoded, shown};
use crate::error::InstrumentError;
use crate::setup::DeviceConfig;

/// Bytes without one good frame before the line's settings are doubted.
const GARBAGE_BYTES: u64 = 64;
/// And for so long [ns], since an instrument may be in the middle of its boot message.
const GARBAGE_NS: u64 = 1_000_000_000;
/// Requests in a row without an answer.
const SILENT_REQUESTS: u32 = 5;
/// Answers in a row that nobody asked for.
const UNASKED_ANSWERS: u32 = 3;

/// Watches one link.
pub(crate) struct Troubles {
    device: String,
    port: PathBuf,
    line: String,
    identity: Option<String>,
    opened_ns: u64,
    n_bytes: u64,
    n_frames: u64,
    seen: String,
    silent: (u32, String),
    unasked: (u32, String),
    refused: Option<InstrumentError>,
    /// Told and not yet over.
    told: Vec<std::mem::Discriminant<InstrumentError>>,
}

impl Troubles {
    pub(crate) fn new(config: &DeviceConfig) -> Self {
        Self {
            device: config.name.clone(),
            port: config.port.clone(),
            line: config.line.name(),
            identity: config.identity.clone(),
            opened_ns: 0,
            n_bytes: 0,
            n_frames: 0,
            seen: String::new(),
            silent: (0, String::new()),
            unasked: (0, String::new()),
            refused: None,
            told: Vec::new(),
        }
    }

    pub(crate) fn opened(&mut self, at_ns: u64) {
        self.opened_ns = at_ns;
        self.n_bytes = 0;
        self.n_frames = 0;
        self.silent.0 = 0;
        self.unasked.0 = 0;
        self.told.clear();
    }

    pub(crate) fn received(&mut self, bytes: &[u8], _at_ns: u64) {
        self.n_bytes += bytes.len() as u64;
        if self.n_frames == 0 {
            self.seen = shown(bytes);
        }
    }

    pub(crate) fn decoded(&mut self, what: &Decoded) {
        match what {
            Decoded::Values { .. } | Decoded::Identity(_) => {
                self.n_frames += 1;
                self.silent.0 = 0;
                if matches!(what, Decoded::Values { .. }) {
                    self.unasked.0 = self.unasked.0.saturating_sub(1);
                }
            }
            Decoded::Silent { request, .. } => {
                self.silent = (self.silent.0 + 1, request.clone());
            }
            Decoded::Unasked { seen } => self.unasked = (self.unasked.0 + 2, seen.clone()),
            Decoded::Refused { request, reply } => {
                self.n_frames += 1;
                self.silent.0 = 0;
                self.refused = Some(InstrumentError::Refused {
                    device: self.device.clone(),
                    port: self.port.clone(),
                    request: request.clone(),
                    reply: reply.clone(),
                });
            }
            Decoded::Damaged { .. } | Decoded::Missed { .. } => {}
        }
    }

    /// A wrong answer to the question who it is.
    pub(crate) fn identity(&mut self, seen: &str) -> Option<InstrumentError> {
        let expected =
            self.identity.clone().filter(|expected| !seen.contains(expected.as_str()))?;
        let (device, port) = (self.device.clone(), self.port.clone());
        self.once(InstrumentError::WrongDevice { device, port, expected, seen: seen.to_owned() })
    }

    /// Not a byte came for a second.
    pub(crate) fn silence(&mut self, _at_ns: u64) -> Option<InstrumentError> {
        let (n_silent, request) = &self.silent;
        let request = (*n_silent > 0).then(|| request.clone());
        let (device, port) = (self.device.clone(), self.port.clone());
        self.once(InstrumentError::Silent { device, port, request })
    }

    /// The trouble that is certain by now.
    pub(crate) fn judge(&mut self, now_ns: u64) -> Option<InstrumentError> {
        let (device, port) = (self.device.clone(), self.port.clone());
        if let Some(refused) = self.refused.take() {
            return self.once(refused);
        }
        if 2 * UNASKED_ANSWERS <= self.unasked.0 {
            self.unasked.0 = 0;
            return self.once(InstrumentError::Unasked {
                device,
                port,
                seen: self.unasked.1.clone(),
            });
        }
        let garbage = self.n_frames == 0
            && self.n_bytes >= GARBAGE_BYTES
            && now_ns.saturating_sub(self.opened_ns) >= GARBAGE_NS;
        if garbage {
            let (line, n_bytes, seen) = (self.line.clone(), self.n_bytes, self.seen.clone());
            return self.once(InstrumentError::Garbage { device, port, line, n_bytes, seen });
        }
        if self.n_bytes == 0 && self.silent.0 >= SILENT_REQUESTS {
            let request = Some(self.silent.1.clone());
            return self.once(InstrumentError::Silent { device, port, request });
        }
        None
    }

    fn once(&mut self, error: InstrumentError) -> Option<InstrumentError> {
        let kind = std::mem::discriminant(&error);
        if self.told.contains(&kind) {
            return None;
        }
        self.told.push(kind);
        Some(error)
    }
}
