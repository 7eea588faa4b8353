//! Decodes what happened on a link, live as in every replay.

use devices::channel::{Counted, Counts};
use devices::driver::Session;
use devices::port::LinkEvent;
use devices::{Attachment, InstrumentError, InstrumentEvent, Interpreter, Quantity};

/// The driver of a device, its clock and its counts, as a recording alone brings them about.
///
/// A recording that follows another on an open link begins with the last seconds of that one. They
/// bring the decoder into step with the frames, the clock to its line and the numbers to their
/// count; what they say is in the recording before.
pub struct LinkDecoder {
    session: Session,
    interpreter: Interpreter,
    /// Whether what comes is in the recording before.
    leads: bool,
    /// What was counted until the recording's own began, channel by channel.
    before: Vec<Counts>,
}

impl LinkDecoder {
    /// A decoder of a device as it was attached.
    ///
    /// # Errors
    /// [`InstrumentError`] when the driver does not take the settings.
    pub fn new(attachment: &Attachment) -> Result<Self, InstrumentError> {
        let (session, interpreter) = attachment.start()?;
        let before = interpreter.counts().map(|_| Counts::default()).collect();
        Ok(Self { session, interpreter, leads: false, before })
    }

    /// Whether the device is asked round by round; others tell by themselves.
    pub fn asks(&self) -> bool {
        self.session.asks()
    }

    /// What comes next is in the recording before.
    pub fn lead(&mut self) {
        self.leads = true;
    }

    /// What comes next is the recording's own.
    pub fn begin(&mut self) {
        self.leads = false;
        self.before = self.interpreter.counts().map(|(_, counts)| counts).collect();
    }

    /// Whether what comes is in the recording before.
    pub fn leads(&self) -> bool {
        self.leads
    }

    /// Takes what happened, in its order, and appends what it means for this recording.
    pub fn take(&mut self, event: &LinkEvent, out: &mut Vec<InstrumentEvent>) {
        let n_before = out.len();
        self.interpreter.replay(event, &mut self.session, out);
        if self.leads {
            out.truncate(n_before);
        }
    }

    /// Counts of each channel in this recording.
    pub fn counts(&self) -> impl Iterator<Item = (Quantity, Counts)> {
        let channels = self.interpreter.counts().zip(&self.before);
        channels.map(|((quantity, counts), before)| (quantity, counts - *before))
    }

    /// The same of each channel that has brought a sample, as they stand now.
    pub fn counted(&self) -> impl Iterator<Item = Counted> {
        let own = |quantity: Quantity| self.counts().find(|(of, _)| *of == quantity);
        self.interpreter.counted().filter(|_| !self.leads).map(move |counted| {
            let counts = own(counted.quantity).map_or(counted.counts, |(_, counts)| counts);
            Counted { counts, ..counted }
        })
    }
}
