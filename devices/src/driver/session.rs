//! The state machine around a protocol: sends, waits, gives up, resynchronises, stamps.
//!
//! After a silence the line is left alone for one more waiting time, because a late answer would
//! otherwise pass for the answer to the next request.

use std::collections::VecDeque;

use super::{Content, Damage, FRAME_BYTES_MAX, FieldValue, Found, Protocol, Purpose, Request};

/// When to ask, and how long to wait.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// From one cycle to the next [ns]; 0 as fast as answers come.
    pub period_ns: u64,
    /// From the end of a request to its answer at most [ns].
    pub timeout_ns: u64,
    /// Silence between an answer and the next request [ns].
    pub gap_ns: u64,
    /// One byte on the wire [ns].
    pub byte_ns: u64,
    /// From opening the port until the instrument has started [ns].
    pub boot_ns: u64,
}

/// What the bytes said.
#[derive(Debug, Clone, PartialEq)]
pub enum Decoded {
    /// Readings of one instant.
    Values {
        /// One per field.
        values: Vec<FieldValue>,
        /// Sequence number.
        sequence: Option<u64>,
        /// Device time.
        ticks: Option<u64>,
        /// What the host knows of the instant.
        taken: Taken,
    },
    /// An instrument said who it is.
    Identity(String),
    /// An instrument refused a request.
    Refused {
        /// The request.
        request: String,
        /// What came back.
        reply: String,
    },
    /// No answer came in time.
    Silent {
        /// The request.
        request: String,
        /// What for.
        purpose: Purpose,
        /// The address that it went to, where the bus has such.
        station: Option<u16>,
        /// Fields that it was to bring.
        fields: Vec<usize>,
        /// How long was waited [ns].
        waited_ns: u64,
    },
    /// Bytes that are no frame.
    Damaged {
        /// How many.
        n_bytes: usize,
        /// Why.
        damage: Damage,
        /// The first of them, for messages.
        seen: String,
    },
    /// A whole answer that nobody asked for: two instruments on one address, or a late one.
    Unasked {
        /// What came.
        seen: String,
    },
    /// Cycles that could not be begun in time.
    Missed {
        /// How many.
        n_cycles: u64,
    },
}

/// What the host knows of the instant of a reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Taken {
    /// It came unasked: its last byte arrived then, less its time on the wire [ns].
    Arrived(u64),
    /// It was fetched: the request was sent, and the answer began, at these times [ns].
    Between(u64, u64),
    /// The bus was told to measure between these times [ns].
    Held(u64, u64),
}

struct Waiting {
    request: Request,
    sent_ns: u64,
    deadline_ns: u64,
}

/// One link's conversation.
pub struct Session {
    protocol: Box<dyn Protocol>,
    pace: Pace,
    buffer: Vec<u8>,
    opening: VecDeque<Request>,
    cycle: Vec<Request>,
    /// The cycle's next request.
    next: usize,
    /// Not before then.
    ready_ns: u64,
    cycle_start_ns: u64,
    waiting: Option<Waiting>,
    /// When the bus was last told to hold its readings.
    held: Option<(u64, u64)>,
    /// When the round that the last poll began was due.
    round_due_ns: Option<u64>,
}

impl Session {
    /// A conversation that has not begun; [`Session::open`] begins it.
    pub fn new(protocol: Box<dyn Protocol>, pace: Pace) -> Self {
        let cycle = protocol.cycle();
        Self {
            protocol,
            pace,
            buffer: Vec::new(),
            opening: VecDeque::new(),
            cycle,
            next: 0,
            ready_ns: 0,
            cycle_start_ns: 0,
            waiting: None,
            held: None,
            round_due_ns: None,
        }
    }

    /// The protocol spoken.
    pub fn protocol(&self) -> &dyn Protocol {
        self.protocol.as_ref()
    }

    /// Bytes held back until their frame is whole.
    pub fn n_held(&self) -> usize {
        self.buffer.len()
    }

    /// The link has opened: everything starts over.
    pub fn open(&mut self, now_ns: u64) {
        self.buffer.clear();
        self.opening = self.protocol.opening().into();
        self.next = 0;
        self.ready_ns = now_ns + self.pace.boot_ns;
        self.cycle_start_ns = self.ready_ns;
        self.waiting = None;
        self.held = None;
    }

