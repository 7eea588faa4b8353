//! What a person must mend, recognised in the stream and told once until it changes.

use std::path::PathBuf;

use crate::driver::{Decoded, Purpose, shown};
use crate::error::InstrumentError;
use crate::setup::DeviceConfig;

/// Bytes without one good frame before the line's settings are doubted.
const GARBAGE_BYTES: u64 = 64;
/// And for so long [ns], since an instrument may be in the middle of its boot message.
const GARBAGE_NS: u64 = 1_000_000_000;
/// Requests in a row without an answer, before silence is told.
const SILENT_REQUESTS: u32 = 5;
/// An instrument that talks has so long [ns] to say who it is after the question has got no answer:
/// a board that its port resets says so when it has started.
const NAMELESS_NS: u64 = 1_500_000_000;
/// Weight of answers that nobody asked for, before they are told.
const UNASKED_MAX: u32 = 6;
/// Weight of one of them; every answer that was asked for takes one off.
const UNASKED_WEIGHT: u32 = 2;

/// Damaged answers of one station, less its good ones, before they are told.
const DAMAGED_MAX: u32 = 5;

/// Watches one link.
pub(crate) struct Troubles {
    device: String,
    port: PathBuf,
    line: String,
    identity: Option<String>,
    /// Since when, and on which question, it has not said who it is.
    nameless: Option<(u64, String)>,
    opened_ns: u64,
    n_bytes: u64,
    n_frames: u64,
    seen: String,
    /// Requests in a row that did not bring a field, by field.
    silent: Vec<u32>,
    /// The last request without an answer.
    request: Option<String>,
    unasked: u32,
    /// Bytes that were no answer, since the last question.
    damage: Option<String>,
    /// Damaged answers, less the good ones, by field.
    damaged: Vec<u32>,
    /// Certain, and not yet told.
    found: Vec<InstrumentError>,
    /// Told and not yet over.
    told: Vec<std::mem::Discriminant<InstrumentError>>,
    silence_told: bool,
}

impl Troubles {
    pub(crate) fn new(config: &DeviceConfig, n_fields: usize) -> Self {
        Self {
            device: config.name.clone(),
            port: config.port.clone(),
            line: config.line.name(),
            identity: config.identity.clone(),
            nameless: None,
            opened_ns: 0,
            n_bytes: 0,
            n_frames: 0,
            seen: String::new(),
            silent: vec![0; n_fields],
            request: None,
            unasked: 0,
            damage: None,
            damaged: vec![0; n_fields],
            found: Vec::new(),
            told: Vec::new(),
            silence_told: false,
        }
    }

    pub(crate) fn opened(&mut self, at_ns: u64) {
        self.opened_ns = at_ns;
        self.nameless = None;
        self.n_bytes = 0;
        self.n_frames = 0;
        self.silent.fill(0);
        self.request = None;
        self.unasked = 0;
        self.damage = None;
        self.damaged.fill(0);
        self.found.clear();
        self.told.clear();
        self.silence_told = false;
    }

    pub(crate) fn received(&mut self, bytes: &[u8]) {
        self.n_bytes += bytes.len() as u64;
        if self.n_frames == 0 {
            self.seen = shown(bytes);
        }
    }