    /// Goes on with a conversation that another session led up to the round that was due then.
    pub fn join(&mut self, due_ns: u64) {
        self.open(due_ns);
        self.opening.clear();
        (self.ready_ns, self.cycle_start_ns) = (due_ns, due_ns);
    }

    /// Whether it asks round by round; other instruments tell by themselves.
    pub fn asks(&self) -> bool {
        !self.cycle.is_empty()
    }

    /// When the round was due that the last [`Session::poll`] began, if it began one [ns].
    pub fn round_due_ns(&self) -> Option<u64> {
        self.round_due_ns
    }

    /// When [`Session::poll`] has something to do [ns]; none when only bytes can move things.
    pub fn wake_ns(&self) -> Option<u64> {
        if let Some(waiting) = &self.waiting {
            return Some(waiting.deadline_ns);
        }
        if !self.opening.is_empty() || self.next > 0 {
            return Some(self.ready_ns);
        }
        (!self.cycle.is_empty()).then(|| self.ready_ns.max(self.cycle_start_ns))
    }

    /// Gives up on what is overdue, and appends what is to be sent now.
    pub fn poll(&mut self, now_ns: u64, send: &mut Vec<u8>, decoded: &mut Vec<Decoded>) {
        self.expire(now_ns, decoded);
        self.round_due_ns = None;
        if self.waiting.is_some() || self.wake_ns().is_none_or(|wake| wake > now_ns) {
            return;
        }
        let request = match self.opening.pop_front() {
            Some(request) => request,
            None => self.next_of_cycle(now_ns, decoded),
        };
        self.drop_rest(decoded);
        send.extend_from_slice(&request.bytes);
        let on_wire_ns = now_ns + self.wire_ns(request.bytes.len());
        if request.purpose == Purpose::Hold {
            self.held = Some((now_ns, on_wire_ns));
        }
        if request.answered {
            let deadline_ns = on_wire_ns + self.pace.timeout_ns;
            self.waiting = Some(Waiting { request, sent_ns: now_ns, deadline_ns });
        } else {
            self.ready_ns = on_wire_ns + self.pace.gap_ns;
        }
    }

    fn next_of_cycle(&mut self, now_ns: u64, decoded: &mut Vec<Decoded>) -> Request {
        let request = self.cycle[self.next].clone();
        if self.next == 0 {
            self.held = None;
            let due_ns = self.cycle_start_ns;
            self.round_due_ns = Some(due_ns);
            let n_cycles = (now_ns - due_ns).checked_div(self.pace.period_ns).unwrap_or(0);
            if n_cycles > 0 {
                decoded.push(Decoded::Missed { n_cycles });
            }
            self.cycle_start_ns = due_ns + (n_cycles + 1) * self.pace.period_ns;
        }
        self.next = (self.next + 1) % self.cycle.len();
        request
    }

    /// Takes bytes whose last arrived at `at_ns`.
    pub fn receive(&mut self, bytes: &[u8], at_ns: u64, decoded: &mut Vec<Decoded>) {
        self.expire(at_ns, decoded);
        // In pieces, so that the buffer stays bounded whatever a driver takes for a part.
        for piece in bytes.chunks(FRAME_BYTES_MAX) {
            self.buffer.extend_from_slice(piece);
            self.decode(at_ns, decoded);
        }
    }

    fn decode(&mut self, at_ns: u64, decoded: &mut Vec<Decoded>) {
        let mut start = 0;
        while start < self.buffer.len() {
            let asked = self.waiting.as_ref().map(|waiting| &waiting.request);
            let rest = &self.buffer[start..];
            let n_bytes = match self.protocol.decode(rest, asked) {
                Found::Part if rest.len() < FRAME_BYTES_MAX => break,
                Found::Part => {
                    decoded.push(damaged(&rest[..1], Damage::TooLong));
                    1
                }
                Found::Skip { n_bytes } => n_bytes,
                Found::Noise { n_bytes, damage } => {
                    decoded.push(damaged(&rest[..n_bytes.clamp(1, rest.len())], damage));
                    n_bytes
                }
                Found::Frame { n_bytes, content } => {
                    let n_bytes = n_bytes.clamp(1, rest.len());
                    let seen = shown(&rest[..n_bytes]);
                    self.take(content, seen, n_bytes, at_ns, decoded);
                    n_bytes
                }
            };
            start += n_bytes.max(1);
        }
        self.buffer.drain(..start.min(self.buffer.len()));
    }

    fn take(
        &mut self,
        content: Content,
        seen: String,
        n_bytes: usize,
        at_ns: u64,
        decoded: &mut Vec<Decoded>,
    ) {
        let purpose = self.waiting.as_ref().map(|waiting| waiting.request.purpose);
        let fits = match &content {
            Content::Values { .. } => purpose == Some(Purpose::Read),
            Content::Identity(_) => purpose == Some(Purpose::Identify),
            Content::Accepted | Content::Refused(_) => purpose.is_some(),
        };
        let streams = self.cycle.is_empty();
        let answered = if fits { self.waiting.take() } else { None };
        if answered.is_some() {
            self.ready_ns = at_ns + self.pace.gap_ns;
        }
        match (content, answered) {
            (Content::Values { values, sequence, ticks }, Some(answered)) => {
                let began_ns = at_ns.saturating_sub(self.wire_ns(n_bytes)).max(answered.sent_ns);
                let taken = match self.held {
                    Some((from_ns, to_ns)) => Taken::Held(from_ns, to_ns),
                    None => Taken::Between(answered.sent_ns, began_ns),
                };
                decoded.push(Decoded::Values { values, sequence, ticks, taken });
            }
            (Content::Values { values, sequence, ticks }, None) if streams => {
                let taken = Taken::Arrived(at_ns.saturating_sub(self.wire_ns(n_bytes)));
                decoded.push(Decoded::Values { values, sequence, ticks, taken });
            }
            (Content::Identity(text), _) => decoded.push(Decoded::Identity(text)),
            (Content::Accepted, Some(_)) => {}
            (Content::Refused(reply), Some(answered)) => {
                let request = shown(&answered.request.bytes);
                decoded.push(Decoded::Refused { request, reply });
            }
            (_, None) => decoded.push(Decoded::Unasked { seen }),
        }
    }

    /// Gives up on an overdue answer; what `receive` and `poll` do depends on times alone.
    fn expire(&mut self, now_ns: u64, decoded: &mut Vec<Decoded>) {
        let Some(waiting) = self.waiting.take_if(|waiting| waiting.deadline_ns <= now_ns) else {
            return;
        };
        self.drop_rest(decoded);
        decoded.push(Decoded::Silent {
            request: shown(&waiting.request.bytes),
            purpose: waiting.request.purpose,
            station: self.protocol.station_asked(&waiting.request),
            fields: match waiting.request.purpose {
                Purpose::Read => self.protocol.fields_asked(&waiting.request),
                _ => Vec::new(),
            },
            waited_ns: waiting.deadline_ns - waiting.sent_ns,
        });
        self.ready_ns = waiting.deadline_ns + self.pace.timeout_ns;
    }

    /// The rest of an answer belongs to no later request.
    fn drop_rest(&mut self, decoded: &mut Vec<Decoded>) {
        if !self.buffer.is_empty() && !self.cycle.is_empty() {
            decoded.push(damaged(&self.buffer, Damage::Cut));
            self.buffer.clear();
        }
    }

    fn wire_ns(&self, n_bytes: usize) -> u64 {
        n_bytes as u64 * self.pace.byte_ns
    }
}

fn damaged(bytes: &[u8], damage: Damage) -> Decoded {
    Decoded::Damaged { n_bytes: bytes.len(), damage, seen: shown(bytes) }
}

/// Bytes as a reader of messages can make something of them.
pub(crate) fn shown(bytes: &[u8]) -> String {
    const SHOWN_BYTES_MAX: usize = 24;
    let head = &bytes[..bytes.len().min(SHOWN_BYTES_MAX)];
    let more = if head.len() < bytes.len() { ".." } else { "" };
    let is_text = head.iter().all(|byte| byte.is_ascii_graphic() || b" \r\n\t".contains(byte));
    if is_text {
        return format!("{}{more}", head.escape_ascii());
    }
    let hex: Vec<String> = head.iter().map(|byte| format!("{byte:02X}")).collect();
    format!("{}{more}", hex.join(" "))
}