    pub(crate) fn decoded(&mut self, what: &Decoded, at_ns: u64) {
        let (device, port) = (self.device.clone(), self.port.clone());
        match what {
            Decoded::Values { values, .. } => {
                self.n_frames += 1;
                self.unasked = self.unasked.saturating_sub(1);
                self.damage = None;
                for value in values {
                    if let Some(silent) = self.silent.get_mut(value.field) {
                        *silent = 0;
                    }
                    if let Some(damaged) = self.damaged.get_mut(value.field) {
                        *damaged = damaged.saturating_sub(1);
                    }
                }
                // The next silence is another one.
                self.silence_told &= self.silent.iter().any(|silent| *silent > 0);
            }
            Decoded::Identity(seen) => {
                // Who says its name may still send readings that make no frame of this profile.
                self.n_bytes = 0;
                self.nameless = None;
                let expected = self.identity.clone();
                if let Some(expected) = expected.filter(|expected| !seen.contains(expected)) {
                    let seen = seen.clone();
                    self.once(InstrumentError::WrongDevice { device, port, expected, seen });
                }
            }
            Decoded::Silent { request, purpose: Purpose::Identify, .. } => {
                self.damage = None;
                self.nameless.get_or_insert_with(|| (at_ns, request.clone()));
            }
            Decoded::Silent { request, station, fields, .. } => match self.damage.take() {
                Some(seen) => self.damaged_answer(request, *station, fields, seen),
                None => self.no_answer(request, fields),
            },
            Decoded::Unasked { seen } => {
                self.unasked += UNASKED_WEIGHT;
                if self.unasked >= UNASKED_MAX {
                    self.unasked = 0;
                    let seen = seen.clone();
                    self.once(InstrumentError::Unasked { device, port, seen });
                }
            }
            Decoded::Refused { request, reply } => {
                self.n_frames += 1;
                let (request, reply) = (request.clone(), reply.clone());
                self.once(InstrumentError::Refused { device, port, request, reply });
            }
            Decoded::Damaged { seen, .. } => self.damage = Some(seen.clone()),
            Decoded::Missed { .. } => {}
        }
    }

    /// On a bus the answers of two stations with one address garble each other.
    fn damaged_answer(
        &mut self,
        request: &str,
        station: Option<u16>,
        fields: &[usize],
        seen: String,
    ) {
        let mut most = 0;
        for field in fields {
            if let Some(damaged) = self.damaged.get_mut(*field) {
                *damaged += 1;
                most = most.max(*damaged);
            }
        }
        if most >= DAMAGED_MAX {
            self.once(InstrumentError::Collided {
                device: self.device.clone(),
                port: self.port.clone(),
                station,
                n_answers: most,
                request: request.to_owned(),
                seen,
            });
        }
    }

    /// One of several stations may be silent while the others talk.
    fn no_answer(&mut self, request: &str, fields: &[usize]) {
        self.request = Some(request.to_owned());
        let mut longest = 0;
        for field in fields {
            if let Some(silent) = self.silent.get_mut(*field) {
                *silent += 1;
                longest = longest.max(*silent);
            }
        }
        if longest >= SILENT_REQUESTS {
            self.silence();
        }
    }

    /// Not a byte came for a second, or not an answer to several requests.
    pub(crate) fn silence(&mut self) {
        // Bytes that make no frame are garbage, which is told with more to go by.
        let garbage = self.n_bytes >= GARBAGE_BYTES && self.n_frames == 0;
        if self.silence_told || garbage {
            return;
        }
        self.silence_told = true;
        self.found.push(InstrumentError::Silent {
            device: self.device.clone(),
            port: self.port.clone(),
            line: self.line.clone(),
            request: self.request.clone(),
        });
    }

    /// The troubles that are certain by now and were not told before.
    pub(crate) fn take(&mut self, now_ns: u64) -> Vec<InstrumentError> {
        // Who answers has understood the question, so that its line's settings are right.
        let answers = self.damaged.iter().any(|damaged| *damaged > 0);
        let garbage = self.n_frames == 0
            && !answers
            && self.n_bytes >= GARBAGE_BYTES
            && now_ns.saturating_sub(self.opened_ns) >= GARBAGE_NS;
        if garbage {
            self.once(InstrumentError::Garbage {
                device: self.device.clone(),
                port: self.port.clone(),
                line: self.line.clone(),
                n_bytes: self.n_bytes,
                seen: self.seen.clone(),
            });
        }
        // One that says nothing at all is told as silent.
        let talks = self.n_frames > 0 && self.silent.iter().all(|silent| *silent == 0);
        let late = |since_ns: u64| now_ns.saturating_sub(since_ns) >= NAMELESS_NS;
        if let (Some(expected), Some((since_ns, request))) = (&self.identity, &self.nameless)
            && talks
            && late(*since_ns)
        {
            self.once(InstrumentError::NotSaid {
                device: self.device.clone(),
                port: self.port.clone(),
                expected: expected.clone(),
                request: request.clone(),
            });
        }
        std::mem::take(&mut self.found)
    }

    fn once(&mut self, error: InstrumentError) {
        let kind = std::mem::discriminant(&error);
        if !self.told.contains(&kind) {
            self.told.push(kind);
            self.found.push(error);
        }
    }
}
